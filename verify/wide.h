// Numbers with about 106 bits, each with a bound of its error. nearest() tells whether the bound is
// small enough to round the number correctly (Dekker, A Floating-Point Technique for Extending the
// Available Precision, 1971; Ziv, Fast Evaluation of Elementary Mathematical Functions with
// Correctly Rounded Last Bit, 1991). Only verify/contact_points.cpp uses this file.
//
// u = 2^-53. Products, quotients and sums are rounded to nearest, so each is off by at most u times
// the result. exact_sum() and exact_product() also give the part that rounding cuts off. If all
// these parts are kept, as for coordinates of few digits, the error is 0.
//
// A bound is a sum of terms >= 0 and has at most 12 roundings. So the computed bound is at least
// (1 - u)^12 times the exact bound. Bounds::factor makes up for this. It also makes up for a factor
// 1 + u, since |hi + lo| <= (1 + u) |hi|.
//
// Underflow. Precondition: each number at the start is a sum of at most two doubles, and each
// double is 0 or of a magnitude in [2^-100, 2^100]. Later values are sums of products of at most
// four of these numbers.
// - Before a division nothing underflows: sums are multiples of 2^-152, products of four are
//   multiples of 2^-608, and an error above 0 is at least u times such a product.
// - A quotient of a product of four and one of three is 0 or above 2^-916. Its low part and its
//   bound may underflow, by 2^-1070 in all. kUnderflow covers this.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

namespace farcull::wide {

/// Each bound is multiplied by this factor last. The factor is a member of a type, so that tests
/// can pass a type with a smaller factor, and show that its bounds give wrong answers.
struct Bounds {
  static constexpr double factor = 1 + 0x1p-48;
};
constexpr double kUnit = 0x1p-53;
constexpr double kUnderflow = 0x1p-140;  // relative to the quotient
constexpr double kLeast = 0x1p-100, kMost = 0x1p100;

struct Parts {
  double hi, lo;  // hi is the double nearest to hi + lo
};

inline Parts exact_sum(double x, double y) {
  const double sum = x + y, of_y = sum - x;
  return {sum, (x - (sum - of_y)) + (y - of_y)};
}

inline Parts exact_product(double x, double y) {
  const auto halves = [](double z) {
    const double scaled = 0x8000001p0 * z, high = scaled - (scaled - z);
    return Parts{high, z - high};
  };
  const double product = x * y;
  const auto [x_hi, x_lo] = halves(x);
  const auto [y_hi, y_lo] = halves(y);
  return {product, ((x_hi * y_hi - product) + x_hi * y_lo + x_lo * y_hi) + x_lo * y_lo};
}

/// A number that differs from hi + lo by at most `error`; hi is the double nearest to hi + lo.
template <class B>
struct Number {
  double hi = 0, lo = 0, error = 0;
  Number() = default;
  Number(double x) : hi(x) {}
  Number(Parts first, double low, double error_of_low) {
    const double rest = first.lo + low;
    if (low != 0) error_of_low += kUnit * std::abs(rest);
    const auto [sum, left] = exact_sum(first.hi, rest);
    hi = sum;
    lo = left;
    error = error_of_low * B::factor;
  }
  bool is_zero() const { return hi == 0 && error == 0; }
};

template <class B>
Number<B> operator+(const Number<B>& a, const Number<B>& b) {
  const double low = a.lo + b.lo;
  return {exact_sum(a.hi, b.hi), low, a.error + b.error + kUnit * std::abs(low)};
}

template <class B>
Number<B> operator-(const Number<B>& a, const Number<B>& b) {
  const double low = a.lo - b.lo;
  return {exact_sum(a.hi, -b.hi), low, a.error + b.error + kUnit * std::abs(low)};
}

template <class B>
Number<B> operator*(const Number<B>& a, const Number<B>& b) {
  const double first = a.hi * b.lo, second = a.lo * b.hi, low = first + second;
  const double rounding = std::abs(first) + std::abs(second) + std::abs(low);
  return {exact_product(a.hi, b.hi), low,
          std::abs(a.hi) * b.error + std::abs(b.hi) * a.error + a.error * b.error +
              std::abs(a.lo * b.lo) + kUnit * rounding};
}

/// Let q be `first`, and r = a - q b. Then a / b = q + r / b. `second` is r.hi / b.hi, which is off
/// from r / b by (r - r.hi - d r.hi / b.hi) / b, where d = b - b.hi.
template <class B>
Number<B> operator/(const Number<B>& a, const Number<B>& b) {
  const double first = a.hi / b.hi;
  const Number<B> rest = a - Number<B>(first) * b;
  const double second = rest.hi / b.hi, size = std::abs(b.hi), off = std::abs(b.lo) + b.error;
  if (!(off < size / 2)) return {{0, 0}, 0, std::numeric_limits<double>::infinity()};
  const double left = std::abs(rest.lo) + rest.error + std::abs(second) * off;
  return {exact_sum(first, second), 0,
          2 * left / size + kUnit * std::abs(second) + kUnderflow * std::abs(first)};
}

/// Returns the double nearest to the number, never -0.0; empty if two doubles are possible.
/// Rounding is monotone: if both ends of the number's interval are rounded to hi, so is the number.
/// The sums of x.lo and `error` are rounded, too, by at most u |lo| + u error. So `error` is
/// enlarged first.
template <class B>
std::optional<double> nearest(const Number<B>& x) {
  const double error = x.error * B::factor + 4 * kUnit * std::abs(x.lo);
  if (x.hi + (x.lo + error) != x.hi || x.hi + (x.lo - error) != x.hi) return std::nullopt;
  return x.hi + 0.0;
}

}  // namespace farcull::wide
