// The machine, for reports of measurements: its cores, CPU, memory and load. Also the lock that
// keeps two programs from measuring times at once.
#pragma once

#include <optional>
#include <string>

namespace farcull {

/// How many cores this process may use.
unsigned usable_cores();

/// Confines the process, and all threads that it starts from now on, to this number of cores, so
/// that no library uses more of them. Throws Error naming --threads if the process may use fewer
/// cores or the system refuses. Precondition: threads >= 1.
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
  double share = 0;  // part of these processors' time, 0 to 1
  /// Two standard deviations of `share`: the system counts only whole clock ticks.
  double error = 0;
  bool beyond(double limit) const { return share - error > limit; }
};

/// The load since construction: the time in which these processors were busy (/proc/stat, including
/// time that a hypervisor took), less the time of this process and of its children that have ended.
/// The system's load average is not used: in a container it counts the processes of the whole
/// machine, on whichever cores they run, and it lags by a minute.
class LoadMeter {
 public:
  LoadMeter();
  /// Empty if there is no /proc/stat, or if it lacks the time of this process (gVisor). If a
  /// container's /proc/stat has only its own time (lxcfs), other load is not seen.
  std::optional<Load> now() const;

 private:
  struct Ticks {
    double busy = 0, all = 0, own = 0;  // clock ticks
  };
  static std::optional<Ticks> read();
  std::optional<Ticks> before_;
};

/// Lets one process per machine measure times. The lock ends with the process, even in a crash.
class TimingLock {
 public:
  static constexpr const char* kFile = "/tmp/farcull-times.lock";

  /// Throws Error naming the process that holds the lock, or the path if it cannot be opened.
  /// Tests give another path.
  explicit TimingLock(const std::string& path = kFile);
  ~TimingLock();
  TimingLock(const TimingLock&) = delete;
  TimingLock& operator=(const TimingLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace farcull
