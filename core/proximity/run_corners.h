// The triangles of a run, ready for lanes.
#pragma once

#include <array>
#include <cstdint>

#include "core/pairs/box_tree.h"
#include "core/proximity/scene_trees.h"
#include "core/proximity/triangle_pairs.h"

namespace farcull {

/// The triangles of a run, as columns.
struct alignas(64) RunCorners {
  PairBatch::Columns corner;
  WideBoxes boxes;  // of the triangles
  std::array<std::uint32_t, kBatch> triangle;
  alignas(64) std::array<double, kBatch> extreme;  // along a direction: the most of a triangle of
                                                   // a, the least of one of b
  double most_extreme = 0;
  std::uint64_t direction = 0;  // which one: a number of the search's memory
  std::uint32_t run = UINT32_MAX;
  std::uint32_t count = 0;
};

/// The triangles of a run of all objects' (SceneTrees::run()). What stands behind the last one
/// repeats it, but has no box.
void load_run(const SceneTrees& trees, std::uint32_t run, RunCorners& out);

/// Whether the triangles have a corner at the same position.
bool share_position(const Scene& scene, std::uint32_t a, std::uint32_t b);

}  // namespace farcull
