// Rational arithmetic for checks of rounded geometry. Doubles and floats are converted to rationals
// without rounding, so a claimed bound is decided, not estimated. Also contains random numbers,
// which depend only on a seed and on the math library.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/random.h"
#include "core/scene/scene.h"
#include "verify/closest_features.h"

namespace farcull::rational {

using Q = mpq_class;
using Q3 = std::array<Q, 3>;

inline Q3 exact(const Vec3& p) { return {Q(p[0]), Q(p[1]), Q(p[2])}; }
using closest::cross;
using closest::dot;
using closest::minus;
/// Returns a + t (b - a).
inline Q3 between(const Q3& a, const Q3& b, const Q& t) {
  Q3 out;
  for (int i = 0; i < 3; ++i) out[i] = a[i] + t * (b[i] - a[i]);
  return out;
}

/// Returns the part of a convex polygon where sign * p[axis] <= sign * bound.
inline std::vector<Q3> clipped(const std::vector<Q3>& polygon, int axis, int sign, const Q& bound) {
  std::vector<Q3> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Q3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const Q dp = sign * (p[axis] - bound), dq = sign * (q[axis] - bound);
    if (dp <= 0) out.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) out.push_back(between(p, q, dp / (dp - dq)));
  }
  return out;
}

class Draws : public RandomNumbers {
 public:
  using RandomNumbers::RandomNumbers;

  std::uint64_t bits() { return word(); }
  bool coin() { return (word() >> 33) & 1; }
  double uniform(double lo, double hi) { return between(lo, hi); }
  double sign() { return coin() ? 1 : -1; }
  /// Returns a number of random sign and magnitude 2^e, where e is uniform in lo .. hi.
  double scaled(double lo, double hi) { return sign() * std::exp2(uniform(lo, hi)); }
  Vec3 cube(double half) {
    return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
  }
  Vec3 scaled3(double lo, double hi) { return {scaled(lo, hi), scaled(lo, hi), scaled(lo, hi)}; }
};

}  // namespace farcull::rational
