// Finds pairs in portions, by all threads, and passes them on as they are found.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "core/base/parallel.h"

namespace farcull {

/// Calls find(begin, end, memory, flush) for successive portions of 0 .. count - 1. Each thread has
/// one Memory, and `find` appends to memory.pairs. flush() gives these to `take` if there are many;
/// the rest is given at the end. Returns the number of pairs.
template <class Memory, class Take, class Find>
std::uint64_t give_portions(std::uint64_t count, std::uint64_t portion, std::size_t threads,
                            const Take& take, const Find& find) {
  constexpr std::size_t kMany = std::size_t{1} << 14;
  std::atomic<std::uint64_t> next = 0, given = 0;
  for_chunks(threads, threads, [&](std::size_t, std::size_t, std::size_t) {
    Memory memory;
    const auto give = [&](std::size_t least) {
      if (memory.pairs.size() < least) return;
      given += memory.pairs.size();
      take(memory.pairs);
      memory.pairs.clear();
    };
    try {
      for (;;) {
        stop_point();
        const std::uint64_t begin = next.fetch_add(portion);
        if (begin >= count) break;
        find(begin, std::min(count, begin + portion), memory, [&] { give(kMany); });
      }
      give(1);
    } catch (...) {
      next = count;  // the other threads end early too
      throw;
    }
  });
  return given;
}

}  // namespace farcull
