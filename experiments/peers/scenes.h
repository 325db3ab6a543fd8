// Converts questions to contestants into scenes of farcull, and found pairs back.
#pragma once

#include "core/scene/scene.h"
#include "experiments/peers/contestant.h"

namespace farcull {

/// Two triangles as two objects; as one that is tested against itself where they share corners, so
/// that they are neighbours.
Scene scene_of(const ContestPair& pair);
/// The objects in their order.
Scene scene_of(const ContestScene& scene);

/// Pairs of triangles of the scene by object and number.
std::vector<ContestFound> found_in(const Scene& scene, const std::vector<TrianglePair>& pairs);

}  // namespace farcull
