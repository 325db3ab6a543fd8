// The nearest objects of each object, by a search over the tree of objects.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/proximity/near_pairs.h"
#include "core/proximity/scene_trees.h"

namespace farcull {

/// As ProximityTrees::nearest_objects(). limit: scaled; hints: triangles of the objects that they
/// name, sorted by objects, for two objects at most one; all: of
/// others as near all, not just the lower ones. Adds to counts.
std::vector<NearPairs> nearest_objects(const SceneTrees& trees, std::size_t k, double limit,
                                       std::span<const NearHint> hints, bool all, unsigned threads,
                                       ProximityCounts& counts);

}  // namespace farcull
