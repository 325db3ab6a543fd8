// Boxes of triangles. The clearance is the largest distance at which two triangles still count as
// colliding. Boxes in doubles are grown by half the clearance, so the boxes of such triangles
// overlap. Boxes in floats are stored sixteen at a time as columns, for vector instructions.
//
// Boxes in floats are relative to a common origin and rounded. Subtraction and rounding are
// monotone. So boxes that overlap in doubles also overlap in floats, and no margin is needed. Boxes
// whose interiors overlap in floats also overlap in doubles. So only boxes that touch in floats are
// compared again in doubles.
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "core/scene/scene.h"

namespace farcull {

/// Returns half the clearance, rounded up. If two boxes are at most the clearance apart, they
/// overlap after each box is grown by the result.
inline double half_of(double clearance) {
  return clearance == 0 ? 0 : std::nextafter(0.5 * clearance, HUGE_VAL);
}

/// Returns the box, grown outward by at least `half` (world units, >= 0) on every side. Returns an
/// unchanged box if the box is empty or `half` is 0. The result is monotone in the coordinates.
inline Box grow(const Box& box, double half) {
  if (half == 0 || box.is_empty()) return box;
  Box out = box;
  for (int axis = 0; axis < 3; ++axis) {
    out.lo[axis] = std::nextafter(box.lo[axis] - half, -HUGE_VAL);
    out.hi[axis] = std::nextafter(box.hi[axis] + half, HUGE_VAL);
  }
  return out;
}

/// Returns a triangle's closed box, grown outward by at least half the clearance on every side.
inline Box grown_box(const Scene& scene, std::uint32_t triangle, double clearance) {
  const auto& [p, q, r] = scene.triangles[triangle];
  const Vec3 &a = scene.vertices[p], &b = scene.vertices[q], &c = scene.vertices[r];
  return grow({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}, half_of(clearance));
}

/// True if the closed boxes of two triangles, each grown by `half`, overlap.
inline bool boxes_meet(const Scene& scene, const TrianglePair& pair, double half) {
  const std::array<std::uint32_t, 3>&s = scene.triangles[pair.a], &t = scene.triangles[pair.b];
  const double *a = scene.vertices[s[0]].data(), *b = scene.vertices[s[1]].data(),
               *c = scene.vertices[s[2]].data();
  const double *d = scene.vertices[t[0]].data(), *e = scene.vertices[t[1]].data(),
               *f = scene.vertices[t[2]].data();
  const auto least = [](double x, double y) { return x < y ? x : y; };
  const auto most = [](double x, double y) { return x > y ? x : y; };
  for (int axis = 0; axis < 3; ++axis) {
    double lo0 = least(least(a[axis], b[axis]), c[axis]),
           hi0 = most(most(a[axis], b[axis]), c[axis]);
    double lo1 = least(least(d[axis], e[axis]), f[axis]),
           hi1 = most(most(d[axis], e[axis]), f[axis]);
    if (half > 0) {
      lo0 = std::nextafter(lo0 - half, -HUGE_VAL);
      hi0 = std::nextafter(hi0 + half, HUGE_VAL);
      lo1 = std::nextafter(lo1 - half, -HUGE_VAL);
      hi1 = std::nextafter(hi1 + half, HUGE_VAL);
    }
    if (lo0 > hi1 || lo1 > hi0) return false;
  }
  return true;
}

/// A closed box in floats, relative to an origin. The fourth number of each corner is 0.
struct alignas(32) FloatBox {
  std::array<float, 4> lo, hi;

  void add(const FloatBox& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], other.lo[k]);
      hi[k] = std::max(hi[k], other.hi[k]);
    }
  }
};
constexpr float kInfinite = std::numeric_limits<float>::infinity();
/// The empty box in floats.
constexpr FloatBox kNowhere = {{kInfinite, kInfinite, kInfinite, 0},
                               {-kInfinite, -kInfinite, -kInfinite, 0}};
/// Returns the box relative to a finite origin, rounded to finite floats. Returns kNowhere for an
/// empty box. overlap() is false for kNowhere and any finite box.
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

template <class Number>
using BoxOf = std::conditional_t<std::is_same_v<Number, float>, FloatBox, Box>;
template <class Number>
BoxOf<Number> empty_box() {
  if constexpr (std::is_same_v<Number, float>) {
    return kNowhere;
  } else {
    return Box::empty();
  }
}

