// Clusters of triangles, tested after whole objects and before triangles (core/cull/cull.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/stage.h"
#include "core/scene/scene.h"

namespace farcull {

/// The levels between objects and triangles, in the order in which they run. At a level, one query
/// tests the live triangles of a cluster. A cluster has at most the given number of triangles, all
/// of one owner and consecutive on a space-filling curve. These levels run only in the first round.
/// They do not change the fixed point of the rounds.
struct Clusters {
  std::vector<std::uint32_t> sizes;  // per level: triangles in a cluster (2 or more)
  Reason reason = Reason::none;      // the reason in the trace; none: no entry in the trace
  std::uint64_t n = 0, m = 0;        // Stage::n and Stage::m for the reason
};

/// Returns clusters of 32 triangles if occlusion queries are used and more than 32,768 triangles
/// may take part. Else returns no clusters.
Clusters usual_clusters(bool occlusion_queries, std::size_t triangles);

/// Sorts `triangles` by owner, then by the Morton code of the centre of the triangle's box, then by
/// index. The Morton curve fills the box of the owner. owner, boxes: per triangle of the scene.
std::vector<std::uint32_t> spatial_order(std::span<const std::uint32_t> triangles,
                                         std::span<const std::uint32_t> owner,
                                         std::span<const Box> boxes);

/// Returns the cluster number of each triangle of the scene. Cuts the triangles of each owner, in
/// the order of `order`, into clusters of `size` triangles. The last cluster of an owner may be
/// smaller. Cluster numbers ascend along `order`. Triangles outside `order` have number 0.
std::vector<std::uint32_t> cluster_numbers(std::span<const std::uint32_t> order,
                                           std::span<const std::uint32_t> owner,
                                           std::uint32_t size);

}  // namespace farcull
