// The error of what near pairs are found by: derivations, and the constants that follow from them.
//
// u = 2^-53. All points are scaled (core/proximity/scene_trees.h): |x| < 4, each off by at most
// 2^-1075 from the point as given times the scale. "Exact" is of the points as given, times the
// scale. Bounds of a distance are in the same units.
//
// Gaps of boxes. Along an axis, a gap is g = fl(lo - hi) where that is positive: a difference has
// no error of underflow, so g <= (G + 2^-1074) (1 + u) with the exact gap G < 8. The sum of the
// squares has three more roundings at most, and products below 2^-1022 are off by 2^-1075: it is at
// most (sum of G^2 + 2^-1069) (1 + u)^5 + 2^-1073. So where it is above P^2 (1 + 16 u) + 2^-900, as
// computed, with three roundings (so at least P^2 (1 + 12 u) + 2^-901), the exact distance is above
// P.
//
// Gaps along a direction d, any vector with components in [-16, 16]. Points are taken relative to
// an origin: x = fl(point - origin) is off by u |x|. A dot product d.x has three products and two
// sums: with the error of x, it is off by less than 5 u |d|.|x| (absolute values per axis). The
// difference of two has one rounding more, of 2 u |d|.|x|: 12 u |d|.X in all, X the largest |x| per
// axis. `gap` is 16 u, which covers the roundings of the doubt itself. The distance is at least the
// gap over the length of d.
//
// Points. Two points p, q are combined from the corners, taken relative to a corner of the first
// triangle; R is the largest |coordinate| of these. Weights are computed, each in [0, 1], and sum
// to 1 up to 4 u. p is within u R (1 + 4 u) (differences) + 3 u R (products and sums) + 4 u R
// (weights, against those divided by their sum) < 9 u R per axis of a point of the triangle, and so
// is q. Their difference has one rounding of 2 u R: below 20.1 u R per axis, 35 u R in length. The
// computed length is below 4 R and off by less than 3 u of itself, and two sums follow: 20 u R. In
// all 55 u R; `point` is 64 u.
//
// Triangles that meet. An edge from p to q passes through a triangle if p and q are strictly on two
// sides of its plane, and the edge passes all three of its sides in the same sense: the signs of
// five determinants of differences of points. A difference is off by u of itself. Each of the six
// products of three then is within (1 + u)^8 of the exact one, two sums included: a determinant is
// off by less than 8.1 u of the sum of the products' magnitudes. `determinant` is 16 u, which
// covers the roundings of that sum. Then the triangles share a point, and 0 is an upper bound.
//
// Underflow: a product is off by at most 2^-1075, so a square of a length above 2^-900 is not
// touched by it; shorter ones count as 2^-900 where the length shall be large enough, and give no
// direction. Everything else that is lost that way is far below `absolute`.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace farcull::near {

constexpr double kUnit = 0x1p-53;
constexpr double kPoint = 64 * kUnit;
constexpr double kGap = 16 * kUnit;
constexpr double kDeterminant = 16 * kUnit;
constexpr double kLeastSquare = 0x1p-900;
constexpr double kAbsolute = 0x1p-900;
/// Larger than the square of any gap of boxes, and finite: a missing box is beyond it.
constexpr double kMostSquare = 1024;

/// Boxes whose squared gap is above this are farther apart than `limit` (>= 0, may be infinite).
inline double square_limit(double limit) {
  const double square = limit * limit * (1 + 16 * kUnit) + kAbsolute;
  return square < kMostSquare ? square : kMostSquare;
}

/// Points farther apart than this along a direction are farther apart than `limit`.
/// squared: of the direction's length; doubt: kGap |d|.X.
inline double gap_limit(double limit, double squared, double doubt) {
  // The root is off by less than 3 u of itself.
  return limit * (std::sqrt(squared) * (1 + 8 * kUnit)) * (1 + 4 * kUnit) + doubt + kAbsolute;
}

}  // namespace farcull::near
