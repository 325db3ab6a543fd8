// Distances of triangles against a clearance, in exact arithmetic.
//
// Semantics and preconditions as in verify/exact.h: closed convex hulls of the three corners with
// the doubles as given, any finite ones, degenerate triangles included.
#pragma once

#include <array>

#include "core/scene/scene.h"

namespace farcull {

/// True iff the distance of two disjoint triangles is at most `clearance` (world units, finite,
/// >= 0): squared distances of rational points against the square of the clearance, nothing
/// rounded. Precondition: the triangles share no point (of crossing ones only the boundaries are
/// seen).
bool disjoint_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

}  // namespace farcull
