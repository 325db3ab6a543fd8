// Fattens the triangles that lie inside the region, one on each lane. A fit is a type with
//   rectangle(p, radius, bound_x, bound_y, corners), solid(p, radius, numbers) and
//   depths(p, radius, nearest and farthest)
// on lanes (offsets/lanes.cpp).
#if defined(FARCULL_NATIVE_FATTEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_FATTEN_INL_H_
#undef FARCULL_NATIVE_FATTEN_INL_H_
#else
#define FARCULL_NATIVE_FATTEN_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "core/canvas/fatten.h"
#include "core/native/glsl_lanes-inl.h"
#include "core/view/view.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

/// The images of kWide triangles, by the operations of to_pixel() (core/view/view.h) in their
/// order.
struct WidePixels {
  dvec3 p[3];
  WideLane error = 0.0;  // px; the largest of the corners

  HWY_INLINE WidePixels(const Window& window, const double (&corners)[9][kWide]) {
    const WideTag tag;
    for (int k = 0; k < 3; ++k) {
      WideLane d[3], image[3];
      for (int i = 0; i < 3; ++i)
        d[i] = WideLane(hn::Load(tag, corners[3 * k + i])) - WideLane(window.origin[i]);
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
  /// The lanes whose triangles are drawable, and inside the region without clipping.
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
    // The pixel of the farthest corner.
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
    // A float that is surely before the corner: a double errs by 2^-53, a float by 2^-24.
    out.depth = farcull::HWY_NAMESPACE::nearest(
        corner.z - (abs(corner.z) * WideLane(0x1p-23) + WideLane(0x1p-140)));
    return out;
  }

 private:
  static HWY_INLINE WideLane floored(WideLane a) { return WideLane(hn::Floor(a.v)); }
  /// As pixel_range() (core/canvas/fatten.h), along one axis.
  static HWY_INLINE void range(WideLane a, WideLane b, WideLane c, WideLane d, int size,
                               WideLane& from, WideLane& to) {
    const WideLane half(0.5 * size), most(size);
    const WideLane lo = min(min(a, b), min(c, d)), hi = max(max(a, b), max(c, d));
    from = min(max(WideLane(hn::Ceil((lo + half - WideLane(0.5)).v)), 0.0), most);
    to = min(max(floored(hi + half - WideLane(0.5)) + WideLane(1.0), 0.0), most);
  }
};

HWY_INLINE void store_outlines(const WideOutlines& of, int lanes, ProxyOutline* out) {
  const WideTag tag;
  HWY_ALIGN double numbers[9][kWide];
  const WideLane* const lane_of[9] = {&of.x0,       &of.x1, &of.y0, &of.y1,   &of.nearest,
                                      &of.farthest, &of.x,  &of.y,  &of.depth};
  for (int i = 0; i < 9; ++i) hn::Store(lane_of[i]->v, tag, numbers[i]);
  for (int lane = 0; lane < lanes; ++lane) {
    // If a triangle is not inside, its numbers may be anything. Those that do not fit become 0.
    const auto pixel = [&](int i) HWY_ATTR {
      const double a = numbers[i][lane];
      return static_cast<std::uint16_t>(a >= 0 && a <= 65535 ? a : 0);
    };
    PixelRange range{pixel(0), pixel(1), pixel(2), pixel(3)};
    if (range.x0 >= range.x1) range.y1 = range.y0;
    out[lane] = {.range = range,
                 .nearest = static_cast<float>(numbers[4][lane]),
                 .farthest = static_cast<float>(numbers[5][lane]),
                 .x = pixel(6),
                 .y = pixel(7),
                 .depth = static_cast<float>(numbers[8][lane])};
  }
}

/// Does Fattener::fatten_inside (core/canvas/fatten.h) with this Fit.
template <class Fit>
HWY_INLINE void fatten_batch(const FattenBatch& batch) {
  const WideTag tag;
  HWY_ALIGN double corners[9][kWide];
  HWY_ALIGN float numbers[28][kWide];
  HWY_ALIGN double in[kWide];
  for (std::size_t from = 0; from < batch.count; from += kWide) {
    const int lanes = static_cast<int>(std::min<std::size_t>(kWide, batch.count - from));
    for (int lane = 0; lane < kWide; ++lane) {
      const auto& triangle = batch.scene->triangles[batch.items[from + std::min(lane, lanes - 1)]];
      for (int k = 0; k < 3; ++k) {
        const Vec3& corner = batch.scene->vertices[triangle[k]];
        for (int i = 0; i < 3; ++i) corners[3 * k + i][lane] = corner[i];
      }
    }
    const WidePixels pixels(*batch.window, corners);
    const WideBool inside = pixels.inside(*batch.window);
    hn::Store(select(inside, 1.0, 0.0).v, tag, in);
    for (int lane = 0; lane < lanes; ++lane) batch.done[from + lane] = in[lane] != 0;
    if (batch.outlines != nullptr) {
      store_outlines(WideOutlines::of(batch, pixels, Fit()), lanes, batch.outlines + from);
      continue;
    }
    WideLane found[28];
    Fit::rectangle(pixels.p, batch.radius, batch.bounds.x, batch.bounds.y, found);
    Fit::solid(pixels.p, batch.radius, found + 8);
    for (int i = 0; i < 28; ++i)
      hn::Store(hn::DemoteTo(NarrowTag(), found[i].v), NarrowTag(), numbers[i]);
    for (int lane = 0; lane < lanes; ++lane) {
      Proxy& proxy = batch.out[from + lane];
      for (int i = 0; i < 8; ++i) proxy.corners[i] = numbers[i][lane];
      for (int i = 0; i < 20; ++i) proxy.solid[i / 4][i % 4] = numbers[8 + i][lane];
    }
  }
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
