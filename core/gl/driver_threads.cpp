// Threads are counted by their names, and by what LP_NUM_THREADS asked for. Neither is enough:
// another user of Mesa in this process may have opened the display, when the variable had another
// value; and a thread gets its name a moment after it was started.
#include "core/gl/driver_threads.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>

#include "core/base/count.h"

namespace farcull {
namespace {

// As llvmpipe reads the variable. Without it there is a thread for each core, but none on one core.
int read_variable() {
  constexpr long kMost = 16;  // of Mesa 22
  const long cores = static_cast<long>(std::thread::hardware_concurrency());
  long threads = cores > 1 ? cores : 0;
  if (const char* const text = std::getenv("LP_NUM_THREADS")) {
    char* end = nullptr;
    const long number = std::strtol(text, &end, 0);
    if (end != text) threads = number;
  }
  return static_cast<int>(threads < 0 ? kMost : std::min(threads, kMost));
}

int asked_threads() {
  static const int threads = read_variable();
  return threads;
}

int running_threads() {
  namespace fs = std::filesystem;
  int threads = 0;
  std::error_code failed;
  for (fs::directory_iterator task("/proc/self/task", failed), end; !failed && task != end;
       task.increment(failed)) {
    std::ifstream file(task->path() / "comm");
    std::string name;
    if (std::getline(file, name)) threads += name.starts_with("llvmpipe-");
  }
  return threads;
}

}  // namespace

void note_asked_threads() { asked_threads(); }

int driver_threads(const std::string& renderer) {
  // zink, which draws with it by way of Vulkan, names it too.
  if (renderer.find("llvmpipe") == std::string::npos) return 0;
  return std::max(asked_threads(), running_threads());
}

std::string risk_of_threads(const std::string& renderer) {
  const int threads = driver_threads(renderer);
  if (threads == 0) return "";
  return "the driver draws in " +
         counted(static_cast<std::uint64_t>(threads), "thread", "threads") +
         " of its own, which may damage the memory of this process or hang it; set "
         "LP_NUM_THREADS=0 in the environment before a display is opened, so that it has none";
}

}  // namespace farcull
