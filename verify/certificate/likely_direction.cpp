// All 38 directions in doubles. Nothing rests on their rounding: a guess is proved by whoever
// asked.
#include "verify/certificate/likely_direction.h"

#include <algorithm>
#include <limits>

#include "verify/certificate/integer_pair.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

Vec3 direction_of(const Corners& a, const Corners& b, int direction) {
  const auto edge = [](const Corners& t, int i) -> Vec3 { return t[(i + 1) % 3] - t[i]; };
  const auto cross = [](const Vec3& x, const Vec3& y) -> Vec3 {
    return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  };
  if (direction < 2) {
    const Corners& t = direction == 0 ? a : b;
    return cross(edge(t, 0), edge(t, 1));
  }
  const int family = (direction - 2) / 9;
  const int i = (direction - 2) % 9 / 3;
  const int j = (direction - 2) % 3;
  const Vec3 w = b[j] - a[i];
  if (family == 0) return cross(edge(a, i), edge(b, j));
  if (family == 3) return w;
  const Vec3 e = family == 1 ? edge(a, i) : edge(b, j);
  return w * e.dot(e) - e * w.dot(e);
}

}  // namespace

int likely_direction(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  constexpr double kClear = 1e-6;
  int best = 29;
  double widest = -std::numeric_limits<double>::infinity();
  for (int n = 0; n < kDirections; ++n) {
    const int direction = n < 9 ? 29 + n : n - 9;
    const Vec3 d = direction_of(a, b, direction);
    std::array<double, 3> on_a;
    std::array<double, 3> on_b;
    for (int i = 0; i < 3; ++i) {
      on_a[i] = d.dot(a[i] - a[0]);
      on_b[i] = d.dot(b[i] - a[0]);
    }
    const auto [a_lo, a_hi] = std::minmax({on_a[0], on_a[1], on_a[2]});
    const auto [b_lo, b_hi] = std::minmax({on_b[0], on_b[1], on_b[2]});
    const double extent = std::max(a_hi, b_hi) - std::min(a_lo, b_lo);
    const double needed = clearance == 0 ? 0 : clearance * d.norm();
    const double gap = (std::max(b_lo - a_hi, a_lo - b_hi) - needed) / extent;
    if (gap > kClear) return direction;
    if (gap > widest) {
      widest = gap;
      best = direction;
    }
  }
  return best;
}

}  // namespace farcull
