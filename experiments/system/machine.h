// Properties of the machine, for reports of measurements: cores, CPU, memory and load. Also a lock
// that keeps two programs from measuring times at once.
#pragma once

#include <optional>
#include <string>

namespace farcull {

unsigned usable_cores();

/// Confines the process, and all threads that it starts from now on, to this number of cores, so
/// that no library uses more. Throws Error naming --threads if the process may use fewer cores, or
/// if the system refuses. Precondition: threads >= 1.
void confine_to_cores(unsigned threads);

/// Both return text from /proc/cpuinfo, or "unknown" if /proc/cpuinfo does not have it.
std::string cpu_model();
std::string cpu_features();

/// Measures the growth of resident memory. The constructor returns free memory to the system,
/// stores the resident size, and resets the peak (VmHWM) through /proc/self/clear_refs.
class PeakMemory {
 public:
  PeakMemory();
  /// Returns the peak since construction minus the stored size, in MiB; empty if unknown.
  std::optional<double> grown_mib() const;

 private:
  std::optional<double> before_kib_;
};

/// The load that other programs put on the processors that this process may use.
struct Load {
  double share = 0;  // fraction of these processors' time, 0 to 1
  double error = 0;  // two standard deviations of `share`; /proc/stat counts whole ticks
  bool beyond(double limit) const { return share - error > limit; }
};

/// Measures the load since construction: the busy time of this process's processors (/proc/stat),
/// minus the time of this process and of its ended children. Time that a hypervisor took counts as
/// busy. The load average of the system would not do: in a container it counts the processes on all
/// cores of the machine, and it lags by a minute.
class LoadMeter {
 public:
  LoadMeter();
  /// Returns nothing if /proc/stat does not exist, or if it lacks the time of this process
  /// (gVisor). In a container with its own /proc/stat (lxcfs), load from outside is not seen.
  std::optional<Load> now() const;

 private:
  struct Ticks {
    double busy = 0, all = 0, own = 0;  // in clock ticks; own: this process and its ended children
  };
  static std::optional<Ticks> read();
  std::optional<Ticks> before_;
};

/// Lets one process per machine measure times. The lock ends with the process, even if it crashes.
class TimingLock {
 public:
  static constexpr const char* kFile = "/tmp/farcull-times.lock";

  /// path: the lock file; tests use another file. Throws Error if the file cannot be opened, or if
  /// another process holds the lock; the message then names that process.
  explicit TimingLock(const std::string& path = kFile);
  ~TimingLock();
  TimingLock(const TimingLock&) = delete;
  TimingLock& operator=(const TimingLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace farcull
