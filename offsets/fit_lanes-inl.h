// The text of fit.inl on lanes.
#if defined(FARCULL_OFFSETS_FIT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_OFFSETS_FIT_LANES_INL_H_
#undef FARCULL_OFFSETS_FIT_LANES_INL_H_
#else
#define FARCULL_OFFSETS_FIT_LANES_INL_H_
#endif

#include "core/native/fatten-inl.h"
#include "offsets/fit_rounding.h"

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
};
struct Minkowski : Box {
  static HWY_INLINE void solid(const dvec3* p, WideLane radius, WideLane* numbers) {
    fit_minkowski(p, radius, numbers);
  }
};

}  // namespace fit
}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
