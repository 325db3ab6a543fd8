// Tests in doubles whether boxes or triangles are farther apart than a limit. Each test is true
// only if bounds of all roundings prove this.
//
// u = 2^-53 is the unit roundoff. Sums and differences of doubles have a relative error of at most
// u, even if the result is subnormal. Products and quotients have a relative error of at most u,
// plus an absolute error below 2^-1074 if the result is subnormal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/scene.h"
#include "verify/certificate/box_pairs.h"

namespace farcull::separation {

inline constexpr double kU = 0x1p-53;

using Bounds = BoundsTree::Bounds;

/// True only if all points of the two boxes are farther apart than `limit` (>= 0, finite).
///
/// A gap along an axis is one rounded difference. Rounding is monotone, so a gap above the limit is
/// proved. The sum of squares has three squared differences (each off by a factor (1 + u)^2), three
/// products and two sums. The root has one rounding. The relative error is below 8 u in all if the
/// squares are normal numbers. The root is used only if nothing overflows, and if it is so large
/// that the loss to subnormal squares is far below u of the root.
inline bool farther(const Bounds& a, const Bounds& b, double limit) {
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({b.lo[axis] - a.hi[axis], a.lo[axis] - b.hi[axis], 0.0});
    if (gap > limit) return true;
    squares += gap * gap;
  }
  if (!(squares > 0x1p-900 && squares < std::numeric_limits<double>::infinity())) return false;
  return std::sqrt(squares) * (1 - 16 * kU) > limit;
}

/// True only if all points of the two triangles (or of two other convex hulls) are farther apart
/// than `limit` (>= 0, finite). Proof: two parallel planes are farther apart than the limit, all of
/// a is before the first plane, and all of b is beyond the second plane.
///
/// The directions come from Gilbert's descent towards the closest points (An Iterative Procedure
/// for Computing the Minimum of a Quadratic Form on a Convex Set, SIAM J. Control, 1966). Any
/// direction may be tried, since the gap along the direction is bounded with all roundings.
template <class Points, class Others>
bool farther_by_planes(const Points& a, const Others& b, double limit) {
  constexpr int kSteps = 24;
  // Returns p relative to a corner of a. Each coordinate of y is one rounded difference.
  const auto y = [&](const Vec3& p) -> Vec3 { return p - a[0]; };
  Vec3 near = Vec3::Zero();
  for (const Vec3& p : b) near += y(p) / static_cast<double>(std::size(b));
  for (const Vec3& p : a) near -= y(p) / static_cast<double>(std::size(a));
  for (int step = 0; step < kSteps; ++step) {
    const double largest = near.cwiseAbs().maxCoeff();
    if (!(largest > 0 && largest < std::numeric_limits<double>::infinity())) return false;
    // n counts as exact. Its largest component is 1 or -1, so its length is from 1 to 1.8.
    const Vec3 n = near / largest;
    double s_most = -std::numeric_limits<double>::infinity(), t_least = -s_most, magnitude = 0;
    Vec3 s_at = Vec3::Zero(), t_at = Vec3::Zero();
    for (const Vec3& p : a) {
      const Vec3 s = y(p);
      magnitude = std::max(magnitude, n.cwiseAbs().dot(s.cwiseAbs()));
      if (const double of_s = n.dot(s); of_s > s_most) s_most = of_s, s_at = s;
    }
    for (const Vec3& p : b) {
      const Vec3 t = y(p);
      magnitude = std::max(magnitude, n.cwiseAbs().dot(t.cwiseAbs()));
      if (const double of_t = n.dot(t); of_t < t_least) t_least = of_t, t_at = t;
    }
    // In n . y, each of three terms is rounded twice: in y and in the product. Then come two sums.
    // So s_most and t_least are off by at most 4.01 u of `magnitude`. The loss to subnormal
    // products is far below 2^-1000. The difference is rounded once more, by at most 2 u of
    // `magnitude`. The length is off by 4 u of itself, the quotient by 1 u.
    const double gap = t_least - s_most - 16 * kU * magnitude - 0x1p-1000;
    if (!std::isfinite(magnitude)) return false;
    if (gap > 0x1p-900 && gap / n.norm() * (1 - 16 * kU) > limit) return true;
    const Vec3 step_to = (t_at - s_at) - near;
    const double length = step_to.squaredNorm();
    if (!(length > 0)) return false;
    const double part = std::clamp(-near.dot(step_to) / length, 0.0, 1.0);
    if (!(part > 0)) return false;  // no direction is better
    near += part * step_to;
  }
  return false;
}

}  // namespace farcull::separation
