// The machine as measurements report it: cores, memory, names.
#pragma once

#include <optional>
#include <string>

namespace farcull {

/// How many cores this process may use.
unsigned usable_cores();

/// Confines the process, with all threads that it starts from now on, to that many cores, so that
/// no library uses more cores than it should. Throws Error naming --threads if the machine has
/// fewer or the system refuses. Precondition: threads >= 1.
void confine_to_cores(unsigned threads);

/// The model of the CPU as /proc/cpuinfo has it; "unknown" if the file does not say.
std::string cpu_model();

/// The features of the CPU as /proc/cpuinfo lists them; "unknown" if the file does not say.
std::string cpu_features();

/// The growth of resident memory since construction. The constructor returns free memory to the
/// system, notes the resident size and resets the peak (VmHWM, by /proc/self/clear_refs);
/// grown_mib() is the peak since then minus the noted size; empty if the system does not say.
class PeakMemory {
 public:
  PeakMemory();
  std::optional<double> grown_mib() const;

 private:
  std::optional<double> before_kib_;
};

}  // namespace farcull
