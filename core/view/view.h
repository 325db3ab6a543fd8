// Orthographic views and pixel space. Pixel space has all three axes in pixels, x and y centred on
// the window, z the depth (smaller is nearer). A view is an affine map computed in double; its
// rounding error is bounded here, per point.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// A direction to look along. rows: image x, image y, depth; unit length, mutually orthogonal up to
/// rounding.
struct View {
  std::string name;
  Eigen::Matrix3d rows;
};

/// The parts of a text between separators, one more than there are of these.
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
  Vec3 lo;              // contains the region in pixel space, one pixel of margin included
  Vec3 hi;
};

/// A point in pixel space; each coordinate is within `error` px of the exact image under map and
/// origin.
struct PixelPoint {
  Vec3 p;        // may be non-finite where the conversion overflowed; then error is infinite
  double error;  // px
};
PixelPoint to_pixel(const Window& window, const Vec3& x);
/// The largest error (px) of a point of the box; infinite where one may overflow.
double pixel_error(const Window& window, const Box& box);

/// Contains the image of the box in the window's pixel space.
Box pixel_box(const Window& window, const Box& box);

/// The largest rounding error (px) that a drawable primitive may carry from double arithmetic.
constexpr double kMaxDoubleError = 0x1p-10;

/// The window of `resolution` pixels (>= 1) along the larger image side of the union of `regions`
/// (non-empty), one more pixel around it: width, height <= resolution + 5. Square pixels; fewer of
/// them where they would be smaller than the coordinates can resolve, or than 2^-20 of the depth in
/// a window of this resolution. Empty where pixel space cannot resolve the region: the extent or a
/// corner's image is not finite, or its error is beyond kMaxDoubleError; nothing may be culled in
/// such a view.
std::optional<Window> fit_window(const View& view, std::span<const Box> regions, int resolution);

}  // namespace farcull
