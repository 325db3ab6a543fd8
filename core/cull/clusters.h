// Clusters of triangles for the level between objects and triangles (core/cull/cull.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/stage.h"
#include "core/scene/scene.h"

namespace farcull {

/// The levels between objects and triangles. A cluster has `size` triangles of one owner, in the
/// order of a space-filling curve. One query asks for all triangles of a cluster that are not
/// culled yet. Each size is a level, in this order; empty: no such level. They are run on the first
/// visit of a view, and change no fixed point.
struct Clusters {
  std::vector<std::uint32_t> sizes;  // triangles, each 2 or more
  Reason reason = Reason::none;      // for the trace; none: no entry in the trace
  std::uint64_t n = 0, m = 0;        // numbers n and m of the reason
};

/// The fixed rule: clusters of 32 triangles if questions are costly (occlusion queries) and more
/// than 32,768 triangles may take part; none otherwise.
Clusters usual_clusters(bool occlusion_queries, std::size_t triangles);

/// Sorts `triangles` (given in any order) by owner, then along the space-filling curve of Morton
/// through the centres of their boxes inside the box of their owner, then by index. owner, boxes:
/// per triangle of the scene.
std::vector<std::uint32_t> spatial_order(std::span<const std::uint32_t> triangles,
                                         std::span<const std::uint32_t> owner,
                                         std::span<const Box> boxes);

/// The cluster number of each triangle of the scene (owner.size() of them). Each owner's triangles
/// in `order` are cut into clusters of `size`; the last cluster of an owner may be smaller. Numbers
/// ascend along the order. Triangles that are not in `order` have number 0.
std::vector<std::uint32_t> cluster_numbers(std::span<const std::uint32_t> order,
                                           std::span<const std::uint32_t> owner,
                                           std::uint32_t size);

}  // namespace farcull
