// A line along z and an oriented box, as the floats of a Solid say it (offsets/obb.glsl): three
// slabs |a . (p - m)| <= h, cut by zlo <= z <= zhi. The exact interval decides what a kernel must
// contain.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/canvas/canvas.h"
#include "verify/rational.h"

namespace farcull::box_line {

using rational::Draws;
using rational::Q;

template <typename Number>
struct Interval {
  Number lo, hi;
};

/// The solid's interval along the line, without rounding; none where the line misses it.
inline std::optional<Interval<Q>> exact_interval(float cx, float cy, const Solid& s) {
  Interval<Q> z{Q(s[0][3]), Q(s[4][0])};
  for (int i = 1; i <= 3; ++i) {
    const Q at = Q(s[i][0]) * (Q(cx) - Q(s[0][0])) + Q(s[i][1]) * (Q(cy) - Q(s[0][1]));
    const Q h(s[i][3]), a(s[i][2]);
    if (a == 0) {
      if (abs(at) > h) return std::nullopt;
      continue;
    }
    Q z0 = Q(s[0][2]) + (-h - at) / a, z1 = Q(s[0][2]) + (h - at) / a;
    if (a < 0) std::swap(z0, z1);
    z.lo = std::max(z.lo, z0);
    z.hi = std::min(z.hi, z1);
  }
  if (z.lo > z.hi) return std::nullopt;
  return z;
}

/// In double, a little too large; none where the line misses for certain. Products of floats are
/// exact in double, the differences and sums err by 2^-53 each of the terms' sizes: 2^-49 is beyond
/// all of them together.
inline std::optional<Interval<double>> outer_interval(float cx, float cy, const Solid& s) {
  Interval<double> z{s[0][3], s[4][0]};
  for (int i = 1; i <= 3; ++i) {
    const double x = double(s[i][0]) * (double(cx) - s[0][0]);
    const double y = double(s[i][1]) * (double(cy) - s[0][1]);
    const double at = x + y, h = s[i][3], a = s[i][2];
    const double e = 0x1p-49 * (std::abs(x) + std::abs(y) + h) + 0x1p-1000;
    if (a == 0) {
      if (std::abs(at) > h + e) return std::nullopt;
      continue;
    }
    double z0 = (-h - at) / a, z1 = (h - at) / a;
    if (a < 0) std::swap(z0, z1);
    const double f =
        e / std::abs(a) + 0x1p-49 * (std::abs(z0) + std::abs(z1) + std::abs(double(s[0][2])));
    z.lo = std::max(z.lo, s[0][2] + z0 - f);
    z.hi = std::min(z.hi, s[0][2] + z1 + f);
  }
  if (z.lo > z.hi) return std::nullopt;
  return z;
}

inline float number(double x) { return static_cast<float>(x); }

/// A solid made of floats directly: slabs on either side of "parallel", normals with zeros and
/// denormals, far middles, thin and thick; the line passes through it or close to its border.
inline Solid adversarial_at(Draws& random, float cx, float cy) {
  Solid s{};
  const double far = random.below(3) == 0 ? 1e9 : 1000;
  s[0] = {number(cx + random.scaled(-2, 8)), number(cy + random.scaled(-2, 8)),
          number(random.uniform(-far, far)), 0};
  if (random.below(10) == 0) s[0][random.below(3)] = 0;
  for (int i = 1; i <= 3; ++i) {
    const Vec3 a = random.cube(1).normalized();
    for (int k = 0; k < 3; ++k) s[i][k] = number(a[k]);
    switch (random.below(8)) {
      case 0:
        s[i][2] = 0;
        break;
      case 1:
        s[i][2] = number(random.sign() * 0x1p-20 * random.uniform(0.99, 1.01));
        break;
      case 2:
        s[i][2] = std::nextafter(0x1p-20f, random.coin() ? 0.f : 1.f);
        break;
      case 3:
        s[i][2] = number(random.scaled(-149, -18));
        break;
      case 4:
        s[i][random.below(3)] = number(random.scaled(-149, -100));
        break;
      case 5:
        s[i][random.below(2)] = 0;
        break;
      default:
        break;
    }
    // The border of the slab close to the line, measured at a depth of its own.
    const double at =
        double(s[i][0]) * (double(cx) - s[0][0]) + double(s[i][1]) * (double(cy) - s[0][1]);
    double h = std::abs(random.scaled(-10, 10));
    if (random.coin()) h = std::abs(at) * (1 + random.scaled(-30, -18));
    if (random.below(4) == 0) h = std::abs(at + s[i][2] * random.uniform(-far, far) * 0.01);
    s[i][3] = std::max(number(h), 0.f);
  }
  const double thick = std::abs(random.scaled(-6, 12));
  double mid = s[0][2] + random.scaled(-6, 8);
  s[0][3] = number(mid - thick);
  s[4][0] = std::max(number(mid + thick), s[0][3]);
  if (random.below(4) == 0) {  // the slabs alone decide
    s[0][3] = number(-2 * far);
    s[4][0] = number(2 * far);
  }
  return s;
}

inline void adversarial(Draws& random, Solid& s, float& cx, float& cy) {
  cx = static_cast<float>(random.below(1200) - 600 + 0.5);
  cy = static_cast<float>(random.below(1200) - 600 + 0.5);
  s = adversarial_at(random, cx, cy);
}

}  // namespace farcull::box_line
