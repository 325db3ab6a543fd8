// One rule for program, library and Python: if nothing is tested, there is an error and no answer,
// since the answer "0 pairs" would look like a scene without collisions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Throws Error about the argument `where` if all pairs of different objects are ignored (`ignored`
/// of them) and no object is tested against itself. The remedy is to ignore fewer pairs, or the one
/// that `otherwise` gives.
void require_asked(std::uint64_t objects, bool self, std::uint64_t ignored,
                   const std::string& where, const std::string& otherwise);

/// The same for a scene; the pairs that the scene itself ignores count as well.
void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise);

}  // namespace farcull
