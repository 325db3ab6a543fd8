// The exact distance of two triangles with the features that realise it, and the proof that two
// triangles are no nearer than some length, both in integers. For the checker of distances: it
// knows neither CGAL nor verify/closest. docs/certificate.md has the theorems.
//
// Semantics as in verify/exact.h: closed convex hulls of the three corners, degenerate triangles
// included. Preconditions: finite coordinates; subnormals are not flushed to zero.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/scene/scene.h"
#include "verify/certificate/integers.h"

namespace farcull {

/// (over[k] / under) 2^exponent + from[k] along axis k.
struct FractionPoint {
  std::array<mpz_class, 3> over;
  mpz_class under = 1;  // > 0
  int exponent = 0;
  Vec3 from;
};
/// True iff each coordinate of x is the point's, rounded as IEEE 754 does: to the nearest double,
/// of two equally near ones to the even one, beyond the largest double to infinity. False for -0.0.
bool is_rounded(const Vec3& x, const FractionPoint& point);

/// The distance of two triangles, and where on them its ends lie. Features are numbered: 0 to 2 the
/// corners, 3 to 5 the edge from corner 0 to 2 to the next one, 6 the face. Of all pairs of nearest
/// points this is the first pair of features that has one, that of a compared first.
struct IntegerDistance {
  Fraction squared;
  std::array<std::uint8_t, 2> features{};
  /// The only two nearest points on these features, of a and of b.
  std::array<FractionPoint, 2> points;
};

/// Points are constructed for one pair of features after the other, until two of them lie in their
/// triangles and are proved nearest by the signs of scalar products.
IntegerDistance integer_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the distance is more than `length`; with or_as_far, iff it is at least that. By one of
/// the 38 directions of integer_pair.h, whose gap g is long enough: g^2 > length^2 (d . d), or >=.
/// So it shares no construction with integer_distance().
bool is_beyond(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Length& length,
               bool or_as_far);

}  // namespace farcull
