// Fits windows around the images of boxes. Clips triangles to the six planes of a window's region
// by the algorithm of Sutherland and Hodgman.
#include "core/view/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"

namespace farcull {
namespace {

// Returns the axes of a view along `depth`. If `depth` is a coordinate axis, the image axes are the
// other two coordinate axes, so that all elements are 0, 1 or -1.
Eigen::Matrix3d rows_for(const Vec3& depth) {
  Eigen::Matrix3d rows;
  for (int axis = 0; axis < 3; ++axis) {
    if (depth[axis] != 0 && (depth.array() == 0).count() == 2) {
      rows << Vec3::Unit((axis + 1) % 3).transpose(), Vec3::Unit((axis + 2) % 3).transpose(),
          depth.transpose();
      return rows;
    }
  }
  int smallest = 0;
  depth.cwiseAbs().minCoeff(&smallest);
  const Vec3 right = depth.cross(Vec3::Unit(smallest)).normalized();
  rows << right.transpose(), depth.cross(right).transpose(), depth.transpose();
  return rows;
}

// Returns a box that contains the image of `box` under map * (x - origin). The box is enlarged by
// the rounding errors of the computation. Raises `error` to the largest of these errors.
Box image(const Eigen::Matrix3d& map, const Vec3& origin, const Box& box, double& error) {
  const Vec3 from = box.lo - origin;
  const Vec3 to = box.hi - origin;
  const Vec3 reach = from.cwiseAbs().cwiseMax(to.cwiseAbs());
  Box out;
  for (int row = 0; row < 3; ++row) {
    double lo = 0, hi = 0;
    for (int i = 0; i < 3; ++i) {
      lo += std::min(map(row, i) * from[i], map(row, i) * to[i]);
      hi += std::max(map(row, i) * from[i], map(row, i) * to[i]);
    }
    const double e = kMapRounding * map.row(row).cwiseAbs().dot(reach.transpose());
    error = std::isfinite(e) ? std::max(error, e) : HUGE_VAL;
    out.lo[row] = lo - e;
    out.hi[row] = hi + e;
  }
  return out;
}

Box image(const Eigen::Matrix3d& map, const Vec3& origin, std::span<const Box> boxes,
          double& error) {
  Box all = Box::empty();
  for (const Box& box : boxes) all.add(image(map, origin, box, error));
  return all;
}

}  // namespace

std::vector<std::string> split_list(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

View parse_view(const std::string& text) {
  const auto bad = [&text](const std::string& reason) {
    return Error("{views}", "'" + text + "' " + reason,
                 "give axes (x, -x, y, -y, z, -z) or directions like 1:1:0.5, separated by commas");
  };
  const bool negative = text.starts_with('-');
  const std::string axis = negative ? text.substr(1) : text;
  if (axis == "x" || axis == "y" || axis == "z") {
    const Vec3 depth = Vec3::Unit(axis[0] - 'x') * (negative ? -1 : 1);
    return {text, rows_for(depth)};
  }
  const std::vector<std::string> parts = split_list(text, ':');
  if (parts.size() != 3) throw bad("is no view");
  Vec3 depth;
  for (int i = 0; i < 3; ++i) {
    const std::string& part = parts[i];
    const char* const end = part.data() + part.size();
    const auto [after, code] = std::from_chars(part.data(), end, depth[i]);
    if (code == std::errc::result_out_of_range && after == end)
      throw bad("has a component beyond what a double holds, 5e-324 to 1.7e308");
    if (code != std::errc() || after != end || !std::isfinite(depth[i]))
      throw bad("has a component that is no finite number");
  }
  const double largest = depth.cwiseAbs().maxCoeff();
  if (largest == 0) throw bad("is the zero direction");
  return {text, rows_for((depth / largest).normalized())};
}

std::vector<View> parse_views(const std::string& text) {
  std::vector<View> views;
  for (const std::string& part : split_list(text, ',')) {
    views.push_back(parse_view(part));
    const auto same = [&](const View& v) { return v.name == part; };
    if (std::any_of(views.begin(), views.end() - 1, same)) {
      throw Error("{views}", "'" + part + "' is given twice", "name each view once");
    }
  }
  return views;
}

PixelPoint to_pixel(const Window& window, const Vec3& x) {
  // The subtraction is rounded once, so its error is relative to |x - origin|, not to |x|. Scenes
  // far from the world's origin therefore lose no precision. Three products and two additions
  // follow. kMapRounding covers the roundings and the cross terms (docs/budget.md, "double"). A
  // product that underflows adds an error of at most 2^-1075.
  const Vec3 d = x - window.origin;
  // The sums have the same order as in core/native/fatten-inl.h.
  PixelPoint out{{}, 0};
  double bound = 0;
  for (int row = 0; row < 3; ++row) {
    const double a = window.map(row, 0) * d[0], b = window.map(row, 1) * d[1],
                 c = window.map(row, 2) * d[2];
    out.p[row] = (a + b) + c;
    const double sum = (std::abs(a) + std::abs(b)) + std::abs(c);
    if (!(sum <= bound)) bound = sum;  // also true if `sum` is NaN
  }
  bound = kMapRounding * bound + kMapUnderflow;
  out.error = std::isfinite(bound) && out.p.allFinite() ? bound : HUGE_VAL;
  return out;
}

double pixel_error(const Window& window, const Box& box) {
  double error = kMapUnderflow;
  image(window.map, window.origin, box, error);
  return error;
}

Box pixel_box(const Window& window, const Box& box) {
  double error = 0;
  return image(window.map, window.origin, box, error);
}

std::optional<Window> fit_window(const View& view, std::span<const Box> regions, int resolution) {
  Box world = Box::empty();
  for (const Box& region : regions) world.add(region);
  Window window{.view = view,
                .origin = 0.5 * world.lo + 0.5 * world.hi,
                .map = {},
                .pixel_size = 0,
                .width = 0,
                .height = 0,
                .lo = {},
                .hi = {}};
  double error = 0;

  // Centres the window on the middle of the image of the regions. In an oblique view, the centre of
  // `world` may have its image elsewhere.
  const Box rough = image(view.rows, window.origin, regions, error);
  if (!std::isfinite(error)) return std::nullopt;
  const bool axis_aligned = (view.rows.array() == 0).count() == 6;
  if (!axis_aligned) window.origin += view.rows.transpose() * (0.5 * rough.lo + 0.5 * rough.hi);

  // Even if the image is flat, a pixel needs a positive size. At any resolution, a pixel is at
  // least 2^-45 of the largest coordinate. So rounding the window's centre to doubles moves it by
  // at most 1/16 px, and the window does not exceed its maximum size.
  const Box unit = image(view.rows, window.origin, regions, error);
  const double magnitude = std::max(world.lo.cwiseAbs().maxCoeff(), world.hi.cwiseAbs().maxCoeff());
  const double extent = std::max({unit.hi[0] - unit.lo[0], unit.hi[1] - unit.lo[1],
                                  0x1p-20 * (unit.hi[2] - unit.lo[2]), 0x1p-960});
  if (!std::isfinite(extent)) return std::nullopt;
  window.pixel_size = std::max(extent / resolution, 0x1p-45 * magnitude);
  window.map = view.rows / window.pixel_size;

  error = 0;
  const Box px = image(window.map, window.origin, regions, error);
  if (!(error <= kMaxDoubleError)) return std::nullopt;
  // The additional 2^-40 px cover rounding errors of these sums, which `error` does not include.
  window.lo = px.lo.array() - (1 + 0x1p-40);
  window.hi = px.hi.array() + (1 + 0x1p-40);
  const auto side = [&](int i) {
    return 2 *
           static_cast<int>(std::ceil(std::max(std::abs(window.lo[i]), std::abs(window.hi[i]))));
  };
  window.width = side(0);
  window.height = side(1);
  return window;
}

namespace {

// Sets `out` to the part of `in` with sign * p[axis] <= sign * plane. Returns false if `out` has
// too few corners. A convex polygon gains at most one corner. But rounding can put corners of a
// thin triangle on alternating sides of the plane. Each change of sides adds a corner.
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
      // Interpolates from the inner end, so that triangles with a common edge get the same point.
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
        patch.error = HUGE_VAL;  // makes the patch undrawable, so its triangle is kept
        return patch;
      }
      std::copy_n(next.corners.begin(), next.count, patch.corners.begin());
      patch.count = next.count;
      ++patch.cuts;
      if (patch.count == 0) break;
    }
    if (patch.count == 0) break;
  }
  // Each cut displaces its new corners by at most kCutRounding * largest along each axis. t has
  // three rounding errors, which are multiplied by |to - from| <= 2 * largest. The difference, the
  // product and the sum are then rounded once each (docs/budget.md, "Clipping and the fan").
  patch.error += patch.cuts * kCutRounding * largest;
  return patch;
}

}  // namespace farcull