/// The number of boxes in a WideBoxes. A tree node has at most this many children, and a block has
/// at most this many triangles.
constexpr std::uint32_t kWide = 16;

/// Sixteen boxes, stored as one column for each coordinate. Unused places hold empty boxes.
template <class Number>
struct alignas(64) WideBoxes {
  std::array<std::array<Number, kWide>, 6> column;  // x0, y0, z0, x1, y1, z1

  void clear() {
    for (std::size_t lane = 0; lane < kWide; ++lane) set(lane, empty_box<Number>());
  }
  void set(std::size_t lane, const BoxOf<Number>& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      column[k][lane] = box.lo[k];
      column[k + 3][lane] = box.hi[k];
    }
  }
  BoxOf<Number> get(std::size_t lane) const {
    BoxOf<Number> out{};
    for (std::size_t k = 0; k < 3; ++k) {
      out.lo[k] = column[k][lane];
      out.hi[k] = column[k + 3][lane];
    }
    return out;
  }
};

/// Returns the closed box around the triangles from .. to - 1 of the scene.
Box box_of(const Scene& scene, std::uint32_t from, std::uint32_t to);
/// Writes the closed boxes of the triangles from .. to - 1 to `out`, grown outward by at least
/// `half` (world units, >= 0) and relative to the origin.
void relative_boxes(const Scene& scene, std::uint32_t from, std::uint32_t to, double half,
                    const Vec3& origin, FloatBox* out);

/// At most kWide triangles and their boxes. The boxes after the last triangle are empty.
struct BlockLanes {
  WideBoxes<float> boxes;
  alignas(64) std::array<std::uint32_t, kWide> triangles;
  FloatBox bound;  // the box around all boxes
};
/// Fills `out` with the given triangles and their boxes. The boxes are grown by `half` and relative
/// to the origin. Returns the box around the triangles, in world coordinates and not grown.
Box fill_lanes(const Scene& scene, std::span<const std::uint32_t> triangles, double half,
               const Vec3& origin, BlockLanes& out);

constexpr int kMostLevels = 8;  // enough for 2^32 leaves

/// A tree of boxes. The leaves 0 .. leaves - 1 have height 0. The children of node k of height h
/// are the nodes 16 k .. 16 k + 15 of height h - 1, as far as these exist. The boxes of the
/// children are blocks[first[h - 1] + k]. The root is node 0 of height `levels`.
template <class Number>
struct BoxTree {
  std::uint64_t leaves = 0;
  int levels = 0;                                // 0: there is no leaf, and no other member is set
  std::array<std::size_t, kMostLevels> first{};  // per height: index of its first block in `blocks`
  BoxOf<Number> box = empty_box<Number>();       // the box around all leaves
};

/// Returns how many WideBoxes make_tree() writes for a tree with this many leaves.
std::size_t blocks_of_tree(std::size_t leaves);

/// Makes a tree over the boxes. Writes the boxes of its nodes to `blocks`, from index `at` on.
/// boxes: one per leaf; this function overwrites `boxes`.
template <class Number>
BoxTree<Number> make_tree(std::span<BoxOf<Number>> boxes, std::span<WideBoxes<Number>> blocks,
                          std::size_t at) {
  BoxTree<Number> out;
  out.leaves = boxes.size();
  while (!boxes.empty() && (boxes.size() > 1 || out.levels == 0)) {
    const std::size_t n = (boxes.size() + kWide - 1) / kWide;
    for (std::size_t block = 0; block < n; ++block) {
      WideBoxes<Number>& wide = blocks[at + block];
      wide.clear();
      BoxOf<Number> all = empty_box<Number>();
      const std::size_t count = std::min(boxes.size() - kWide * block, std::size_t{kWide});
      for (std::size_t k = 0; k < count; ++k) {
        const BoxOf<Number> box = boxes[kWide * block + k];
        wide.set(k, box);
        all.add(box);
      }
      boxes[block] = all;
    }
    boxes = boxes.first(n);
    out.first[static_cast<std::size_t>(out.levels++)] = at;
    at += n;
  }
  if (!boxes.empty()) out.box = boxes[0];
  return out;
}

/// Orders boxes for a tree: boxes that are close in space become neighbours in the order. Splits
/// the boxes recursively into halves. In each part, huge boxes come first, so they enlarge few
/// nodes. Boxes may be infinite. order: receives the indices of the boxes. Takes O(n log n).
void spatial_order(std::span<const Box> boxes, std::span<std::uint32_t> order);

}  // namespace farcull
