// Whether the boxes of two triangles overlap, in doubles.
#pragma once

#include <cmath>

#include "core/scene/scene.h"

namespace farcull {

/// Whether the closed boxes of two triangles, each grown by `half` (world units, >= 0), overlap:
/// outward where half > 0, so that a distance of twice `half` or less is never lost.
inline bool boxes_meet(const Scene& scene, const TrianglePair& pair, double half) {
  const std::array<std::uint32_t, 3>&s = scene.triangles[pair.a], &t = scene.triangles[pair.b];
  const double *a = scene.vertices[s[0]].data(), *b = scene.vertices[s[1]].data(),
               *c = scene.vertices[s[2]].data();
  const double *d = scene.vertices[t[0]].data(), *e = scene.vertices[t[1]].data(),
               *f = scene.vertices[t[2]].data();
  const auto least = [](double x, double y) { return x < y ? x : y; };
  const auto most = [](double x, double y) { return x > y ? x : y; };
  for (int axis = 0; axis < 3; ++axis) {
    double lo0 = least(least(a[axis], b[axis]), c[axis]),
           hi0 = most(most(a[axis], b[axis]), c[axis]);
    double lo1 = least(least(d[axis], e[axis]), f[axis]),
           hi1 = most(most(d[axis], e[axis]), f[axis]);
    if (half > 0) {
      lo0 = std::nextafter(lo0 - half, -HUGE_VAL);
      hi0 = std::nextafter(hi0 + half, HUGE_VAL);
      lo1 = std::nextafter(lo1 - half, -HUGE_VAL);
      hi1 = std::nextafter(hi1 + half, HUGE_VAL);
    }
    if (lo0 > hi1 || lo1 > hi0) return false;
  }
  return true;
}

}  // namespace farcull
