// Motions of whole objects, of all kinds that could go wrong.
#pragma once

#include <cmath>

#include "core/base/random.h"
#include "core/boxes/rigid.h"

namespace farcull::lab {

/// small turn, any rotation, quarter turns that keep exact contacts, far away, so small that
/// numbers are subnormal, mirrored, sheared, very large.
inline constexpr int kMotionKinds = 8;
inline constexpr int kFarMotion = 3, kTinyMotion = 4;

inline std::array<double, 9> rotation(double a, double b, double c) {
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b),
               cc = std::cos(c), sc = std::sin(c);
  return {ca * cb,
          ca * sb * sc - sa * cc,
          ca * sb * cc + sa * sc,
          sa * cb,
          sa * sb * sc + ca * cc,
          sa * sb * cc - ca * sc,
          -sb,
          cb * sc,
          cb * cc};
}

/// Objects of about the size 1 that get motions of one kind stay within about 1 of each other, in
/// the units of the kind.
inline RigidMotion random_motion(RandomNumbers& random, int kind) {
  const auto angle = [&](double most) { return random.between(-most, most); };
  RigidMotion out;
  const double most = kind == 0 ? 0.01 : 4;
  out.r = rotation(angle(most), angle(most), angle(most));
  for (double& t : out.t) t = random.between(-0.3, 0.3);
  const auto scale = [&](double by) {
    for (double& x : out.r) x *= by;
    for (double& t : out.t) t *= by;
  };
  if (kind == 2) {  // a permutation of the axes with signs, and steps of a grid
    out.r = {};
    const auto first = random.below(3u), second = (first + 1 + random.below(2u)) % 3;
    out.r[first] = random.sign();
    out.r[3 + second] = random.sign();
    out.r[6 + (3 - first - second)] = random.sign();
    for (double& t : out.t) t = 0.125 * random.between(-2, 2) > 0 ? 0.25 : 0;
  }
  if (kind == kFarMotion) {
    const double far = random.below(2) > 0 ? 1e6 : 1e12;
    for (double& t : out.t) t += far;
  }
  if (kind == kTinyMotion) scale(0x1p-1060);
  if (kind == 5)
    for (std::size_t k = 0; k < 3; ++k) out.r[k] = -out.r[k];
  if (kind == 6)
    for (double& x : out.r) x += random.between(-1, 1);
  if (kind == 7) scale(0x1p1000);
  return out;
}

}  // namespace farcull::lab
