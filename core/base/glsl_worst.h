// Simulates a device whose arithmetic is as inaccurate as GLSL allows, for kernels (*.glsl)
// compiled as C++. The class Worst replaces float. A Worst is the range of all floats that the
// device could compute (GLSL 4.50, section 4.7.1; assumption A4 of docs/reliability.md). Sums,
// differences and products may be rounded in any direction. Quotients err by at most 2.5 ulp, and
// square roots by at most 5 ulp (as 1 / inversesqrt). Subnormal numbers may be flushed to zero. A
// comparison is true only if it is true for all floats of both ranges. Include a kernel after all
// headers, between `#define float Worst` and `#undef float`.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace farcull::glsl_worst {

class Worst {
 public:
  Worst() = default;
  Worst(float x)  // NOLINT(google-explicit-constructor): kernels mix in literals
      : Worst(rounded(x, x, 0)) {}

  float lo() const { return lo_; }
  float hi() const { return hi_; }
  /// Returns the middle of the range. Kernels call this for a value that they may choose freely.
  friend Worst fixed(Worst a) {
    return Worst(static_cast<float>(0.5 * (static_cast<double>(a.lo_) + a.hi_)));
  }

  friend Worst operator-(Worst a) { return {-a.hi_, -a.lo_}; }
  friend Worst operator+(Worst a, Worst b) {
    return rounded(sum(a.lo_, b.lo_, -1), sum(a.hi_, b.hi_, 1), 0);
  }
  friend Worst operator-(Worst a, Worst b) { return a + -b; }
  friend Worst operator*(Worst a, Worst b) {
    const double p[4] = {double(a.lo_) * b.lo_, double(a.lo_) * b.hi_, double(a.hi_) * b.lo_,
                         double(a.hi_) * b.hi_};
    return rounded(*std::min_element(p, p + 4), *std::max_element(p, p + 4), 0);
  }
  /// Precondition: the range of b does not contain zero.
  friend Worst operator/(Worst a, Worst b) {
    const double q[4] = {double(a.lo_) / b.lo_, double(a.lo_) / b.hi_, double(a.hi_) / b.lo_,
                         double(a.hi_) / b.hi_};
    return rounded(*std::min_element(q, q + 4), *std::max_element(q, q + 4), 2.5);
  }
  friend bool operator<(Worst a, Worst b) { return a.hi_ < b.lo_; }
  friend bool operator>(Worst a, Worst b) { return b < a; }
  friend bool operator<=(Worst a, Worst b) { return a.hi_ <= b.lo_; }
  friend bool operator>=(Worst a, Worst b) { return b <= a; }
  friend Worst min(Worst a, Worst b) { return {std::min(a.lo_, b.lo_), std::min(a.hi_, b.hi_)}; }
  friend Worst max(Worst a, Worst b) { return {std::max(a.lo_, b.lo_), std::max(a.hi_, b.hi_)}; }
  friend Worst abs(Worst a) {
    if (a.lo_ >= 0) return a;
    if (a.hi_ <= 0) return -a;
    return {0, std::max(-a.lo_, a.hi_)};
  }
  friend Worst sqrt(Worst a) {
    return rounded(std::sqrt(std::max(0.0, double(a.lo_))), std::sqrt(std::max(0.0, double(a.hi_))),
                   5);
  }

 private:
  Worst(float lo, float hi) : lo_(lo), hi_(hi) {}

  // Returns a + b, rounded up if `sign` is 1 and down if it is -1. `s` is the sum rounded to
  // nearest; `lost` is the exact rounding error of `s`, by Knuth's two-sum.
  static double sum(double a, double b, double sign) {
    const double s = a + b, part = s - a;
    const double lost = (a - (s - part)) + (b - part);
    return sign * lost > 0 ? std::nextafter(s, sign * HUGE_VAL) : s;
  }

  // Widens [lo, hi] by `units` units in the last place, and rounds outward to floats. If flushing a
  // subnormal bound to zero widens the range, the bound becomes 0.
  static Worst rounded(double lo, double hi, double units) {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    constexpr double kUlp = 0x1p-23, kSmallest = 0x1p-126;
    lo -= units * kUlp * std::abs(lo);
    hi += units * kUlp * std::abs(hi);
    float down = static_cast<float>(lo), up = static_cast<float>(hi);
    if (down > lo) down = std::nextafter(down, -kInf);
    if (up < hi) up = std::nextafter(up, kInf);
    if (down > 0 && down < kSmallest) down = 0;
    if (up < 0 && up > -kSmallest) up = 0;
    return {down, up};
  }

  float lo_ = 0;
  float hi_ = 0;
};

struct vec2 {
  Worst x, y;
};
struct vec4 {
  Worst x, y, z, w;
};

}  // namespace farcull::glsl_worst
