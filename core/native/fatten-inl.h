// Fattens triangles (fits proxies to them), one per lane. Leaves out triangles that need clipping.
// Fit, a template parameter, is a type with these functions on lanes (offsets/lanes.cpp):
//   rectangle(p, radius, bound_x, bound_y, corners): the corners of the proxy;
//   solid(p, radius, numbers): its solid; depths(p, radius, depths): nearest and farthest depth.
#if defined(FARCULL_NATIVE_FATTEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_FATTEN_INL_H_
#undef FARCULL_NATIVE_FATTEN_INL_H_
#else
#define FARCULL_NATIVE_FATTEN_INL_H_
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/canvas/fatten.h"
#include "core/native/glsl_lanes-inl.h"
#include "core/view/view.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

HWY_INLINE void prefetch_corners(const Scene& scene, std::uint32_t item) {
  for (const std::uint32_t vertex : scene.triangles[item]) hwy::Prefetch(&scene.vertices[vertex]);
}

/// Sets corners[3 k + i] to coordinate i of corner k. Each lane holds one of the triangles `items`.
/// If `count` is below kWide, the last triangle fills the other lanes.
HWY_INLINE void gather_corners(const Scene& scene, const std::uint32_t* items, int count,
                               WideLane (&corners)[9]) {
  const auto vertex = [&](int lane, int k) HWY_ATTR {
    return scene.vertices[scene.triangles[items[std::min(lane, count - 1)]][k]].data();
  };
#if HWY_TARGET <= HWY_AVX2
  // One load reads the three coordinates of a vertex. Vertices are transposed in groups of four.
  const hn::FixedTag<double, 4> four;
  const auto three = hn::FirstN(four, 3);
  using Four = hn::Vec<decltype(four)>;
  for (int k = 0; k < 3; ++k) {
    Four part[3][kWide / 4];
    for (int from = 0; from < kWide; from += 4) {
      const Four a = hn::MaskedLoad(three, four, vertex(from, k));
      const Four b = hn::MaskedLoad(three, four, vertex(from + 1, k));
      const Four c = hn::MaskedLoad(three, four, vertex(from + 2, k));
      const Four d = hn::MaskedLoad(three, four, vertex(from + 3, k));
      const Four low_a = hn::InterleaveLower(four, a, b), low_c = hn::InterleaveLower(four, c, d);
      const Four high_a = hn::InterleaveUpper(four, a, b), high_c = hn::InterleaveUpper(four, c, d);
      part[0][from / 4] = hn::ConcatLowerLower(four, low_c, low_a);
      part[1][from / 4] = hn::ConcatLowerLower(four, high_c, high_a);
      part[2][from / 4] = hn::ConcatUpperUpper(four, low_c, low_a);
    }
    for (int i = 0; i < 3; ++i) {
#if HWY_TARGET <= HWY_AVX3
      corners[3 * k + i] = WideLane(hn::Combine(WideTag(), part[i][1], part[i][0]));
#else
      corners[3 * k + i] = WideLane(part[i][0]);
#endif
    }
  }
#else
  HWY_ALIGN double numbers[9][kWide];
  for (int lane = 0; lane < kWide; ++lane) {
    for (int k = 0; k < 3; ++k) {
      const double* const corner = vertex(lane, k);
      for (int i = 0; i < 3; ++i) numbers[3 * k + i][lane] = corner[i];
    }
  }
  for (int i = 0; i < 9; ++i) corners[i] = WideLane(hn::Load(WideTag(), numbers[i]));
#endif
}

/// The images of kWide triangles in pixel space. The operations and their order are the same as in
/// to_pixel() (core/view/view.h).
struct WidePixels {
  dvec3 p[3];
  WideLane error = 0.0;  // px; largest error of a corner

