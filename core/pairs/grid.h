// The triangles of a task on the CPU: their bounds, their pixels and slices, and their intervals
// over rows of pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/glsl_shim.h"
#include "core/pairs/backend.h"

// The kernel of devices compiled as C++.
namespace farcull::interval {

using namespace farcull::glsl;
#include "core/pairs/interval.glsl"

}  // namespace farcull::interval

namespace farcull {

/// Arguments of far_slice for a window between two depths (px): steps of a power of two, at most
/// 2^9 a px (a window that is so thin that 64 slices need finer ones gains nothing by slices) and
/// at most 2^14 in all, shared evenly by at most kSlices slices.
struct DepthSlices {
  float steps_per_px;
  std::int32_t first_step;
  std::int32_t slices_per_step;  // times 2^16

  int of(float z) const {
    return interval::far_slice(z, steps_per_px, first_step, slices_per_step);
  }
};

inline DepthSlices depth_slices(float near_px, float far_px) {
  constexpr double kMostSteps = 0x1p14, kMostStep = 0x1p30 - 1;
  for (int e = 9;; --e) {
    const double first =
        std::clamp(std::trunc(std::ldexp(double{near_px}, e)), -kMostStep, kMostStep);
    const double last =
        std::clamp(std::trunc(std::ldexp(double{far_px}, e)), -kMostStep, kMostStep);
    const double steps = std::max(last - first, 0.0) + 1;
    if (steps > kMostSteps) continue;
    return {std::ldexp(1.0f, e), static_cast<std::int32_t>(first),
            static_cast<std::int32_t>(std::min(0x1p16, std::floor(kSlices * 0x1p16 / steps)))};
  }
}

/// A triangle in the window: the pixels of its bounds and the slices of its depth.
struct PairItem {
  std::uint32_t triangle;
  std::uint16_t i0, i1, j0, j1;  // inclusive, from the window's lower left pixel
  std::uint8_t s0, s1;           // slices, inclusive
  bool whole;                    // one interval in all its pixels
};

/// Real bounds of a triangle within its owner's limits (px); empty where lo > hi on some axis.
struct PairBounds {
  interval::vec4 lo, hi;
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
};

/// The parts of a task that every pixel needs.
class PairGrid {
 public:
  explicit PairGrid(const PairTask& task);

  const PairTask& task() const { return task_; }
  const interval::vec4& corner(std::uint32_t triangle, int k) const {
    return task_.vertices[task_.triangles[triangle][k]];
  }
  /// Fetches the corners of a triangle into the cache, for a use that follows soon.
  void prefetch([[maybe_unused]] std::uint32_t triangle) const {
#ifdef __GNUC__
    for (const std::uint32_t v : task_.triangles[triangle]) __builtin_prefetch(&task_.vertices[v]);
#endif
  }
  /// The bounds of the real triangle. bounds() cuts them to the limits of its owner.
  PairBounds real_bounds(std::uint32_t triangle) const {
    const std::array<std::uint32_t, 3>& t = task_.triangles[triangle];
    PairBounds out;
    interval::far_bounds(task_.vertices[t[0]], task_.vertices[t[1]], task_.vertices[t[2]],
                         task_.widening, out.lo, out.hi);
    return out;
  }
  PairBounds bounds(std::uint32_t triangle) const {
    const PairBounds real = real_bounds(triangle);
    const PixelBox& limit = task_.limits[task_.owners[triangle]];
    return {interval::max(real.lo, limit.lo), interval::min(real.hi, limit.hi)};
  }
  /// The item of a triangle with bounds that are not empty.
  PairItem item(std::uint32_t triangle, const PairBounds& bounds) const;
  int slice(float z) const { return slices_.of(z); }

 private:
  PairTask task_;
  DepthSlices slices_;
};

struct PairTile {
  int i0, i1, j0, j1;  // pixels, inclusive
  int width() const { return i1 - i0 + 1; }
  int height() const { return j1 - j0 + 1; }
};

inline PairItem PairGrid::item(std::uint32_t triangle, const PairBounds& b) const {
  // Clamped as floats, since a conversion beyond int would be undefined; what is not negative is
  // rounded down by the conversion.
  const auto pixel = [](float x, int count) {
    return static_cast<std::uint16_t>(
        static_cast<int>(interval::clamp(x, 0, static_cast<float>(count - 1))));
  };
  PairItem out;
  out.triangle = triangle;
  out.i0 = pixel(b.lo.x, task_.width);
  out.i1 = pixel(b.hi.x, task_.width);
  out.j0 = pixel(b.lo.y, task_.height);
  out.j1 = pixel(b.hi.y, task_.height);
  out.s0 = static_cast<std::uint8_t>(slice(b.lo.z));
  out.s1 = static_cast<std::uint8_t>(slice(b.hi.z));
  out.whole = (out.i1 - out.i0 + 1) * (out.j1 - out.j0 + 1) <= kWholePixels;
  return out;
}

inline PairGrid::PairGrid(const PairTask& task)
    : task_(task), slices_(depth_slices(task.near_px, task.far_px)) {}

/// The strip of one triangle over rows of pixels or sub-pixels, and its intervals in them.
class PairRows {
 public:
  PairRows(const PairGrid& grid, std::uint32_t triangle, const PairBounds& bounds)
      : bounds_(bounds),
        a_(grid.corner(triangle, 0)),
        b_(grid.corner(triangle, 1)),
        c_(grid.corner(triangle, 2)) {
    const PairBounds real = grid.real_bounds(triangle);
    margin_ = interval::far_margin(real.lo, real.hi, grid.task().widening);
  }
  /// The range along x of the real triangle between the rows' borders; false: none.
  bool row(float y0, float y1, float& lo, float& hi) {
    interval::far_strip(a_, b_, c_, y0 - margin_.y, y1 + margin_.y, strip_);
    lo = std::max(strip_.lo - margin_.x, bounds_.lo.x);
    hi = std::min(strip_.hi + margin_.x, bounds_.hi.x);
    return lo <= hi;
  }
  /// The depth interval over a rectangle of the row; false: none.
  bool depths(float x0, float x1, float& near, float& far) {
    if (!interval::far_depths(strip_, x0 - margin_.x, x1 + margin_.x, near, far)) return false;
    near = std::max(near - margin_.z, bounds_.lo.z);
    far = std::min(far + margin_.z, bounds_.hi.z);
    return near <= far;
  }

 private:
  PairBounds bounds_;
  interval::vec4 a_, b_, c_;
  interval::vec4 margin_;
  interval::FarStrip strip_;
};

}  // namespace farcull
