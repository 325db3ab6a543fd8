// Distances of triangles against the root of a rational number. For sources that include GMP.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cstdint>

#include "core/scene/scene.h"

namespace farcull {

/// Which distances are asked about: below a bound, or the bound as well.
enum class Bound : std::uint8_t { below, at_most };

/// True iff the distance of two disjoint triangles is below the root of `squared` (>= 0), or at
/// most that. Precondition: the triangles share no point, as for disjoint_within().
bool disjoint_nearer(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                     const mpq_class& squared, Bound bound);

}  // namespace farcull