  HWY_INLINE WidePixels(const Window& window, const WideLane (&corners)[9]) {
    for (int k = 0; k < 3; ++k) {
      WideLane d[3], image[3];
      for (int i = 0; i < 3; ++i) d[i] = corners[3 * k + i] - WideLane(window.origin[i]);
      for (int row = 0; row < 3; ++row) {
        const WideLane a = WideLane(window.map(row, 0)) * d[0],
                       b = WideLane(window.map(row, 1)) * d[1],
                       c = WideLane(window.map(row, 2)) * d[2];
        image[row] = (a + b) + c;
        error = max(error, pixel_error_bound((abs(a) + abs(b)) + abs(c)));
      }
      p[k] = {image[0], image[1], image[2]};
    }
  }
  static HWY_INLINE WideLane pixel_error_bound(WideLane sum) {
    return WideLane(kMapRounding) * sum + WideLane(kMapUnderflow);
  }
  /// Returns the lanes whose triangles are drawable and need no clipping.
  HWY_INLINE WideBool inside(const Window& window) const {
    WideBool in = error <= WideLane(kMaxDoubleError);
    for (const dvec3& q : p) {
      in = in && q.x >= WideLane(window.lo[0]) && q.x <= WideLane(window.hi[0]);
      in = in && q.y >= WideLane(window.lo[1]) && q.y <= WideLane(window.hi[1]);
      in = in && q.z >= WideLane(window.lo[2]) && q.z <= WideLane(window.hi[2]);
    }
    return in;
  }
};

/// The outlines of kWide proxies, one on each lane.
struct WideOutlines {
  WideLane x0, x1, y0, y1, nearest, farthest, x, y, depth;

  template <class Fit>
  static HWY_INLINE WideOutlines of(const FattenBatch& batch, const WidePixels& pixels,
                                    const Fit&) {
    WideOutlines out;
    WideLane corners[8], depths[2];
    Fit::rectangle(pixels.p, batch.radius, batch.bounds.x, batch.bounds.y, corners);
    range(corners[0], corners[2], corners[4], corners[6], batch.window->width, out.x0, out.x1);
    range(corners[1], corners[3], corners[5], corners[7], batch.window->height, out.y0, out.y1);
    Fit::depths(pixels.p, batch.radius, depths);
    out.nearest = depths[0];
    out.farthest = depths[1];
    // Finds the farthest corner. Sets x and y to the pixel that contains this corner.
    dvec3 corner = pixels.p[0];
    for (int k = 1; k < 3; ++k) {
      const WideBool behind = pixels.p[k].z > corner.z;
      corner = {select(behind, pixels.p[k].x, corner.x), select(behind, pixels.p[k].y, corner.y),
                select(behind, pixels.p[k].z, corner.z)};
    }
    const WideLane half_x(0.5 * batch.window->width), half_y(0.5 * batch.window->height);
    out.x = floored(corner.x + half_x);
    out.y = floored(corner.y + half_y);
    const WideLane dx = (out.x + WideLane(0.5)) - (corner.x + half_x);
    const WideLane dy = (out.y + WideLane(0.5)) - (corner.y + half_y);
    const WideBool covered = dx * dx + dy * dy < WideLane(batch.reach * std::fabs(batch.reach)) &&
                             out.x >= 0.0 && out.y >= 0.0 && out.x < half_x + half_x &&
                             out.y < half_y + half_y;
    out.x = select(covered, out.x, static_cast<double>(kNoPixel));
    // The relative rounding error is at most 2^-53 in double and 2^-24 in float. The subtracted
    // term is larger, so out.depth is certainly less than the depth of the corner.
    out.depth = farcull::HWY_NAMESPACE::nearest(
        corner.z - (abs(corner.z) * WideLane(0x1p-23) + WideLane(0x1p-140)));
    return out;
  }

 private:
  static HWY_INLINE WideLane floored(WideLane a) { return WideLane(hn::Floor(a.v)); }
  /// Computes pixel_range() (core/canvas/fatten.h) along one axis, without a margin.
  static HWY_INLINE void range(WideLane a, WideLane b, WideLane c, WideLane d, int size,
                               WideLane& from, WideLane& to) {
    const WideLane half(0.5 * size), most(size);
    const WideLane lo = min(min(a, b), min(c, d)), hi = max(max(a, b), max(c, d));
    from = min(max(WideLane(hn::Ceil((lo + half - WideLane(0.5)).v)), 0.0), most);
    to = min(max(floored(hi + half - WideLane(0.5)) + WideLane(1.0), 0.0), most);
  }
};

