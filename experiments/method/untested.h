// One rule for program, library and Python: where nothing is tested there is no answer, since 0
// pairs would be taken for a scene without collisions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Throws Error about the argument `where` if so many different pairs of objects are ignored that
/// none is left, and no object is tested against itself. The remedy is to ignore fewer pairs, or
/// what `otherwise` says.
void require_asked(std::uint64_t objects, bool self, std::uint64_t ignored,
                   const std::string& where, const std::string& otherwise);

/// The same of a scene: the pairs that it ignores itself count as well.
void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise);

}  // namespace farcull
