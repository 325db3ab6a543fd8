// What `farcull bench` asks of the machine: cores, memory, names.
#pragma once

#include <optional>
#include <string>

namespace farcull {

/// How many cores this process may use.
unsigned usable_cores();

/// Confines the process, with all threads that it starts from now on, to that many cores, so that
/// no library takes more than it was given. Throws Error naming --threads if the machine has fewer
/// or the system refuses. Precondition: threads >= 1.
void confine_to_cores(unsigned threads);

/// As /proc/cpuinfo has it; "unknown" where that does not say.
std::string cpu_model();

/// The growth of resident memory over a call: gives what is free back to the system, notes what is
/// resident and resets the mark of the peak (VmHWM, by /proc/self/clear_refs); grown_mib() is the
/// peak since then above what was resident. Empty where the system does not let itself be asked.
class PeakMemory {
 public:
  PeakMemory();
  std::optional<double> grown_mib() const;

 private:
  std::optional<double> before_kib_;
};

}  // namespace farcull
