// Converts doubles to integers of one scale, defines the integers behind a SquaredDistance, and
// rounds fractions of integers to doubles. Only sources of verify/closest.h, verify/contact.h and
// verify/near_contact.h and their tests use this file.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "verify/closest.h"

namespace farcull {

/// num / den times 2^exponent. Not in lowest terms: reducing takes time, and only text() needs it.
struct SquaredDistance::Value {
  mpz_class num = 0;  // >= 0
  mpz_class den = 1;  // > 0
  long exponent = 0;
};

/// Returns m times 2^exponent, rounded to the nearest double, ties to even. Subnormal results are
/// rounded once as well. Results beyond the largest double become infinity. Never -0.0.
double rounded(const mpz_class& m, long exponent);

/// Returns num / den times 2^exponent, rounded like rounded(). Precondition: den > 0.
double rounded_quotient(const mpz_class& num, const mpz_class& den, long exponent);

/// Returns the root of num / den times 2^exponent, rounded like rounded(). Preconditions: num >= 0,
/// den > 0.
double rounded_root(const mpz_class& num, const mpz_class& den, long exponent);

/// Returns the point with coordinates x / w times 2^exponent, each rounded like rounded(). w > 0.
inline Vec3 rounded_point(const std::array<mpz_class, 3>& x, const mpz_class& w, long exponent) {
  return {rounded_quotient(x[0], w, exponent), rounded_quotient(x[1], w, exponent),
          rounded_quotient(x[2], w, exponent)};
}

/// Returns the number of bits of the magnitude of x; 1 for 0.
inline long bits_of(const mpz_class& x) {
  return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2));
}
inline long most_bits(const std::array<mpz_class, 3>& x) {
  return std::max({bits_of(x[0]), bits_of(x[1]), bits_of(x[2])});
}

/// Returns the exponent of the lowest bit of x that is 1. Precondition: x is not 0.
inline int lowest_bit(double x) {
  int exponent = 0;
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  return exponent - 53 + __builtin_ctzll(static_cast<std::uint64_t>(digits));
}

/// Returns x times 2^-exponent. Precondition: the result is an integer.
inline mpz_class integer_of(double x, int exponent) {
  const double whole = std::ldexp(x, -exponent);
  if (std::isfinite(whole)) return mpz_class(whole);
  int of_x = 0;
  mpz_class out(std::ldexp(std::frexp(x, &of_x), 53));
  return out << static_cast<mp_bitcnt_t>(of_x - 53 - exponent);  // shift > 0, as `whole` overflows
}

/// The corners of two triangles as integers times 2^exponent, with the largest possible exponent.
struct Scaled {
  using Corners = std::array<std::array<mpz_class, 3>, 3>;
  Corners a, b;
  int exponent = 0;

  Scaled(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
    constexpr int kNone = 2000;
    int least = kNone;
    for (const auto* corners : {&s, &t}) {
      for (const Vec3& p : *corners) {
        for (const double x : p) {
          if (x != 0) least = std::min(least, lowest_bit(x));
        }
      }
    }
    exponent = least == kNone ? 0 : least;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        a[i][k] = integer_of(s[i][k], exponent);
        b[i][k] = integer_of(t[i][k], exponent);
      }
    }
  }
};

}  // namespace farcull
