// Divides work among all cores, in contiguous chunks or item by item. Also runs a function in a way
// that another thread can stop. All threads of farcull are started here.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "core/base/floating_point.h"

namespace farcull {

/// Calls part(data, k) once for each k in 0 .. parts - 1, in the calling thread and in threads of a
/// pool. If no thread of the pool is free, the calling thread makes all calls. Returns when all
/// calls of `part` have returned. `part` must not throw. `part` may call run_parts().
void run_parts(std::size_t parts, void (*part)(const void* data, std::size_t k), const void* data);

/// Cuts 0 .. count - 1 into `chunks` contiguous ranges, and calls work(chunk, begin, end) for each,
/// in parallel if threads are free. `work` runs in the environment kProved (floating_point.h), even
/// if the caller's environment differs. A chunk must not wait for another chunk. If several calls
/// of `work` throw, the exception of the chunk with the lowest number is rethrown here.
template <class Work>
void for_chunks(std::size_t count, std::size_t chunks, const Work& work) {
  std::vector<std::exception_ptr> failures(chunks);
  const auto part = [&](std::size_t chunk) {
    try {
      const FloatingPointGuard guard;
      work(chunk, count * chunk / chunks, count * (chunk + 1) / chunks);
    } catch (...) {
      failures[chunk] = std::current_exception();
    }
  };
  using Part = decltype(part);
  run_parts(
      chunks, [](const void* data, std::size_t k) { (*static_cast<const Part*>(data))(k); }, &part);
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

/// Returns the number of chunks for `count` items: `threads`, or the number of cores if `threads`
/// is 0. Returns a smaller number (at least 1) if a chunk would have fewer than `least` items.
inline std::size_t chunks_for(std::size_t count, std::size_t least, unsigned threads = 0) {
  const std::size_t cores =
      threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(count / std::max<std::size_t>(least, 1), 1, cores);
}

/// Calls work(k, memory) once for each k in 0 .. count - 1. A free thread takes the next k. Each
/// thread makes one Memory for all its calls. threads: number of threads; 0: one per core. If
/// `work` throws, rethrows the exception.
template <class Memory, class Work>
void for_each_with_memory(std::size_t count, unsigned threads, const Work& work) {
  const std::size_t chunks = chunks_for(count, 1, threads);
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    Memory memory;
    for (std::size_t k = next++; k < count; k = next++) work(k, memory);
  });
}

/// Like for_each_with_memory(), but calls work(k), without a Memory.
template <class Work>
void for_each_shared(std::size_t count, unsigned threads, const Work& work) {
  struct Nothing {};
  for_each_with_memory<Nothing>(count, threads, [&](std::size_t k, Nothing&) { work(k); });
}

/// Thrown by stop_point() to end a stopped call. This is not an Error, because nothing failed.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

/// Throws Stopped if the calling thread works for a StoppableCall that was asked to stop.
/// run_parts() and for_chunks() call this function first.
void stop_point();

/// Runs `work` in a new thread. Threads of the pool that help in for_chunks() stop on the same
/// request. All these threads block signals, so only the caller's threads receive signals. The new
/// thread inherits the floating-point environment of the thread that constructs the object.
class StoppableCall {
 public:
  /// Throws std::system_error if no thread can be started. In this case `work` does not run.
  explicit StoppableCall(std::function<void()> work);
  /// Waits until the work has ended.
  ~StoppableCall();
  StoppableCall(const StoppableCall&) = delete;
  StoppableCall& operator=(const StoppableCall&) = delete;

  /// Asks the work to stop at its next call of stop_point(). The work may end without such a call.
  void stop();
  /// Waits until the work has ended, for at most `most`. Returns true if the work has ended.
  bool wait_for(std::chrono::milliseconds most);
  /// Waits until the work has ended. If the work threw, rethrows its exception, such as Stopped.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
