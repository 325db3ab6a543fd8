// Contacts of two triangles within a distance: how far apart, where, and in which direction.
//
// Semantics and preconditions as in verify/exact.h: closed convex hulls of the three corners with
// the doubles as given, any finite ones, degenerate triangles included.
#pragma once

#include <array>
#include <optional>

#include "verify/closest.h"
#include "verify/rounding.h"

namespace farcull {

/// Two nearest points p of a and q of b. weights: a point is the mean of the corners with these
/// weights (>= 0). features: what the points lie on, by which weights are not 0. normal: (q - p) /
/// |q - p|; zeros if the triangles meet: then the distance is 0, and the points are equal.
struct NearContact {
  double distance = 0;
  std::array<Vec3, 2> points;
  std::array<Vec3, 2> weights = {};
  Vec3 normal = Vec3::Zero();
  std::array<Feature, 2> features;
};

/// closest: the result of closest_points(a, b). Distance, points and weights are each rounded once;
/// each coordinate of the normal is off by at most 8 u of itself.
NearContact exact_contact(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                          const Closest& closest);

/// contact_within() accepts a distance in doubles if its bounds are at most this far apart,
/// relative to the lower one. Tests show wrong answers with an infinite tolerance.
constexpr double kContactTolerance = 0x1p-33;

/// The contact of triangles whose distance is at most `within` (finite, >= 0); empty if they are
/// farther apart, which is decided exactly. planes: filter_planes(a, b, within). Doubles answer if
/// error bounds allow it, else exact_contact(). R is the largest difference of two coordinates on
/// one axis, u = 2^-53. Each of these then holds:
/// - distance: off by at most 2^-32 of itself, a subnormal one by half of its last bit; 0 iff the
///   triangles meet, unless it is below the least double.
/// - points: each is in its triangle up to 2^-45 R and the rounding of its coordinates (u of each).
/// - weights: sum to 1 up to 4 u. Their mean of the corners is the point, up to the same errors.
/// - p and q are as far apart as the distance, up to the same errors. Other points may be as near.
/// - normal: off by at most 2^-15 in length from the exact one, which is unique.
std::optional<NearContact> contact_within(const std::array<Vec3, 3>& a,
                                          const std::array<Vec3, 3>& b, double within,
                                          Triage planes, double tolerance = kContactTolerance);

}  // namespace farcull
