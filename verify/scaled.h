// Doubles as integers of one scale, for exact arithmetic. For sources of verify alone.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/scene/scene.h"

namespace farcull {

/// The exponent of the lowest bit of x that is 1. Precondition: x is not 0.
inline int lowest_bit(double x) {
  int exponent = 0;
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  return exponent - 53 + __builtin_ctzll(static_cast<std::uint64_t>(digits));
}

/// x times 2^-exponent. Precondition: this is an integer.
inline mpz_class integer_of(double x, int exponent) {
  const double whole = std::ldexp(x, -exponent);
  if (std::isfinite(whole)) return mpz_class(whole);
  int of_x = 0;
  mpz_class out(std::ldexp(std::frexp(x, &of_x), 53));
  return out << static_cast<mp_bitcnt_t>(of_x - 53 - exponent);  // > 0, since `whole` overflows
}

/// The corners of two triangles: integers times 2^exponent. The exponent is the largest possible.
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
