// Defines orthographic views and pixel space. In pixel space all three coordinates are in pixels. x
// and y are relative to the centre of the window; z is the depth (smaller is nearer). A view is an
// affine map computed in double, with a bound of each point's rounding error. Triangles are clipped
// conservatively to a window's region, in pixel space and in double.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Limits of a rasterizer, for the budget.
struct RasterLimits {
  int subpixel_bits =
      0;  // GL_SUBPIXEL_BITS: window coordinates snap by at most 2^-subpixel_bits px per axis (A2)
  int depth_bits = 0;      // 24: fixed point; 32: float
  int max_resolution = 0;  // largest Window::width and height
  /// True if samples lie at pixel centres, corners are not moved, and float arithmetic is IEEE 754
  /// (core/native/canvas.h).
  bool exact_samples = false;
};

/// Width (px) of the render target's border on each side of the window. A corner of the border is
/// for the control items (core/gl/canvas/state.h).
constexpr int kBorder = 2;

/// Returns the side of the viewport for a side of `window` px. It is the side of the window with
/// its border, rounded up to a power of two. So the scale to normalized device coordinates is
/// exact.
inline int viewport_side(int window) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(window + 2 * kBorder)));
}

/// A direction of view. The rows are the image's x axis, its y axis, and the depth axis. Up to
/// rounding, they have unit length and are mutually orthogonal.
struct View {
  std::string name;
  Eigen::Matrix3d rows;
};

/// Splits a text at each separator. The parts may be empty.
std::vector<std::string> split_list(const std::string& text, char separator = ',');

/// Parses an axis, such as "x" or "-y", or a direction, such as "1:1:0.5". A direction must be
/// finite and not zero; it is scaled to unit length. Throws Error for any other text.
View parse_view(const std::string& text);
/// Parses a comma-separated list of views. Throws Error if a view is given twice.
std::vector<View> parse_views(const std::string& text);

/// The pixel space of one view on one region of the world. The image of a world point x is map * (x
/// - origin). Pixel (i, j) is the closed square [i, i+1] x [j, j+1], where i is in [-width/2,
/// width/2) and j is in [-height/2, height/2).
struct Window {
  View view;
  Vec3 origin;          // world coordinates of the window's centre
  Eigen::Matrix3d map;  // pixels per world unit
  double pixel_size;    // world units per pixel
  int width;            // px, even
  int height;           // px, even
  Vec3 lo;              // the box lo..hi contains the region's image with a margin of one px
  Vec3 hi;
};

/// A point in pixel space. Each coordinate is within `error` px of the exact image's coordinate.
struct PixelPoint {
  Vec3 p;        // if not finite, `error` is infinite
  double error;  // px
};
PixelPoint to_pixel(const Window& window, const Vec3& x);
/// Returns a bound (px) of PixelPoint::error for all points of the box. The bound is infinite if
/// the image of a point may overflow.
double pixel_error(const Window& window, const Box& box);

/// Returns a box in the window's pixel space that contains the image of the given box.
Box pixel_box(const Window& window, const Box& box);

/// Bounds of the rounding errors of to_pixel() and of clipping, in double. docs/budget.md,
/// "double", derives the constants; tests/proofs proves them.
/// Error of a mapped coordinate, relative to the computed sum of the magnitudes of its three terms.
constexpr double kMapRounding = 8 * 0x1p-53;
/// Further error (px) of a mapped coordinate, from products that underflow.
constexpr double kMapUnderflow = 0x1p-1000;
/// Error that a cut adds along each axis, relative to the largest |coordinate| before clipping.
constexpr double kCutRounding = 16 * 0x1p-53;
/// A primitive with a larger error (px) from double arithmetic is not drawn.
constexpr double kMaxDoubleError = 0x1p-10;

/// Returns the window around the image of `regions`, with a margin of one pixel. The larger side of
/// the image has `resolution` pixels. Pixels are larger (and fewer) if coordinates cannot resolve
/// them, or if they would be smaller than 2^-20 / resolution of the depth range. width and height
/// are at most resolution + 5. Returns nullopt (nothing may be culled) if the extent is not finite
/// or an error exceeds kMaxDoubleError. Preconditions: regions is not empty; resolution >= 1.
std::optional<Window> fit_window(const View& view, std::span<const Box> regions, int resolution);

/// A triangle in pixel space, clipped by up to six planes. Up to rounding, it is a flat and convex
/// polygon. Clipping keeps large coordinates from the rasterizer. (GL clips in float32 before
/// snapping, which would move edges by many pixels.) The polygon is drawn as a fan about its first
/// corner. Consider the exact image of the triangle in the region without the margin of one pixel.
/// Each point of this image is within `error` px, along each axis, of a point of the fan
/// (docs/budget.md, "Clipping and the fan").
struct Patch {
  std::array<Vec3, 9> corners;
  int count = 0;     // 0: the triangle has no point in the region
  int cuts = 0;      // number of planes that cut the triangle
  double error = 0;  // px; if the patch is not drawable(), `corners` are meaningless

  bool drawable() const { return error <= kMaxDoubleError; }
  std::span<const Vec3> points() const { return {corners.data(), static_cast<std::size_t>(count)}; }
};

/// Returns the image of the world triangle `corners`, clipped to window.lo .. window.hi. If the
/// patch is not drawable(), count == 0 does not prove that the triangle is outside.
Patch clip_to_region(const Window& window, const std::array<Vec3, 3>& corners);

}  // namespace farcull
