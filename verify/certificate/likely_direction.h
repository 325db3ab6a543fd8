// A guess which of the 38 directions (integer_pair.h) parts two triangles most clearly.
#pragma once

#include <array>

#include "core/scene/scene.h"

namespace farcull {

/// A direction whose gap beyond the clearance, in doubles, is clear of rounding, cheap ones first;
/// else the one with the widest in proportion. Only a guess, whatever doubles overflow.
int likely_direction(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

}  // namespace farcull
