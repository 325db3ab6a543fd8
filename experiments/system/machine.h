// The machine, for reports of measurements: its cores, CPU, memory and load. Also the lock that
// keeps two programs from measuring times at once.
#pragma once

#include <optional>
#include <string>

namespace farcull {

unsigned usable_cores();

/// Confines the process, and all threads that it starts from now on, to this number of cores, so
/// that no library uses more. Throws Error naming --threads if the process may use fewer cores, or
/// if the system refuses. Precondition: threads >= 1.
void confine_to_cores(unsigned threads);

/// Return the model and the features of the CPU from /proc/cpuinfo; "unknown" if missing there.
std::string cpu_model();
std::string cpu_features();

/// Measures the growth of resident memory. The constructor returns free memory to the system,
/// stores the resident size, and resets the peak (VmHWM, by /proc/self/clear_refs).
class PeakMemory {
 public:
  PeakMemory();
  /// Returns the peak since construction minus the stored size, in MiB; empty if unknown.
  std::optional<double> grown_mib() const;

 private:
  std::optional<double> before_kib_;
};

/// How much other programs used the processors that this process may use.
struct Load {
  double share = 0;  // part of these processors' time, 0 to 1
  double error = 0;  // two standard deviations of `share`: the system counts whole clock ticks
  bool beyond(double limit) const { return share - error > limit; }
};

/// Measures the load since construction: the time in which the processors of this process were busy
/// (/proc/stat), less the time of this process and of its ended children. Time that a hypervisor
/// took counts as busy. The system's load average is no substitute: in a container it counts the
/// processes of all cores of the machine, and it lags by a minute.
class LoadMeter {
 public:
  LoadMeter();
  /// Returns nothing if there is no /proc/stat, or if /proc/stat lacks the time of this process
  /// (gVisor). In a container whose /proc/stat covers only that container (lxcfs), load from
  /// outside is not seen.
  std::optional<Load> now() const;

 private:
  struct Ticks {
    double busy = 0, all = 0, own = 0;  // clock ticks
  };
  static std::optional<Ticks> read();
  std::optional<Ticks> before_;
};

/// Lets one process per machine measure times. The lock ends with the process, even if it crashes.
class TimingLock {
 public:
  static constexpr const char* kFile = "/tmp/farcull-times.lock";

  /// Throws Error naming the process that holds the lock, or naming the path if the file cannot be
  /// opened. path: the lock file; tests use another file.
  explicit TimingLock(const std::string& path = kFile);
  ~TimingLock();
  TimingLock(const TimingLock&) = delete;
  TimingLock& operator=(const TimingLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace farcull
