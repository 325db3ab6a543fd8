// The numbers of verify/certificate: vectors of machine integers and of GMP integers, fractions,
// and the conversion of doubles to integers. Only the sources of verify/certificate,
// verify/distance_accounting.h and tests include this file.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/scene/scene.h"

namespace farcull::integer {

__extension__ using Wide = __int128;

template <class Integer>
using Vector = std::array<Integer, 3>;
template <class Integer>
using Corners = std::array<Vector<Integer>, 3>;

inline void multiply(Wide& out, Wide x, Wide y) { out = x * y; }
inline void add_product(Wide& out, Wide x, Wide y) { out += x * y; }
inline void subtract_product(Wide& out, Wide x, Wide y) { out -= x * y; }

inline void multiply(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_mul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}
inline void add_product(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_addmul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}
inline void subtract_product(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_submul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}

template <class Integer>
void minus(Vector<Integer>& out, const Vector<Integer>& x, const Vector<Integer>& y) {
  for (int k = 0; k < 3; ++k) out[k] = x[k] - y[k];
}

template <class Integer>
void dot(Integer& out, const Vector<Integer>& x, const Vector<Integer>& y) {
  multiply(out, x[0], y[0]);
  add_product(out, x[1], y[1]);
  add_product(out, x[2], y[2]);
}

template <class Integer>
void cross(Vector<Integer>& out, const Vector<Integer>& x, const Vector<Integer>& y) {
  for (int k = 0; k < 3; ++k) {
    multiply(out[k], x[(k + 1) % 3], y[(k + 2) % 3]);
    subtract_product(out[k], x[(k + 2) % 3], y[(k + 1) % 3]);
  }
}

template <class Integer>
bool is_zero(const Vector<Integer>& x) {
  return x[0] == 0 && x[1] == 0 && x[2] == 0;
}

template <class Integer>
void edge(Vector<Integer>& out, const Corners<Integer>& t, int i) {
  minus(out, t[(i + 1) % 3], t[i]);
}

// A pair of triangles in integers. Every finite double is an integer times a power of two. So one
// common power of two turns all coordinates of a pair into integers without rounding.

/// A double as mantissa * 2^exponent. The mantissa is odd or 0.
struct Parts {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

/// Splits a double into mantissa and exponent. Precondition: the value is finite.
inline Parts parts(double value) {
  if (value == 0) return {};
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa >> zeros, exponent - 53 + zeros};
}

/// Sets `to` to value / 2^exponent. Precondition: the quotient is an integer.
inline void scale(mpz_class& to, double value, int exponent) {
  const Parts x = parts(value);
  to = static_cast<long>(x.mantissa);
  if (x.mantissa != 0) to <<= x.exponent - exponent;
}

/// Returns the value of a double as a rational; 2^1024 replaces infinity.
inline mpq_class rational(double x) {
  return std::isfinite(x) ? mpq_class(x) : mpq_class((x > 0 ? 1 : -1) * (mpz_class(1) << 1024));
}

/// True if the double nearest to a number y is x (ties to even). For a neighbouring double `next`
/// of x, beside(next) must return the sign of y - (x + next) / 2.
template <class Beside>
bool is_nearest_double(double x, const Beside& beside) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool even = (std::bit_cast<std::uint64_t>(x) & 1) == 0;
  const int below = x == -kInfinity ? 1 : beside(std::nextafter(x, -kInfinity));
  const int above = x == kInfinity ? -1 : beside(std::nextafter(x, kInfinity));
  return (below > 0 || (below == 0 && even)) && (above < 0 || (above == 0 && even));
}

/// Two triangles in integers. The corners of the input are the first corner of the input triangle
/// `a`, plus 2^exponent times the integers stored here.
struct ScaledPair {
  Corners<mpz_class> a, b;
  int exponent = 0;
};

/// Scales two triangles to integers. length: finite; the scale makes `length` an integer, too.
inline ScaledPair scaled(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                         double length = 0) {
  int least = std::numeric_limits<int>::max();
  const auto include = [&least](double x) {
    if (x != 0) least = std::min(least, parts(x).exponent);
  };
  include(length);
  for (const auto* t : {&a, &b}) {
    for (const Vec3& p : *t) std::ranges::for_each(p, include);
  }
  ScaledPair out;
  if (least != std::numeric_limits<int>::max()) out.exponent = least;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      scale(out.a[i][k], a[i][k], out.exponent);
      scale(out.b[i][k], b[i][k], out.exponent);
    }
  }
  // Subtracts the first corner of a from all corners, which usually leaves fewer digits.
  const Vector<mpz_class> origin = out.a[0];
  for (auto* t : {&out.a, &out.b}) {
    for (Vector<mpz_class>& p : *t) minus(p, Vector<mpz_class>(p), origin);
  }
  return out;
}

}  // namespace farcull::integer

namespace farcull {

/// A fraction over / under, not always in lowest terms.
struct Fraction {
  mpz_class over = 0;   // >= 0
  mpz_class under = 1;  // > 0

  /// Compares the values, so 1/2 equals 2/4.
  friend std::strong_ordering operator<=>(const Fraction& x, const Fraction& y);
  friend bool operator==(const Fraction& x, const Fraction& y) { return x <=> y == 0; }
};

/// The numerator and the denominator of a squared distance have at most this many decimal digits.
/// All coordinates of a scene times 2^1074 are integers below 2^2098, so their differences are
/// below D = 2^2099. In this scale the squared distance is (w . d)^2 / (d . d). Here |w_k| < D, and
/// |d_k| < 2 D^2, as for a cross product of two edges. So numerator and denominator are below
/// (6 D^3)^2 < 2^12600. In world units the denominator has 2148 bits more: (d . d) 2^2148 <
/// (2 D^2)^2 * 3 * 2^2148 < 2^10548. Division by common factors only shortens both numbers.
/// log10(2^12600) < 3793.
constexpr std::size_t kMostDigits = 4000;

/// Returns the square of a length. Precondition: the length is finite and >= 0.
Fraction square_of(double length);

/// Parses the whole text as a fraction: decimal digits, '/', decimal digits. Returns nothing for
/// any other text. Also returns nothing if a number has leading zeros or more than kMostDigits
/// digits, or if the fraction is not in lowest terms.
std::optional<Fraction> parse_fraction(std::string_view text);

/// Returns the square root or a slightly larger double; infinity if the root exceeds all doubles.
double root_above(const Fraction& fraction);

/// A length, stored as its exact square.
struct Length {
  Fraction squared;
  double above = 0;  // root_above(squared)

  explicit Length(Fraction square) : squared(std::move(square)), above(root_above(squared)) {}
};

}  // namespace farcull
