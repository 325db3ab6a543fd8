// Fattens the triangles that lie inside the region, one a lane. A fit is a type with
//   rectangle(p, radius, bound_x, bound_y, corners) and solid(p, radius, numbers)
// on lanes (offsets/lanes.cpp).
#if defined(FARCULL_NATIVE_FATTEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_FATTEN_INL_H_
#undef FARCULL_NATIVE_FATTEN_INL_H_
#else
#define FARCULL_NATIVE_FATTEN_INL_H_
#endif

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

/// Fattener::fatten_inside (core/canvas/fatten.h) by this Fit.
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
    WideLane found[28];
    Fit::rectangle(pixels.p, batch.radius, batch.bounds.x, batch.bounds.y, found);
    Fit::solid(pixels.p, batch.radius, found + 8);
    for (int i = 0; i < 28; ++i)
      hn::Store(hn::DemoteTo(NarrowTag(), found[i].v), NarrowTag(), numbers[i]);
    hn::Store(select(inside, 1.0, 0.0).v, tag, in);
    for (int lane = 0; lane < lanes; ++lane) {
      batch.done[from + lane] = in[lane] != 0;
      Proxy& proxy = batch.out[from + lane];
      for (int i = 0; i < 8; ++i) proxy.corners[i] = numbers[i][lane];
      for (int i = 0; i < 20; ++i) proxy.solid[i / 4][i % 4] = numbers[8 + i][lane];
    }
  }
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
