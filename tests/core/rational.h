// Exact arithmetic for tests of rounded geometry: a double or float converts to a rational exactly,
// so a claimed bound is decided, not estimated.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "core/view.h"

namespace farcull::rational {

using Q = mpq_class;
using Q3 = std::array<Q, 3>;

inline Q3 exact(const Vec3& p) { return {Q(p[0]), Q(p[1]), Q(p[2])}; }

/// map * (x - origin) without rounding.
inline Q3 image(const Window& window, const Vec3& x) {
  Q3 d;
  for (int i = 0; i < 3; ++i) d[i] = Q(x[i]) - Q(window.origin[i]);
  Q3 out;
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < 3; ++i) out[row] += Q(window.map(row, i)) * d[i];
  }
  return out;
}

inline Q3 minus(const Q3& a, const Q3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Q dot(const Q3& a, const Q3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
/// a + t (b - a)
inline Q3 between(const Q3& a, const Q3& b, const Q& t) {
  Q3 out;
  for (int i = 0; i < 3; ++i) out[i] = a[i] + t * (b[i] - a[i]);
  return out;
}

inline std::vector<Vec3> box_corners(const Box& box) {
  std::vector<Vec3> corners;
  for (int bits = 0; bits < 8; ++bits) {
    corners.emplace_back(bits & 1 ? box.hi[0] : box.lo[0], bits & 2 ? box.hi[1] : box.lo[1],
                         bits & 4 ? box.hi[2] : box.lo[2]);
  }
  return corners;
}

/// A generator with the draws that these tests share. Its seed is printed; FARCULL_TEST_SEED gives
/// another one.
class Random {
 public:
  explicit Random(std::uint64_t seed) {
    if (const char* given = std::getenv("FARCULL_TEST_SEED")) seed = std::stoull(given);
    std::cout << "[ seed " << seed << "; FARCULL_TEST_SEED=... for another ]\n";
    engine_.seed(seed);
  }

  std::uint64_t bits() { return engine_(); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  bool coin() { return (engine_() >> 33) & 1; }
  double uniform(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  double sign() { return coin() ? 1 : -1; }
  /// A random sign and magnitude 2^lo .. 2^hi, the exponent uniform.
  double scaled(double lo, double hi) { return sign() * std::exp2(uniform(lo, hi)); }
  Vec3 cube(double half) {
    return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
  }
  Vec3 scaled3(double lo, double hi) { return {scaled(lo, hi), scaled(lo, hi), scaled(lo, hi)}; }

 private:
  std::mt19937_64 engine_;
};

/// An axis view, a round oblique one, or a direction with components of very different sizes.
inline View random_view(Random& random) {
  static const char* const kNames[] = {"x",           "-x",    "y",     "-y",
                                       "z",           "-z",    "1:1:1", "1:-2:0.5",
                                       "1:1e-8:1e-9", "0:1:1", "3:4:0", "1:1:0"};
  const int pick = random.below(18);
  if (pick < 12) return parse_view(kNames[pick]);
  const Vec3 d = pick < 15 ? random.cube(1) : random.scaled3(-40, 1);
  char text[100];
  std::snprintf(text, sizeof text, "%.17g:%.17g:%.17g", d[0], d[1], d[2]);
  return parse_view(text);
}

}  // namespace farcull::rational
