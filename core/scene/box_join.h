// Pairs of overlapping boxes of different owners, by sweep and prune along one axis, in strips of
// another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// All pairs a < b of `items` (indices into boxes and owners) of different owners whose closed
/// boxes overlap, sorted. Exact: compares doubles only. Empty boxes overlap nothing. Where there
/// are more than `most`, returns most + 1 of them.
std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items,
                                   std::size_t most = SIZE_MAX);

/// Owners for box_join() that count pairs inside objects marked `self` too: a triangle of one is an
/// owner by itself.
std::vector<std::uint32_t> join_owners(const Scene& scene);

}  // namespace farcull