HWY_INLINE void store_outlines(const WideOutlines& of, int lanes, ProxyOutline* out) {
  const hn::Rebind<std::int32_t, WideTag> whole;
  HWY_ALIGN std::int32_t pixels[6][kWide];
  HWY_ALIGN float depths[3][kWide];
  const WideLane* const pixel_of[6] = {&of.x0, &of.x1, &of.y0, &of.y1, &of.x, &of.y};
  for (int i = 0; i < 6; ++i) {
    // Numbers that do not fit into 16 bits become 0. Only triangles outside the region give them.
    const WideLane a = *pixel_of[i];
    const WideLane fitting = select(a >= 0.0 && a <= WideLane(65535.0), a, 0.0);
    hn::Store(hn::DemoteTo(whole, fitting.v), whole, pixels[i]);
  }
  const WideLane* const depth_of[3] = {&of.nearest, &of.farthest, &of.depth};
  for (int i = 0; i < 3; ++i)
    hn::Store(hn::DemoteTo(NarrowTag(), depth_of[i]->v), NarrowTag(), depths[i]);
  for (int lane = 0; lane < lanes; ++lane) {
    const auto pixel = [&](int i) { return static_cast<std::uint16_t>(pixels[i][lane]); };
    PixelRange range{pixel(0), pixel(1), pixel(2), pixel(3)};
    if (range.x0 >= range.x1) range.y1 = range.y0;
    out[lane] = {.range = range,
                 .nearest = depths[0][lane],
                 .farthest = depths[1][lane],
                 .x = pixel(4),
                 .y = pixel(5),
                 .depth = depths[2][lane]};
  }
}

/// Stores `lanes` proxies. found[i] holds number i of the 28 floats of each proxy, one per lane.
HWY_INLINE void store_proxies(const WideLane (&found)[28], int lanes, Proxy* out) {
  static_assert(sizeof(Proxy) == 28 * sizeof(float));
  HWY_ALIGN float four[7][kWide][4];
  const auto narrow = [&](int i) HWY_ATTR { return hn::DemoteTo(NarrowTag(), found[i].v); };
  for (int i = 0; i < 7; ++i) {
    hn::StoreInterleaved4(narrow(4 * i), narrow(4 * i + 1), narrow(4 * i + 2), narrow(4 * i + 3),
                          NarrowTag(), four[i][0]);
  }
  for (int lane = 0; lane < lanes; ++lane) {
    char* const proxy = reinterpret_cast<char*>(&out[lane]);
    for (int i = 0; i < 7; ++i) std::memcpy(proxy + 16 * i, four[i][lane], 16);
  }
}

/// Implements Fattener::fatten_inside (core/canvas/fatten.h) for the type Fit.
template <class Fit>
HWY_INLINE void fatten_batch(const FattenBatch& batch) {
  HWY_ALIGN double in[kWide];
  for (std::size_t from = 0; from < batch.count; from += kWide) {
    const int lanes = static_cast<int>(std::min<std::size_t>(kWide, batch.count - from));
    WideLane corners[9];
    gather_corners(*batch.scene, batch.items + from, lanes, corners);
    for (std::size_t i = from + kWide; i < std::min(from + 2 * kWide, batch.count); ++i)
      prefetch_corners(*batch.scene, batch.items[i]);
    const WidePixels pixels(*batch.window, corners);
    const WideBool inside = pixels.inside(*batch.window);
    hn::Store(select(inside, 1.0, 0.0).v, WideTag(), in);
    for (int lane = 0; lane < lanes; ++lane) batch.done[from + lane] = in[lane] != 0;
    if (batch.outlines != nullptr) {
      store_outlines(WideOutlines::of(batch, pixels, Fit()), lanes, batch.outlines + from);
      continue;
    }
    WideLane found[28];
    Fit::rectangle(pixels.p, batch.radius, batch.bounds.x, batch.bounds.y, found);
    Fit::solid(pixels.p, batch.radius, found + 8);
    store_proxies(found, lanes, batch.out + from);
  }
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
