// The kernel of minkowski.glsl and its fit on the lanes of this processor.
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "offsets/minkowski_lanes.cpp"
#include <hwy/foreach_target.h>

#include "core/native/proxies-inl.h"
#include "offsets/fit_lanes-inl.h"
#include "offsets/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
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
