// Questions to a kernel and its answers, wherever it runs: on a device
// (core/gl/probe/probe.h) or on the CPU. verify/kernel_check.h decides which answers are right.
#pragma once

#include <array>
#include <cstdint>

#include "core/canvas/canvas.h"

namespace farcull {

/// A solid, and the line along the depth through a pixel centre (px).
struct SolidCase {
  float cx, cy;
  Solid solid;
};
/// What solid_interval (core/canvas/canvas.h) gives for a SolidCase; without a hit, entry and exit
/// mean nothing.
struct SolidAnswer {
  bool hit;
  float entry, exit;
};

/// A triangle of FAR pairs and a pixel. Every point of the real triangle is within `widening` (px
/// per axis) plus half a unit in the last place of the point of the float triangle with the same
/// barycentric coordinates. shift says which real triangle is meant: per corner and axis -1, 0 or 1
/// times that much.
struct IntervalCase {
  std::array<std::array<float, 3>, 3> corners;
  float widening;
  std::int32_t i, j;
  std::array<std::array<std::int8_t, 3>, 3> shift;
};
/// Bounds of the whole triangle, its range along x between the pixel's rows, and its depths over
/// the pixel, as the programs of FAR pairs compute them; not hit: no point of it is over the pixel.
struct IntervalAnswer {
  std::array<float, 3> lo, hi;
  float row_lo, row_hi;
  bool hit;
  float near, far;
};

/// far_slice of core/pairs/interval.glsl, and the conversion to an integer that chooses a pixel.
struct SliceCase {
  float z, steps_per_px;
  std::int32_t first_step, slices_per_step;
  float x;
};
struct SliceAnswer {
  std::int32_t slice;
  std::int32_t pixel;  // int(clamp(x, 0, 65536))
};

}  // namespace farcull
