// The machine as measurements report it: cores, memory, names, what else runs on it; and the lock
// of programs that measure times.
#pragma once

#include <optional>
#include <string>

namespace farcull {

/// How many cores this process may use.
unsigned usable_cores();

/// Confines the process, with all threads that it starts from now on, to this number of cores, so
/// that no library uses more cores than it should. Throws Error naming --threads if the machine has
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

/// How much other programs used the processors that this process may use.
struct Load {
  double share = 0;  // of their time, 0 to 1
  /// Two standard deviations of `share`, since the system counts by ticks of a clock.
  double error = 0;
  bool beyond(double limit) const { return share - error > limit; }
};

/// The load since construction: the time in which these processors were busy (/proc/stat, with what
/// a hypervisor stole) less the time of this process and of its children that have ended. The load
/// average of the system is not asked: in a container it counts the processes of all others,
/// wherever they run, and it lags by a minute.
class LoadMeter {
 public:
  LoadMeter();
  /// Empty if the system does not say: there is no /proc/stat, or it misses this process's own time
  /// (gVisor). A container that sees its own time alone (lxcfs) reports none of the others.
  std::optional<Load> now() const;

 private:
  struct Ticks {
    double busy = 0, all = 0, own = 0;  // clock ticks
  };
  static std::optional<Ticks> read();
  std::optional<Ticks> before_;
};

/// Held by the one process of a machine that measures times, until it ends, however it ends.
class TimingLock {
 public:
  static constexpr const char* kFile = "/tmp/farcull-times.lock";

  /// Throws Error naming the process that holds the lock, or the path if it cannot be opened.
  /// Another path is for tests.
  explicit TimingLock(const std::string& path = kFile);
  ~TimingLock();
  TimingLock(const TimingLock&) = delete;
  TimingLock& operator=(const TimingLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace farcull
