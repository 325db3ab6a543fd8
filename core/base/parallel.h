// Divides work among all cores, in contiguous chunks or item by item. Also runs calls that can be
// stopped. All threads of farcull are started here.
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

/// Calls part(data, k) once for each k in 0 .. parts - 1, in the calling thread and in pooled
/// threads. `part` may call run_parts(). If no pooled thread is free, the calling thread makes all
/// calls. Returns when all calls of `part` have returned. `part` must not throw.
void run_parts(std::size_t parts, void (*part)(const void* data, std::size_t k), const void* data);

/// Calls work(chunk, begin, end) for `chunks` contiguous parts of 0 .. count - 1, in parallel if
/// threads are free. `work` runs with rounding to nearest and with subnormals, even if the caller's
/// environment differs. A chunk must not wait for another chunk. If several calls of `work` throw,
/// the exception of the lowest chunk is rethrown here.
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
/// is 0. Returns fewer (at least 1) if a chunk would have fewer than `least` items.
inline std::size_t chunks_for(std::size_t count, std::size_t least, unsigned threads = 0) {
  const std::size_t cores =
      threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(count / std::max<std::size_t>(least, 1), 1, cores);
}

/// Calls work(k, memory) once for each k in 0 .. count - 1. A free thread takes the next k. Each
/// thread makes one Memory for all its calls. threads: number of threads; 0: one per core. An
/// exception of `work` is rethrown here.
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

/// Thrown inside a call that was stopped. Not an Error, because stopping is no mistake.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

/// Throws Stopped if the calling thread works for a StoppableCall that was asked to stop.
/// run_parts() and for_chunks() call this function first.
void stop_point();

/// Runs `work` in its own thread. The threads that help in for_chunks() stop on the same request.
/// All these threads block signals, so only the caller's threads receive them. The thread inherits
/// the floating-point environment of the thread that constructs the object.
class StoppableCall {
 public:
  /// Throws std::system_error if no thread can be started. `work` has not run then.
  explicit StoppableCall(std::function<void()> work);
  /// Waits until the work has ended.
  ~StoppableCall();
  StoppableCall(const StoppableCall&) = delete;
  StoppableCall& operator=(const StoppableCall&) = delete;

  /// Asks the work to stop at its next stop_point(). The work may end before it reaches one.
  void stop();
  /// Waits until the work has ended, but not longer than `most`. Returns true if it has ended.
  bool wait_for(std::chrono::milliseconds most);
  /// Waits until the work has ended. Rethrows its exception (Stopped if it was stopped).
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
