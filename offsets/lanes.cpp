// Compiles obb.glsl, minkowski.glsl and fit.inl for SIMD, with the library Highway.
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "offsets/lanes.cpp"
#include <hwy/foreach_target.h>

#include "core/native/fatten-inl.h"
#include "core/native/proxies-inl.h"
#include "offsets/lanes.h"
#include "offsets/rounding.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace fit {

#undef FAR_BOOL
#define FAR_BOOL WideBool
#define FAR_NEAREST(x) nearest(x)
#define double WideLane
#include "offsets/fit.inl"
#undef double
#undef FAR_NEAREST
#undef FAR_BOOL
#define FAR_BOOL Bool

struct Box {
  static HWY_INLINE void rectangle(const dvec3* p, WideLane radius, WideLane x, WideLane y,
                                   WideLane* corners) {
    fit_rectangle(p, 3, radius, x, y, corners);
  }
  static HWY_INLINE void solid(const dvec3* p, WideLane radius, WideLane* numbers) {
    fit_box(p, 3, radius, numbers);
  }
  static HWY_INLINE void depths(const dvec3* p, WideLane radius, WideLane* found) {
    fit_depths(p, 3, radius, found);
  }
};
struct Minkowski : Box {
  static HWY_INLINE void solid(const dvec3* p, WideLane radius, WideLane* numbers) {
    fit_minkowski(p, radius, numbers);
  }
};

}  // namespace fit
namespace obb {
#define float Lane
#include "offsets/slab.glsl"

#include "offsets/obb.glsl"
#undef float

struct Kernel {
  template <class... Args>
  static HWY_INLINE Bool interval(vec2 c, Args&&... args) {
    return solid_interval(c, args...);
  }
  static Plain nearest(const Solid& s) { return s[0][3]; }
  static Plain farthest(const Solid& s) { return s[4][0]; }
};
}  // namespace obb

void draw_obb(const NativeJob& job) { draw_proxies<obb::Kernel>(job); }
void follow_obb(const NativeLines& lines) { follow_lines<obb::Kernel>(lines); }
void fatten_obb(const FattenBatch& batch) { fatten_batch<fit::Box>(batch); }

namespace minkowski {
#define float Lane
#include "offsets/slab.glsl"

#include "offsets/minkowski.glsl"
#undef float

struct Kernel {
  template <class... Args>
  static HWY_INLINE Bool interval(vec2 c, Args&&... args) {
    return solid_interval(c, args...);
  }
  static Plain nearest(const Solid& s) { return s[0][3]; }
  static Plain farthest(const Solid& s) { return s[2][3]; }
};
}  // namespace minkowski

void draw_minkowski(const NativeJob& job) { draw_proxies<minkowski::Kernel>(job); }
void follow_minkowski(const NativeLines& lines) { follow_lines<minkowski::Kernel>(lines); }
void fatten_minkowski(const FattenBatch& batch) { fatten_batch<fit::Minkowski>(batch); }

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {
HWY_EXPORT(draw_obb);
HWY_EXPORT(follow_obb);
HWY_EXPORT(fatten_obb);

void draw_obb_native(const NativeJob& job) { HWY_DYNAMIC_DISPATCH(draw_obb)(job); }
void follow_obb_native(const NativeLines& lines) { HWY_DYNAMIC_DISPATCH(follow_obb)(lines); }
void fatten_obb_inside(const FattenBatch& batch) { HWY_DYNAMIC_DISPATCH(fatten_obb)(batch); }

HWY_EXPORT(draw_minkowski);
HWY_EXPORT(follow_minkowski);
HWY_EXPORT(fatten_minkowski);

void draw_minkowski_native(const NativeJob& job) { HWY_DYNAMIC_DISPATCH(draw_minkowski)(job); }
void follow_minkowski_native(const NativeLines& lines) {
  HWY_DYNAMIC_DISPATCH(follow_minkowski)(lines);
}
void fatten_minkowski_inside(const FattenBatch& batch) {
  HWY_DYNAMIC_DISPATCH(fatten_minkowski)(batch);
}

}  // namespace farcull
#endif
