// Sutherland and Hodgman's clipping against the six planes of a box.
#include "core/view/clip.h"

#include <algorithm>
#include <cmath>

#include "core/view/rounding.h"

namespace farcull {
namespace {

// Keeps the part of `in` with sign * p[axis] <= sign * plane. False: `out` has no room for it. A
// convex polygon gains at most one corner, but rounding leaves a needle's corners on either side of
// a plane that it lies along, and every change of sides is a corner more.
bool clip_plane(const Patch& in, Patch& out, int axis, double plane, double sign) {
  const int room = static_cast<int>(out.corners.size());
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const Vec3& a = in.corners[i];
    const Vec3& b = in.corners[(i + 1) % in.count];
    const bool a_inside = sign * a[axis] <= sign * plane;
    const bool b_inside = sign * b[axis] <= sign * plane;
    if (out.count + a_inside + (a_inside != b_inside) > room) return false;
    if (a_inside) out.corners[out.count++] = a;
    if (a_inside != b_inside) {
      // From the inner end, so that both neighbours of an edge would compute the same point.
      const Vec3& from = a_inside ? a : b;
      const Vec3& to = a_inside ? b : a;
      const double t = (plane - from[axis]) / (to[axis] - from[axis]);
      Vec3 p = from + t * (to - from);
      p[axis] = plane;
      out.corners[out.count++] = p;
    }
  }
  return true;
}

}  // namespace

Patch clip_to_region(const Window& window, const std::array<Vec3, 3>& corners) {
  Patch patch;
  patch.count = 3;
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    const PixelPoint q = to_pixel(window, corners[i]);
    patch.corners[i] = q.p;
    patch.error = std::max(patch.error, q.error);
    largest = std::max(largest, q.p.cwiseAbs().maxCoeff());
  }
  if (!patch.drawable()) return patch;

  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      const double plane = upper ? window.hi[axis] : window.lo[axis];
      const double sign = upper ? 1 : -1;
      const auto outside = [&](const Vec3& p) { return sign * p[axis] > sign * plane; };
      const auto points = patch.points();
      if (std::none_of(points.begin(), points.end(), outside)) continue;
      Patch next;
      if (!clip_plane(patch, next, axis, plane, sign)) {
        patch.error = HUGE_VAL;  // uncertain, so kept
        return patch;
      }
      std::copy_n(next.corners.begin(), next.count, patch.corners.begin());
      patch.count = next.count;
      ++patch.cuts;
      if (patch.count == 0) break;
    }
    if (patch.count == 0) break;
  }
  // Each cut displaces its new corners by at most kCutRounding * largest in each axis: t carries
  // three roundings, times |to - from| <= 2 * largest, then the difference, the product and the sum
  // round once more (docs/budget.md, "Clipping and the fan").
  patch.error += patch.cuts * kCutRounding * largest;
  return patch;
}

}  // namespace farcull
