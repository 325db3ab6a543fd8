// Computes the boxes of triangles in registers, and stores them as columns of floats.
// spatial_order() splits a set of boxes along the axis on which the box centres are spread most.
#include "core/boxes/block.h"

#include <vector>

namespace farcull {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

// The box around some points, in doubles. relative_to() converts the box to floats.
#ifdef __SSE2__
struct Bounds {
  __m128d lo_xy, lo_z, hi_xy, hi_z;

  static Bounds empty() {
    const __m128d inf = _mm_set1_pd(HUGE_VAL), minus = _mm_set1_pd(-HUGE_VAL);
    return {inf, inf, minus, minus};
  }
  static Bounds of(const Vec3& point) {
    const __m128d xy = _mm_loadu_pd(point.data()), z = _mm_load_sd(point.data() + 2);
    return {xy, z, xy, z};
  }
  void add(const Bounds& b) {
    lo_xy = _mm_min_pd(lo_xy, b.lo_xy);
    lo_z = _mm_min_sd(lo_z, b.lo_z);
    hi_xy = _mm_max_pd(hi_xy, b.hi_xy);
    hi_z = _mm_max_sd(hi_z, b.hi_z);
  }
  Box box() const {
    Box out;
    _mm_storeu_pd(out.lo.data(), lo_xy);
    _mm_store_sd(out.lo.data() + 2, lo_z);
    _mm_storeu_pd(out.hi.data(), hi_xy);
    _mm_store_sd(out.hi.data() + 2, hi_z);
    return out;
  }
  // Precondition: `origin` is the box of a single point.
  FloatBox relative_to(const Bounds& origin) const {
    const auto floats = [](__m128d xy, __m128d z) {
      const __m128 all = _mm_movelh_ps(_mm_cvtpd_ps(xy), _mm_cvtpd_ps(z));
      return _mm_max_ps(_mm_min_ps(all, _mm_set1_ps(kLargest)), _mm_set1_ps(-kLargest));
    };
    FloatBox out;
    const auto z_only = [](__m128d z) { return _mm_unpacklo_pd(z, _mm_setzero_pd()); };
    _mm_store_ps(out.lo.data(),
                 floats(_mm_sub_pd(lo_xy, origin.lo_xy), z_only(_mm_sub_sd(lo_z, origin.lo_z))));
    _mm_store_ps(out.hi.data(),
                 floats(_mm_sub_pd(hi_xy, origin.lo_xy), z_only(_mm_sub_sd(hi_z, origin.lo_z))));
    return out;
  }
};
#else
struct Bounds {
  Box own;

  static Bounds empty() { return {Box::empty()}; }
  static Bounds of(const Vec3& point) { return {{point, point}}; }
  void add(const Bounds& b) { own.add(b.own); }
  Box box() const { return own; }
  FloatBox relative_to(const Bounds& origin) const {
    FloatBox out{};
    for (int k = 0; k < 3; ++k) {
      const auto part = [&](const Vec3& p) {
        return std::clamp(static_cast<float>(p[k] - origin.own.lo[k]), -kLargest, kLargest);
      };
      out.lo[static_cast<std::size_t>(k)] = part(own.lo);
      out.hi[static_cast<std::size_t>(k)] = part(own.hi);
    }
    return out;
  }
};
#endif

Bounds of(const Box& box) {
  Bounds out = Bounds::of(box.lo);
  out.add(Bounds::of(box.hi));
  return out;
}

// Returns the box of a triangle, not grown.
Bounds bounds_of(const Scene& scene, std::uint32_t triangle) {
  const auto& [p, q, r] = scene.triangles[triangle];
  Bounds out = Bounds::of(scene.vertices[p]);
  out.add(Bounds::of(scene.vertices[q]));
  out.add(Bounds::of(scene.vertices[r]));
  return out;
}

FloatBox relative_box(const Bounds& bounds, double half, const Bounds& origin) {
  if (half == 0) return bounds.relative_to(origin);
  return of(grow(bounds.box(), half)).relative_to(origin);
}

// Writes box(0) .. box(15) to the columns of `out`, and the box around these boxes to out.bound.
template <class BoxAt>
void fill_columns(const BoxAt& box, BlockLanes& out) {
#ifdef __SSE2__
  __m128 least = _mm_set1_ps(kInfinite), most = _mm_set1_ps(-kInfinite);
  for (std::uint32_t k = 0; k < kWide; k += 4) {
    std::array<__m128, 4> lo, hi;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const FloatBox& own = box(k + i);
      lo[i] = _mm_load_ps(own.lo.data());
      hi[i] = _mm_load_ps(own.hi.data());
      least = _mm_min_ps(least, lo[i]);
      most = _mm_max_ps(most, hi[i]);
    }
    _MM_TRANSPOSE4_PS(lo[0], lo[1], lo[2], lo[3]);
    _MM_TRANSPOSE4_PS(hi[0], hi[1], hi[2], hi[3]);
    for (std::size_t i = 0; i < 3; ++i) {
      _mm_store_ps(&out.boxes.column[i][k], lo[i]);
      _mm_store_ps(&out.boxes.column[i + 3][k], hi[i]);
    }
  }
  _mm_store_ps(out.bound.lo.data(), least);
  _mm_store_ps(out.bound.hi.data(), most);
#else
  out.bound = kNowhere;
  for (std::uint32_t k = 0; k < kWide; ++k) {
    const FloatBox own = box(k);
    out.boxes.set(k, own);
    out.bound.add(own);
  }
#endif
}

