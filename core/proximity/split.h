// Searches in all threads, and what they answer.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/proximity/near_pairs.h"
#include "core/proximity/search.h"

namespace farcull {

/// Pairs of runs after which a search counts as long.
constexpr std::size_t kShort = 4096;

/// A limit in world units, scaled and rounded up.
double scaled_limit(const SceneTrees& trees, double within);
/// Of a search with nothing open. Sets counts.kept.
NearPairs answer(const SceneTrees& trees, Search& search);
/// Pairs that a search may keep: 2.4 GB.
constexpr std::size_t kMostKept = 100'000'000;

/// Throws Error where a search keeps more than `most` pairs.
void require_room(const SceneTrees& trees, const Search& search, std::size_t most = kMostKept);
/// Ends a search. What it finds and counts does not depend on the number of threads. Throws Error
/// where it keeps more than `most` pairs.
void go_on_divided(const SceneTrees& trees, unsigned threads, Search& search,
                   std::size_t most = kMostKept);

/// Calls work(k, memory) for k in 0 .. count - 1, in all threads, with a memory for each.
template <class Work>
void for_each_with_memory(std::size_t count, unsigned threads, const Work& work) {
  const std::size_t chunks = chunks_for(count, 1, threads);
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    SearchMemory memory;
    for (std::size_t k = next++; k < count; k = next++) work(k, memory);
  });
}

}  // namespace farcull
