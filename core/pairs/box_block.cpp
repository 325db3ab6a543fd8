#include "core/pairs/box_block.h"

#include <algorithm>

#include "core/pairs/grown_box.h"

namespace farcull {
namespace {

// Triangles whose corners are fetched ahead.
constexpr std::uint32_t kAhead = 16;
constexpr float kLargest = std::numeric_limits<float>::max();

// The bounds of points, and as floats.
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
  // `origin`: a point.
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

// Not grown.
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

// The boxes box(0) .. box(15).
template <class BoxAt>
void fill_columns(const BoxAt& box, RunBlock& out) {
#ifdef __SSE2__
  __m128 least = _mm_set1_ps(kInfinite), most = _mm_set1_ps(-kInfinite);
  for (std::uint32_t k = 0; k < kRun; k += 4) {
    const std::array<FloatBox, 4> four = {box(k), box(k + 1), box(k + 2), box(k + 3)};
    std::array<__m128, 4> lo, hi;
    for (std::size_t i = 0; i < 4; ++i) {
      lo[i] = _mm_load_ps(four[i].lo.data());
      hi[i] = _mm_load_ps(four[i].hi.data());
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
  for (std::uint32_t k = 0; k < kRun; ++k) {
    const FloatBox own = box(k);
    out.boxes.set(k, own);
    for (std::size_t i = 0; i < 3; ++i) {
      out.bound.lo[i] = std::min(out.bound.lo[i], own.lo[i]);
      out.bound.hi[i] = std::max(out.bound.hi[i], own.hi[i]);
    }
  }
#endif
}

}  // namespace

FloatBox relative(const Box& box, const Vec3& origin) {
  return box.is_empty() ? kNowhere : of(box).relative_to(Bounds::of(origin));
}

Box box_of(const Scene& scene, std::uint32_t from, std::uint32_t to) {
  // Each of the three corners has bounds of its own, so that none waits for another.
  Bounds a = Bounds::empty(), b = a, c = a;
  const auto last = static_cast<std::uint32_t>(scene.triangles.size() - 1);
  for (std::uint32_t t = from; t < to; ++t) {
    // They may lie anywhere, so they are fetched ahead.
    prefetch(scene, std::min(t + kAhead, last));
    const auto& [p, q, r] = scene.triangles[t];
    a.add(Bounds::of(scene.vertices[p]));
    b.add(Bounds::of(scene.vertices[q]));
    c.add(Bounds::of(scene.vertices[r]));
  }
  a.add(b);
  a.add(c);
  return a.box();
}

Box relative_boxes(const Scene& scene, std::uint32_t from, std::uint32_t to, double half,
                   const Vec3& origin, FloatBox* out) {
  const Bounds zero = Bounds::of(origin);
  Bounds all = Bounds::empty();
  for (std::uint32_t t = from; t < to; ++t) {
    // Their corners may lie anywhere.
    prefetch(scene, std::min(t + kAhead, to - 1));
    const Bounds own = bounds_of(scene, t);
    all.add(own);
    out[t - from] = relative_box(own, half, zero);
  }
  return all.box();
}

void fill_block(std::span<const std::uint32_t> triangles, const FloatBox* boxes,
                std::uint32_t first, RunBlock& out) {
  if (triangles.size() == kRun) {
    std::ranges::copy(triangles, out.triangles.begin());
    fill_columns([&](std::uint32_t k) { return boxes[triangles[k] - first]; }, out);
    return;
  }
  out.triangles = {};
  std::ranges::copy(triangles, out.triangles.begin());
  fill_columns(
      [&](std::uint32_t k) {
        return k < triangles.size() ? boxes[triangles[k] - first] : kNowhere;
      },
      out);
}

Box fill_block(const Scene& scene, std::span<const std::uint32_t> triangles, double half,
               const Vec3& origin, RunBlock& out) {
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

}  // namespace farcull
