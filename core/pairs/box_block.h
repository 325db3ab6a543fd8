// Boxes as floats: single ones, and sixteen as columns.
//
// Boxes are taken relative to a common origin and rounded to float. Subtraction and rounding never
// decrease, so boxes that overlap still do; and where floats are less, so were the doubles. So no
// margin is needed, and only boxes that touch in floats are looked at again in doubles.
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/scene/scene.h"

namespace farcull {

/// Corners relative to an origin. The fourth number of each is 0.
struct alignas(32) FloatBox {
  std::array<float, 4> lo, hi;
};
/// Meets nothing.
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr FloatBox kNowhere = {{kInfinite, kInfinite, kInfinite, 0},
                               {-kInfinite, -kInfinite, -kInfinite, 0}};
/// The box relative to an origin (finite), rounded to float, but finite, so that none meets a
/// missing one. An empty box becomes kNowhere.
FloatBox relative(const Box& box, const Vec3& origin);
/// True iff the closed boxes share a point.
inline bool overlap(const FloatBox& a, const FloatBox& b) {
#ifdef __SSE2__
  const __m128 apart = _mm_or_ps(_mm_cmpgt_ps(_mm_load_ps(a.lo.data()), _mm_load_ps(b.hi.data())),
                                 _mm_cmpgt_ps(_mm_load_ps(b.lo.data()), _mm_load_ps(a.hi.data())));
  return _mm_movemask_ps(apart) == 0;
#else
  return a.lo[0] <= b.hi[0] && b.lo[0] <= a.hi[0] && a.lo[1] <= b.hi[1] && b.lo[1] <= a.hi[1] &&
         a.lo[2] <= b.hi[2] && b.lo[2] <= a.hi[2];
#endif
}

/// The closed box of the triangles from .. to - 1.
Box box_of(const Scene& scene, std::uint32_t from, std::uint32_t to);
/// Relative to the origin, the closed boxes of the triangles from .. to - 1, grown outward by at
/// least `half` (world units, >= 0) on every side. Returns the box of all of them, not grown.
Box relative_boxes(const Scene& scene, std::uint32_t from, std::uint32_t to, double half,
                   const Vec3& origin, FloatBox* out);

/// A missing box meets nothing.
struct alignas(64) BoxBlock {
  std::array<std::array<float, 16>, 6> column;  // x0, y0, z0, x1, y1, z1

  void set(std::size_t lane, const FloatBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      column[k][lane] = box.lo[k];
      column[k + 3][lane] = box.hi[k];
    }
  }
  FloatBox get(std::size_t lane) const {
    return {{column[0][lane], column[1][lane], column[2][lane], 0},
            {column[3][lane], column[4][lane], column[5][lane], 0}};
  }
};

/// Triangles of a run at most.
constexpr std::uint32_t kRun = 16;

/// The triangles of a run. What stands behind the last one is set to a box that meets nothing.
struct RunBlock {
  BoxBlock boxes;
  alignas(64) std::array<std::uint32_t, kRun> triangles;
  FloatBox bound;  // of all of them
};
/// The block of a run of these triangles, whose boxes are boxes[triangle - first].
void fill_block(std::span<const std::uint32_t> triangles, const FloatBox* boxes,
                std::uint32_t first, RunBlock& out);
/// The same from the scene, the boxes grown by `half` and relative to the origin. Returns the box
/// of the run, not grown.
Box fill_block(const Scene& scene, std::span<const std::uint32_t> triangles, double half,
               const Vec3& origin, RunBlock& out);

}  // namespace farcull
