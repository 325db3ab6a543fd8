// Boxes of triangles in doubles, grown by half the clearance: two triangles at that distance or
// less have boxes that overlap.
#pragma once

#include <cmath>

#include "core/scene/scene.h"

namespace farcull {

/// By how much each of two boxes grows so that they meet at that distance: half of it, rounded up.
inline double half_of(double clearance) {
  return clearance == 0 ? 0 : std::nextafter(0.5 * clearance, HUGE_VAL);
}

/// The box grown outward by at least `half` (world units, >= 0) on every side; an empty one and
/// half 0 change nothing. Never decreasing in the box's coordinates, and beyond the exact sum.
inline Box grow(const Box& box, double half) {
  if (half == 0 || box.is_empty()) return box;
  Box out = box;
  for (int axis = 0; axis < 3; ++axis) {
    out.lo[axis] = std::nextafter(box.lo[axis] - half, -HUGE_VAL);
    out.hi[axis] = std::nextafter(box.hi[axis] + half, HUGE_VAL);
  }
  return out;
}

/// The closed box of a triangle, grown outward by at least half the clearance on every side.
inline Box grown_box(const Scene& scene, std::uint32_t triangle, double clearance) {
  const auto& [p, q, r] = scene.triangles[triangle];
  const Vec3 &a = scene.vertices[p], &b = scene.vertices[q], &c = scene.vertices[r];
  return grow({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}, half_of(clearance));
}

/// Whether the closed boxes of two triangles, each grown by `half`, overlap.
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
