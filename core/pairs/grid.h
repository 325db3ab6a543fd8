// The triangles of a task on the CPU: their bounds, their pixels and their slices.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/pairs/backend.h"
#include "core/pairs/interval.h"

namespace farcull {

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
  /// Fetches the corners, for a call that follows soon.
  void prefetch([[maybe_unused]] std::uint32_t triangle) const {
#ifdef __GNUC__
    for (const std::uint32_t v : task_.triangles[triangle]) __builtin_prefetch(&task_.vertices[v]);
#endif
  }
  /// Real bounds, and within the owner's limits.
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
  int slice(float z) const { return interval::far_slice(z, task_.near_px, slices_per_px_); }

 private:
  PairTask task_;
  float slices_per_px_;
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
    : task_(task), slices_per_px_(kSlices / std::max(task.far_px - task.near_px, 0x1p-20f)) {}

}  // namespace farcull
