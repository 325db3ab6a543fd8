// Orthographic views and pixel space. Pixel space has all three axes in pixels, x and y centred on
// the window, z the depth (smaller is nearer). A view is an affine map computed in double; its
// rounding error is bounded here, per point. Triangles are clipped conservatively to a window's
// region, in pixel space and in double.
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
  int depth_bits = 0;      // 24 fixed point, 32 float
  int max_resolution = 0;  // largest Window::width and height
  /// True if samples lie at pixel centres, corners are not moved, and floats are those of IEEE 754
  /// (core/native/canvas.h).
  bool exact_samples = false;
};

/// Pixels of the render target around the window on each side. Its corner holds the control items
/// (canvas.h).
constexpr int kBorder = 2;

/// Viewport side for a window side of `window` px: the window and its border, rounded up to a power
/// of two, so that the scale to normalized device coordinates is exact.
inline int viewport_side(int window) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(window + 2 * kBorder)));
}

/// A direction to look along. rows: the axes image x, image y and depth, of unit length and
/// mutually orthogonal up to rounding.
struct View {
  std::string name;
  Eigen::Matrix3d rows;
};

/// The parts of a text between separators. There is one part more than there are separators.
std::vector<std::string> split_list(const std::string& text, char separator = ',');

/// "x", "-y", ... or a direction "1:1:0.5" (finite, not zero; scaled to unit length). Throws Error
/// for anything else.
View parse_view(const std::string& text);
/// A comma-separated list of views, at least one, none twice.
std::vector<View> parse_views(const std::string& text);

/// The pixel space of one view on one region of the world: pixel = map * (x - origin).
/// Pixel (i, j) is the closed square [i, i+1] x [j, j+1] for -width/2 <= i < width/2, -height/2 <=
/// j < height/2.
struct Window {
  View view;
  Vec3 origin;          // world; the centre of the window
  Eigen::Matrix3d map;  // pixels per world unit
  double pixel_size;    // world units
  int width;            // px, even
  int height;           // px, even
  Vec3 lo;              // lo, hi: contain the region in pixel space, with one pixel of margin
  Vec3 hi;
};

/// A point in pixel space; each coordinate is within `error` px of the exact image under map and
/// origin.
struct PixelPoint {
  Vec3 p;        // may be non-finite if the conversion overflowed; then error is infinite
  double error;  // px
};
PixelPoint to_pixel(const Window& window, const Vec3& x);
/// The largest error (px) of a point of the box; infinite if a point may overflow.
double pixel_error(const Window& window, const Box& box);

/// Contains the image of the box in the window's pixel space.
Box pixel_box(const Window& window, const Box& box);

/// Rounding errors of a point on its way from the world to the window, in double. docs/budget.md,
/// "double", derives the constants; tests/proofs proves them.
/// Error of a mapped coordinate, relative to the computed sum of the magnitudes of its three terms.
constexpr double kMapRounding = 8 * 0x1p-53;
/// Added for products that underflow (px).
constexpr double kMapUnderflow = 0x1p-1000;
/// Error that a cut adds along each axis, relative to the largest |coordinate| before clipping.
constexpr double kCutRounding = 16 * 0x1p-53;
/// The largest rounding error (px) that a drawable primitive may carry from double arithmetic.
constexpr double kMaxDoubleError = 0x1p-10;

/// The window around the image of the union of `regions` (non-empty), with one more pixel on each
/// side. The larger side of the image has `resolution` (>= 1) square pixels; fewer if they would be
/// smaller than the coordinates can resolve, or than 2^-20 / resolution of the depth. width, height
/// <= resolution + 5. Empty if pixel space cannot resolve the region: the extent or a corner's
/// image is not finite, or its error is beyond kMaxDoubleError. Then nothing may be culled in this
/// view.
std::optional<Window> fit_window(const View& view, std::span<const Box> regions, int resolution);

/// A triangle in pixel space, clipped by up to six planes: a polygon, convex and flat up to
/// rounding. It keeps large coordinates from the rasterizer. (GL clips in float32, before snapping:
/// edges would move by many pixels.) It is drawn as a fan about the first corner. For each point of
/// the exact triangle's image in the region without its margin of one pixel, the fan has a point
/// within `error` px in each axis (docs/budget.md, "Clipping and the fan").
struct Patch {
  std::array<Vec3, 9> corners;
  int count = 0;     // 0: the triangle has no point in the region
  int cuts = 0;      // planes that cut it
  double error = 0;  // px; beyond kMaxDoubleError (or not finite) the patch is undrawable and
                     // `corners` mean nothing

  bool drawable() const { return error <= kMaxDoubleError; }
  std::span<const Vec3> points() const { return {corners.data(), static_cast<std::size_t>(count)}; }
};

/// The image of the world triangle `corners` clipped to window.lo .. window.hi. Check drawable()
/// before count: if it is false, an empty polygon does not prove that the triangle is outside.
Patch clip_to_region(const Window& window, const std::array<Vec3, 3>& corners);

}  // namespace farcull
