// Conservative clipping of a triangle to a window's region, in pixel space and in double, so that
// no large coordinate ever reaches the rasterizer (GL clips in float32, before snapping: edges
// would move by many pixels).
#pragma once

#include <array>
#include <span>

#include "core/view/view.h"

namespace farcull {

/// A polygon in pixel space: a triangle clipped by up to six planes, convex and flat up to
/// rounding. For every point of the exact triangle's image in the region without its margin of one
/// pixel, a triangle of the fan about the first corner has a point within `error` px in each axis
/// (docs/budget.md, "Clipping and the fan").
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
