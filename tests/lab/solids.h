// Draws of hard triangles and solids with the centre of a pixel near them.
#pragma once

#include <tuple>

#include "verify/kernel_cases.h"

namespace farcull::box_line {

/// The centre of a pixel, and a solid near it.
inline std::tuple<float, float, Solid> adversarial(Draws& random) {
  const float cx = static_cast<float>(random.below(1200) - 600 + 0.5);
  const float cy = static_cast<float>(random.below(1200) - 600 + 0.5);
  return {cx, cy, adversarial_at(random, cx, cy)};
}

}  // namespace farcull::box_line

namespace farcull::minkowski_cases {

inline Case random_case(Draws& random, int kind) {
  const float cx = static_cast<float>(random.below(1200) - 600 + 0.5);
  const float cy = static_cast<float>(random.below(1200) - 600 + 0.5);
  return random_case_at(random, kind, cx, cy);
}

inline std::tuple<float, float, Solid> adversarial(Draws& random) {
  const float cx = number(random.below(1000) - 500 + 0.5);
  const float cy = number(random.below(1000) - 500 + 0.5);
  return {cx, cy, adversarial_at(random, cx, cy)};
}

}  // namespace farcull::minkowski_cases
