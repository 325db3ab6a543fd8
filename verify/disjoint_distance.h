// Distances of triangles against a clearance, in exact arithmetic.
//
// Semantics and preconditions as in verify/exact.h: closed convex hulls of the three corners with
// the doubles as given, any finite ones, degenerate triangles included.
#pragma once

#include <array>

#include "core/scene/scene.h"

namespace farcull {

/// True iff the distance of two disjoint triangles is at most `clearance` (world units, finite, >=
/// 0). Compares squared distances of rational points with the square of the clearance; nothing is
/// rounded. Precondition: the triangles share no point (only the boundaries are looked at, so
/// crossing triangles could get a wrong answer).
bool disjoint_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

}  // namespace farcull
