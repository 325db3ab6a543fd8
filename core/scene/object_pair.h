// Two objects of a scene.
#pragma once

#include <compare>
#include <cstdint>

namespace farcull {

/// As indices, a < b; or one object twice.
struct ObjectPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  auto operator<=>(const ObjectPair&) const = default;
};

}  // namespace farcull
