// All pairs of triangles that may be within a distance.
#pragma once

#include <cstddef>
#include <vector>

#include "core/proximity/near_pairs.h"
#include "core/proximity/scene_trees.h"

namespace farcull {

/// As ProximityTrees::pairs_within(). limit: scaled. Adds to counts.
std::vector<TrianglePair> pairs_within(const SceneTrees& trees, double limit, std::size_t most,
                                       unsigned threads, ProximityCounts& counts);

}  // namespace farcull
