// One rule for program, library and Python: where nothing is tested there is no answer, since 0
// pairs would be taken for a scene without collisions.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Throws Error about the argument `where` if every pair of objects is ignored, by `ignored` or by
/// the scene itself, and no object is tested against itself. The remedy is to ignore fewer pairs,
/// or what `otherwise` says.
void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise);

}  // namespace farcull
