// The nearest objects of each object, by a search over the tree of objects.
#pragma once

#include <cstddef>
#include <vector>

#include "core/proximity/near_pairs.h"
#include "core/proximity/scene_trees.h"

namespace farcull {

/// As ProximityTrees::nearest_objects(). limit: scaled. Adds to counts.
std::vector<NearPairs> nearest_objects(const SceneTrees& trees, std::size_t k, double limit,
                                       unsigned threads, ProximityCounts& counts);

}  // namespace farcull
