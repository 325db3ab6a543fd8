// Counts the pairs that a scene does not ask about: those inside an object that is not `self`. No
// number of pairs met, missed or proved speaks of them, so whoever reports one reports this as
// well.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

struct NotAsked {
  std::uint64_t objects = 0;                         // that are not tested against themselves
  std::uint64_t pairs = 0;                           // of two triangles inside one of them
  std::vector<std::array<std::uint32_t, 2>> ranges;  // these objects, as [first, last]
};

NotAsked not_asked(const Scene& scene);

}  // namespace farcull
