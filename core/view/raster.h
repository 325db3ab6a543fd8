// What culling has to know of a rasterizer and of the target it draws a window to.
#pragma once

#include <bit>

namespace farcull {

/// What the budget needs to know of a rasterizer.
struct RasterLimits {
  int subpixel_bits =
      0;  // GL_SUBPIXEL_BITS: window coordinates snap by at most 2^-subpixel_bits px per axis (A2)
  int depth_bits = 0;      // 24 fixed point, 32 float
  int max_resolution = 0;  // largest Window::width and height
  /// Samples lie at pixel centres, corners are not moved, and floats are those of IEEE 754
  /// (core/native/canvas.h).
  bool exact_samples = false;
};

/// Pixels of the render target around the window on each side; its corner holds the control items
/// (canvas.h).
constexpr int kBorder = 2;

/// The viewport side that serves a window side of `window` px: the window, its border, and the next
/// power of two, so that the scale to normalized device coordinates is exact.
inline int viewport_side(int window) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(window + 2 * kBorder)));
}

}  // namespace farcull
