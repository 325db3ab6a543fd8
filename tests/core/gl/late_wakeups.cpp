// Loaded into a program before its libraries (LD_PRELOAD). Makes a fault of Mesa's llvmpipe visible
// (docs/drivers.md): one of its threads wakes those that wait for a fence, which the program's
// thread has freed meanwhile. Threads other than the first one wait a moment before they wake
// anybody, and small blocks that are freed are filled with a pattern and kept for a while. A thread
// that finds the pattern in what it is about to use ends the process with status 66.
#include <dlfcn.h>
#include <malloc.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>

extern "C" void __libc_free(void* block);  // of the GNU C library

namespace {

constexpr unsigned char kFreed = 0xdb;
constexpr std::size_t kMostBytes = 256;  // of a block that is kept: a fence has about 110

// Microseconds. A draw has to take less, so a busy machine needs more of them.
const useconds_t delay = [] {
  const char* const given = std::getenv("FARCULL_LATE");
  return given != nullptr ? static_cast<useconds_t>(std::atoi(given)) : 3000;
}();

// The blocks that were freed last. A newer one takes the place of the oldest.
std::array<std::atomic<void*>, 1 << 16> kept;
std::atomic<std::size_t> freed{0};

}  // namespace

extern "C" [[gnu::visibility("default")]] void free(void* block) {
  const std::size_t bytes = ::malloc_usable_size(block);
  if (bytes > 0 && bytes <= kMostBytes) {
    std::memset(block, kFreed, bytes);
    block = kept[freed++ % kept.size()].exchange(block);
  }
  ::__libc_free(block);
}

extern "C" [[gnu::visibility("default")]] int pthread_cond_broadcast(pthread_cond_t* condition) {
  using Broadcast = int (*)(pthread_cond_t*);
  // Of two versions on x86, dlsym may give the older one, which is of another type of condition.
  static const auto real = [] {
    void* const newer = ::dlvsym(RTLD_NEXT, "pthread_cond_broadcast", "GLIBC_2.3.2");
    return reinterpret_cast<Broadcast>(newer ? newer
                                             : ::dlsym(RTLD_NEXT, "pthread_cond_broadcast"));
  }();
  if (::gettid() != ::getpid()) {
    ::usleep(delay);
    std::array<unsigned char, sizeof *condition> bytes;
    std::memcpy(bytes.data(), condition, bytes.size());
    if (std::all_of(bytes.begin(), bytes.end(), [](unsigned char b) { return b == kFreed; })) {
      constexpr char kSaid[] = "a thread wakes those that wait for what is freed\n";
      (void)!::write(STDERR_FILENO, kSaid, sizeof kSaid - 1);
      ::_exit(66);
    }
  }
  return real(condition);
}
