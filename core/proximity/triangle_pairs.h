// Bounds of the distances of pairs of triangles, sixteen pairs at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/scene/scene.h"

namespace farcull {

constexpr std::size_t kBatch = 16;

/// Pairs of scaled triangles (core/proximity/scene_trees.h).
struct alignas(64) PairBatch {
  using Columns = std::array<std::array<double, kBatch>, 9>;  // 3 corner + axis
  Columns a{}, b{};
  std::array<TrianglePair, kBatch> pairs{};
  std::size_t count = 0;  // of pairs; what stands behind them is any finite numbers
};

/// The distance of the exact triangles is at least `lower` and at most `upper`, in scaled units. It
/// is certain that they meet where upper is 0.
/// direction: from about the closest point of a to that of b.
struct alignas(64) BatchBounds {
  std::array<double, kBatch> lower, upper;
  std::array<std::array<double, kBatch>, 3> direction;
};

}  // namespace farcull
