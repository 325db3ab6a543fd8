// Conservative clipping of a triangle to a window's region, in pixel space and in double, so that
// no large coordinate ever reaches the rasterizer (GL clips in float32, before snapping: edges
// would move by many pixels).
#pragma once

#include <array>
#include <span>

#include "core/view.h"

namespace farcull {

/// A convex polygon in pixel space: a triangle clipped by up to six planes. Its convex hull, grown
/// by `error` px in each axis, contains every point of the exact triangle's image in the region
/// without its margin of one pixel. (A point that deep inside stays inside every plane when it is
/// moved by the errors of the cuts before; docs/budget.md, "double".)
struct Patch {
  std::array<Vec3, 9> corners;
  int count = 0;     // 0: the triangle has no point in the region
  int cuts = 0;      // planes that cut it
  double error = 0;  // px; beyond kMaxDoubleError (or not finite) the patch is undrawable and
                     // `corners` mean nothing

  bool drawable() const { return error <= kMaxDoubleError; }
  std::span<const Vec3> points() const { return {corners.data(), static_cast<std::size_t>(count)}; }
};

/// The image of the world triangle `corners` clipped to window.lo .. window.hi. Ask drawable()
/// before count: where it is false, an empty polygon is no proof that the triangle stays outside.
Patch clip_to_region(const Window& window, const std::array<Vec3, 3>& corners);

}  // namespace farcull
