// The kernel of obb.glsl and its fit on the lanes of this processor.
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "offsets/obb_lanes.cpp"
#include <hwy/foreach_target.h>

#include "core/native/proxies-inl.h"
#include "offsets/fit_lanes-inl.h"
#include "offsets/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
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

}  // namespace farcull
#endif
