// Reads /proc, queries the scheduler, and locks a file.
#include "experiments/system/machine.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>
#include <thread>

#include "core/base/error.h"

namespace farcull {
namespace {

// Returns the value on the first line of /proc/cpuinfo that starts with one of these keys.
std::string cpuinfo(std::initializer_list<std::string_view> keys) {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    for (const std::string_view key : keys) {
      if (line.starts_with(key)) return line.substr(colon + 2);
    }
  }
  return "unknown";
}

// Returns a value of /proc/self/status, in KiB.
std::optional<double> status_kib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double value = 0;
    if (word == key + ":" && status >> value) return value;
  }
  return std::nullopt;
}

}  // namespace

// Queries the scheduler: the C library may count all online cores, even if the process is confined
// to fewer cores.
unsigned usable_cores() {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) != 0)
    return std::max(1u, std::thread::hardware_concurrency());
  return static_cast<unsigned>(CPU_COUNT(&cores));
}

void confine_to_cores(unsigned threads) {
  const unsigned cores = usable_cores();
  if (threads > cores) {
    throw Error("--threads", fmt::format("this process may use {} of the {}", cores, threads),
                "give at most that many");
  }
  cpu_set_t all, some;
  CPU_ZERO(&some);
  bool done = sched_getaffinity(0, sizeof all, &all) == 0;
  unsigned taken = 0;
  for (int cpu = 0; done && cpu < CPU_SETSIZE && taken < threads; ++cpu) {
    if (!CPU_ISSET(cpu, &all)) continue;
    CPU_SET(cpu, &some);
    ++taken;
  }
  if (!done || sched_setaffinity(0, sizeof some, &some) != 0) {
    throw Error("--threads", std::string("the cores cannot be chosen: ") + std::strerror(errno),
                "leave --threads out");
  }
}

std::string cpu_model() { return cpuinfo({"model name"}); }

std::string cpu_features() { return cpuinfo({"flags", "Features"}); }  // x86: flags; Arm: Features

PeakMemory::PeakMemory() {
  ::malloc_trim(0);
  std::ofstream reset("/proc/self/clear_refs");
  if (reset << "5" << std::flush) before_kib_ = status_kib("VmRSS");
}

std::optional<double> PeakMemory::grown_mib() const {
  const std::optional<double> peak = status_kib("VmHWM");
  if (!before_kib_ || !peak) return std::nullopt;
  return std::max(0.0, *peak - *before_kib_) / 1024;
}

LoadMeter::LoadMeter() : before_(read()) {}

// A line of /proc/stat is "cpuN user nice system idle iowait irq softirq steal ..", in ticks.
// "user" includes the time of guests.
std::optional<LoadMeter::Ticks> LoadMeter::read() {
  cpu_set_t mine;
  if (sched_getaffinity(0, sizeof mine, &mine) != 0) return std::nullopt;
  Ticks out;
  std::ifstream stat("/proc/stat");
  for (std::string line; std::getline(stat, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    if (!name.starts_with("cpu") || name.size() == 3) continue;
    const int cpu = std::atoi(name.c_str() + 3);
    if (cpu >= CPU_SETSIZE || !CPU_ISSET(cpu, &mine)) continue;
    double ticks = 0;
    for (int field = 0; field < 8 && words >> ticks; ++field) {
      out.all += ticks;
      if (field != 3 && field != 4) out.busy += ticks;
    }
  }
  if (out.all == 0) return std::nullopt;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage = {};
    ::getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
      out.own += (static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec)) *
                 static_cast<double>(::sysconf(_SC_CLK_TCK));
    }
  }
  return out;
}

// At each tick a processor is either busy or idle. So for n ticks, the standard deviation of the
// number of busy ticks is at most sqrt(n) / 2.
std::optional<Load> LoadMeter::now() const {
  const std::optional<Ticks> after = read();
  if (!before_ || !after) return std::nullopt;
  const double all = std::max(1.0, after->all - before_->all), error = std::sqrt(all) + 2;
  const double others = after->busy - before_->busy - (after->own - before_->own);
  if (others < -2 * error) return std::nullopt;
  return Load{std::clamp(others / all, 0.0, 1.0), error / all};
}

TimingLock::TimingLock(const std::string& path) {
  // A file of another user may not be writable. A lock needs only read access.
  const auto open = [&](int flags) { return ::open(path.c_str(), flags | O_CLOEXEC, 0666); };
  const bool ours = (file_ = open(O_RDWR)) >= 0 || (file_ = open(O_RDWR | O_CREAT)) >= 0;
  if (!ours && (file_ = open(O_RDONLY)) < 0) {
    throw Error(path, std::string("cannot be opened: ") + std::strerror(errno),
                "let it be written, or measure without times (--no-times)");
  }
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    std::array<char, 32> holder = {};
    const ssize_t length = ::pread(file_, holder.data(), holder.size() - 1, 0);
    ::close(file_);
    throw Error(
        path,
        fmt::format("process {} measures times on this machine, and two at once would measure each "
                    "other",
                    length > 0 ? holder.data() : "unknown"),
        "wait for its end, or measure without times (--no-times)");
  }
  if (!ours) return;
  ::fchmod(file_, 0666);
  const std::string own = std::to_string(::getpid());
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, own.data(), own.size(), 0) < 0) {
    // A failure is ignored: the process number serves only the error message above.
  }
}

TimingLock::~TimingLock() { ::close(file_); }

}  // namespace farcull
