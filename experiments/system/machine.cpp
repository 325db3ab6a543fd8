// Reads /proc and the scheduler.
#include "experiments/system/machine.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <string_view>
#include <thread>

#include "core/base/error.h"

namespace farcull {
namespace {

// The value of the first of these keys in /proc/cpuinfo.
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

// A value of /proc/self/status, in KiB.
std::optional<double> status_kib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double value = 0;
    if (word == key + ":" && status >> value) return value;
  }
  return std::nullopt;
}

}  // namespace

// Asks the scheduler: the C library counts all cores that are online, even if the process is
// confined to fewer.
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

// x86 says flags, Arm Features.
std::string cpu_features() { return cpuinfo({"flags", "Features"}); }

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

}  // namespace farcull
