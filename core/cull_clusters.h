// Clusters of triangles for the level between objects and triangles (core/cull.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// `triangles` (of any order) by owner, then along the space-filling curve of Morton through the
/// centres of their boxes inside the box of their owner, then by index. owner, boxes: per triangle
/// of the scene.
std::vector<std::uint32_t> spatial_order(std::span<const std::uint32_t> triangles,
                                         std::span<const std::uint32_t> owner,
                                         std::span<const Box> boxes);

/// Per triangle of the scene (owner.size() of them): the number of its cluster, where each owner's
/// triangles in `order` are cut into clusters of `size`, the last of an owner being smaller.
/// Clusters ascend along the order; what is not in `order` has number 0.
std::vector<std::uint32_t> cluster_numbers(std::span<const std::uint32_t> order,
                                           std::span<const std::uint32_t> owner,
                                           std::uint32_t size);

}  // namespace farcull
