// Clusters of triangles for the level between objects and triangles (core/cull/cull.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/stage.h"
#include "core/scene/scene.h"

namespace farcull {

/// The levels between objects and triangles. A cluster has up to `size` triangles of one owner, in
/// the order of a space-filling curve. One query tests all triangles of a cluster that are not
/// culled yet. Each element of `sizes` is a level, in this order. These levels run only on the
/// first visit of a view. They do not change the fixed point of the rounds.
struct Clusters {
  std::vector<std::uint32_t> sizes;  // triangles per cluster, each 2 or more
  Reason reason = Reason::none;      // the reason in the trace; none: no entry in the trace
  std::uint64_t n = 0, m = 0;        // numbers n and m of the reason
};

/// Returns clusters of 32 triangles if occlusion queries are used and more than 32,768 triangles
/// may take part. Else returns no clusters.
Clusters usual_clusters(bool occlusion_queries, std::size_t triangles);

/// Sorts `triangles` (given in any order) by owner, then along a Morton curve by the centres of
/// their boxes, in the box of the owner, then by index. owner, boxes: per triangle of the scene.
std::vector<std::uint32_t> spatial_order(std::span<const std::uint32_t> triangles,
                                         std::span<const std::uint32_t> owner,
                                         std::span<const Box> boxes);

/// Returns the cluster number of each triangle of the scene. Each owner's triangles in `order` are
/// cut into clusters of `size`; the last cluster of an owner may be smaller. Numbers ascend along
/// the order. Triangles that are not in `order` have number 0.
std::vector<std::uint32_t> cluster_numbers(std::span<const std::uint32_t> order,
                                           std::span<const std::uint32_t> owner,
                                           std::uint32_t size);

}  // namespace farcull
