// Searches in all threads, and what they answer.
#pragma once

#include <cstddef>

#include "core/base/shared_work.h"
#include "core/proximity/near_pairs.h"
#include "core/proximity/search.h"

namespace farcull {

/// So many pairs of runs a search looks at before it is asked whether it goes on. One that does is
/// long, and is divided.
constexpr std::size_t kRunPairsAtOnce = 4096;

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

}  // namespace farcull
