// A float that errs at random as far as GLSL 4.50, section 4.7.1 allows (A4): sums, differences and
// products rounded in either direction, quotients up to 2.5 units in the last place off, results
// below 2^-126 perhaps flushed. Where Worst (core/base/glsl_worst.h) follows all roundings at once
// as ranges, this follows one sequence of them, so that comparisons branch as on a device.
#pragma once

#include <cmath>
#include <random>

namespace farcull::glsl_chance {

/// up, down: every rounding in that direction.
enum class Rounding { random, up, down };
inline std::mt19937_64& engine() {
  static std::mt19937_64 engine(1);
  return engine;
}
inline Rounding& rounding() {
  static Rounding rounding = Rounding::random;
  return rounding;
}

class Chance {
 public:
  Chance() = default;
  Chance(float value) : value_(value) {}  // NOLINT(google-explicit-constructor): as a float
  float value() const { return value_; }
  explicit operator int() const { return static_cast<int>(value_); }

  friend Chance operator-(Chance a) { return -a.value_; }
  friend Chance operator+(Chance a, Chance b) { return rounded(double(a.value_) + b.value_, 0); }
  friend Chance operator-(Chance a, Chance b) { return rounded(double(a.value_) - b.value_, 0); }
  friend Chance operator*(Chance a, Chance b) { return rounded(double(a.value_) * b.value_, 0); }
  friend Chance operator/(Chance a, Chance b) { return rounded(double(a.value_) / b.value_, 2.5); }
  friend bool operator<(Chance a, Chance b) { return a.value_ < b.value_; }
  friend bool operator>(Chance a, Chance b) { return a.value_ > b.value_; }
  friend bool operator<=(Chance a, Chance b) { return a.value_ <= b.value_; }
  friend bool operator>=(Chance a, Chance b) { return a.value_ >= b.value_; }
  friend Chance min(Chance a, Chance b) { return b < a ? b : a; }
  friend Chance max(Chance a, Chance b) { return a < b ? b : a; }
  friend Chance abs(Chance a) { return std::fabs(a.value_); }
  friend Chance clamp(Chance a, Chance lo, Chance hi) { return min(max(a, lo), hi); }

 private:
  static Chance rounded(double exact, double units) {
    const Rounding mode = rounding();
    const bool up =
        mode == Rounding::up || (mode == Rounding::random && (engine()() >> 40 & 1) != 0);
    if (units > 0 && exact != 0) {
      // Rounding to a float adds half a unit to what is taken here.
      const double off = mode == Rounding::random && (engine()() >> 41 & 1) != 0 ? 0 : units - 0.5;
      const double unit = std::ldexp(1.0, std::ilogb(exact) - 23);
      return flushed(static_cast<float>(exact + (up ? off : -off) * unit));
    }
    float nearest = static_cast<float>(exact);
    if (up && nearest < exact) nearest = std::nextafter(nearest, HUGE_VALF);
    if (!up && nearest > exact) nearest = std::nextafter(nearest, -HUGE_VALF);
    return flushed(nearest);
  }
  static Chance flushed(float x) {
    const bool small = x != 0 && std::fabs(x) < 0x1p-126f;
    Chance out;
    out.value_ = small && (engine()() >> 42 & 1) != 0 ? 0 : x;
    return out;
  }

  float value_ = 0;
};

struct vec4 {
  Chance x, y, z, w;
};
inline vec4 operator+(vec4 a, vec4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
inline vec4 operator-(vec4 a, vec4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
inline vec4 operator*(Chance a, vec4 b) { return {a * b.x, a * b.y, a * b.z, a * b.w}; }
inline vec4 min(vec4 a, vec4 b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z), min(a.w, b.w)};
}
inline vec4 max(vec4 a, vec4 b) {
  return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z), max(a.w, b.w)};
}
inline vec4 abs(vec4 a) { return {abs(a.x), abs(a.y), abs(a.z), abs(a.w)}; }

}  // namespace farcull::glsl_chance
