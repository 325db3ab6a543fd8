// The nearest neighbours of objects by exact distances: what sets of potential neighbours
// (experiments/measure/neighbour_sets.h) are compared with.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/scene.h"

namespace farcull {

/// The other objects at the least distance of an object, by exact arithmetic.
struct NearestObjects {
  std::vector<std::uint32_t> objects;   // ascending; none where there is no other one
  std::vector<TrianglePair> triangles;  // of each of these, the first pair at that distance
};

/// For each object: ProximityTrees (core/proximity/near_pairs.h) leave the pairs that can be
/// nearest, and exact arithmetic decides (verify/closest.h). Precondition: the scene satisfies
/// validate().
std::vector<NearestObjects> nearest_objects(const Scene& scene, const Progress& progress = {});

}  // namespace farcull
