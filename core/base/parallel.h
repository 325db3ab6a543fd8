// Work on all cores in contiguous chunks, so that results can be joined in order. All threads of
// farcull start here, so each computes as the proofs say (core/base/floating_point.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

#include "core/base/floating_point.h"

namespace farcull {

/// Calls work(chunk, begin, end) for `chunks` contiguous parts of 0 .. count - 1, each in a thread
/// of its own, rounding to nearest with subnormals kept whatever the caller does. The first
/// exception of the lowest chunk is thrown again here.
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
  std::vector<std::jthread> threads;  // joined also where starting one of them fails
  for (std::size_t chunk = 1; chunk < chunks; ++chunk) threads.emplace_back(part, chunk);
  part(0);
  threads.clear();
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