// A box to sort. `half` holds half the side lengths, because a side length may overflow.
struct Placed {
  std::array<double, 3> middle, half;
  std::uint32_t box;
};

// The axis on which the middles of the boxes have the widest range, and this range [lo, hi].
struct Spread {
  std::size_t axis = 0;
  double lo = 0, hi = 0;
  double half() const { return 0.5 * hi - 0.5 * lo; }
  void widen(const Spread& other) {
    if (other.half() > half()) *this = other;
  }
};

// Returns the spread of every step-th item.
Spread spread_of(std::span<const Placed> items, std::size_t step) {
  Spread out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double lo = items[0].middle[axis], hi = lo;
    for (std::size_t k = step; k < items.size(); k += step) {
      lo = std::min(lo, items[k].middle[axis]);
      hi = std::max(hi, items[k].middle[axis]);
    }
    out.widen({axis, lo, hi});
  }
  return out;
}

// Sorts the items as spatial_order() requires. at: position of the first item among all boxes.
void sort_in_place(std::span<Placed> items, std::size_t at) {
  while (items.size() > kWide) {
    Spread spread = spread_of(items, std::max<std::size_t>(items.size() / 32, 4));
    if (spread.half() == 0) spread = spread_of(items, 1);
    if (spread.half() == 0) return;
    // Moves boxes that span the whole range to the front, since they would enlarge their half.
    // Sorts these boxes separately if they are at most half of the items, to limit the depth.
    const auto rest = std::partition(items.begin(), items.end(), [&](const Placed& item) {
      const double middle = item.middle[spread.axis], half = item.half[spread.axis];
      return middle - half <= spread.lo && middle + half >= spread.hi;
    });
    const auto large = static_cast<std::size_t>(rest - items.begin());
    if (large > 0 && large <= items.size() / 2) {
      sort_in_place(items.first(large), at);
      items = items.subspan(large);
      at += large;
    }
    // Splits near the middle, at a position where a tree node with `node` leaves ends.
    std::size_t node = 1;
    while (node * kWide < items.size()) node *= kWide;
    const std::size_t split = (at + items.size() / 2 + node / 2) / node * node;
    const std::size_t low = split > at && split < at + items.size() ? split - at : items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(low), items.end(),
                     [&](const Placed& a, const Placed& b) {
                       return a.middle[spread.axis] < b.middle[spread.axis];
                     });
    sort_in_place(items.first(low), at);
    items = items.subspan(low);
    at += low;
  }
}

}  // namespace

FloatBox relative(const Box& box, const Vec3& origin) {
  return box.is_empty() ? kNowhere : of(box).relative_to(Bounds::of(origin));
}

Box box_of(const Scene& scene, std::uint32_t from, std::uint32_t to) {
  // Each corner has its own bounds, so that the processor can update the three bounds in parallel.
  Bounds a = Bounds::empty(), b = a, c = a;
  const auto last = static_cast<std::uint32_t>(scene.triangles.size() - 1);
  for (std::uint32_t t = from; t < to; ++t) {
    prefetch(scene, std::min(t + kTrianglesAhead, last));
    const auto& [p, q, r] = scene.triangles[t];
    a.add(Bounds::of(scene.vertices[p]));
    b.add(Bounds::of(scene.vertices[q]));
    c.add(Bounds::of(scene.vertices[r]));
  }
  a.add(b);
  a.add(c);
  return a.box();
}

void relative_boxes(const Scene& scene, std::uint32_t from, std::uint32_t to, double half,
                    const Vec3& origin, FloatBox* out) {
  const Bounds zero = Bounds::of(origin);
  const auto last = static_cast<std::uint32_t>(scene.triangles.size() - 1);
  for (std::uint32_t t = from; t < to; ++t) {
    prefetch(scene, std::min(t + kTrianglesAhead, last));
    out[t - from] = relative_box(bounds_of(scene, t), half, zero);
  }
}

Box fill_lanes(const Scene& scene, std::span<const std::uint32_t> triangles, double half,
               const Vec3& origin, BlockLanes& out) {
  const Bounds zero = Bounds::of(origin);
  Bounds all = Bounds::empty();
  out.triangles = {};
  std::ranges::copy(triangles, out.triangles.begin());
  fill_columns(
      [&](std::uint32_t k) {
        if (k >= triangles.size()) return kNowhere;
        const Bounds own = bounds_of(scene, triangles[k]);
        all.add(own);
        return relative_box(own, half, zero);
      },
      out);
  return all.box();
}

std::size_t blocks_of_tree(std::size_t leaves) {
  std::size_t out = 0, level = leaves;
  while (level > 1 || out == 0) {
    if (level == 0) return 0;
    level = (level + kWide - 1) / kWide;
    out += level;
  }
  return out;
}

void spatial_order(std::span<const Box> boxes, std::span<std::uint32_t> order) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  std::vector<Placed> items;
  items.reserve(boxes.size());
  for (const Box& box : boxes) {
    Placed& item = items.emplace_back(Placed{{}, {}, static_cast<std::uint32_t>(items.size())});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto half = [&](const Vec3& end) {
        return 0.5 * std::clamp(end[static_cast<Eigen::Index>(axis)], -kLargest, kLargest);
      };
      item.middle[axis] = half(box.lo) + half(box.hi);
      item.half[axis] = half(box.hi) - half(box.lo);
    }
  }
  sort_in_place(items, 0);
  for (std::size_t k = 0; k < items.size(); ++k) order[k] = items[k].box;
}

}  // namespace farcull
