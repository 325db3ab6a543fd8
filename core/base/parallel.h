// Work on all cores in contiguous chunks, so that results can be joined in order. All threads of
// farcull's own work start here, so each computes as the proofs say (core/base/floating_point.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

#include "core/base/floating_point.h"

namespace farcull {

/// Calls part(data, k) once for each k in 0 .. parts - 1, the first here and the others in threads
/// that are kept for the next call, or here where none is free: so calls may be nested. Returns
/// when all have returned. part throws nothing.
void run_parts(std::size_t parts, void (*part)(const void* data, std::size_t k), const void* data);

/// Calls work(chunk, begin, end) for `chunks` contiguous parts of 0 .. count - 1, side by side
/// where threads are free, rounding to nearest with subnormals kept whatever the caller does. No
/// chunk may wait for another one. The first exception of the lowest chunk is thrown again here.
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

/// As many chunks as cores (or `threads`, where it is not 0), but none below `least` items.
inline std::size_t chunks_for(std::size_t count, std::size_t least, unsigned threads = 0) {
  const std::size_t cores =
      threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(count / std::max<std::size_t>(least, 1), 1, cores);
}

}  // namespace farcull
