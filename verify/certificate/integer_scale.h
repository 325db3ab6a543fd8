// A pair of triangles in integers: every finite double is an integer times a power of two, so one
// common power turns all coordinates of a pair into integers, and nothing is rounded. For the
// sources of this folder alone.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/scene/scene.h"
#include "verify/certificate/integer_vector.h"

namespace farcull::integer {

/// value = mantissa * 2^exponent, the mantissa odd or 0.
struct Parts {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

/// Precondition: finite.
inline Parts parts(double value) {
  if (value == 0) return {};
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa >> zeros, exponent - 53 + zeros};
}

/// to = value / 2^exponent. Precondition: that is an integer.
inline void scale(mpz_class& to, double value, int exponent) {
  const Parts x = parts(value);
  to = static_cast<long>(x.mantissa);
  if (x.mantissa != 0) to <<= x.exponent - exponent;
}

/// Two triangles: the corner of the input is the first corner of a + 2^exponent * the integers.
struct ScaledPair {
  Corners<mpz_class> a, b;
  int exponent = 0;
};

/// length: another number, finite, that has to be a whole multiple of 2^exponent as well.
inline ScaledPair scaled(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                         double length = 0) {
  int least = std::numeric_limits<int>::max();
  const auto include = [&least](double x) {
    if (x != 0) least = std::min(least, parts(x).exponent);
  };
  include(length);
  for (const auto* t : {&a, &b}) {
    for (const Vec3& p : *t) {
      for (int k = 0; k < 3; ++k) include(p[k]);
    }
  }
  ScaledPair out;
  if (least != std::numeric_limits<int>::max()) out.exponent = least;
  const auto convert = [&](Corners<mpz_class>& to, const std::array<Vec3, 3>& from) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) scale(to[i][k], from[i][k], out.exponent);
    }
  };
  convert(out.a, a);
  convert(out.b, b);
  // Every direction and every gap is about differences, and differences are shorter.
  const Vector<mpz_class> origin = out.a[0];
  for (auto* t : {&out.a, &out.b}) {
    for (Vector<mpz_class>& p : *t) minus(p, Vector<mpz_class>(p), origin);
  }
  return out;
}

}  // namespace farcull::integer
