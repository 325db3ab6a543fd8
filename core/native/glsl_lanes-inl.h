// Lets a kernel file (*.glsl) compile for the lanes of a vector processor: `float` stands for Lane,
// a vector of floats, one pixel a lane. Every operation is that of core/base/glsl_shim.h, lane by
// lane, rounded once, so the bits are the same. Compiled once for each instruction set that Google
// Highway can choose between (hwy/foreach_target.h). Include a kernel between
// `#define float Lane` and `#undef float`, as offsets/obb_lanes.cpp does.
#if defined(FARCULL_NATIVE_GLSL_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_GLSL_LANES_INL_H_
#undef FARCULL_NATIVE_GLSL_LANES_INL_H_
#else
#define FARCULL_NATIVE_GLSL_LANES_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Plain = float;  // where `float` stands for Lane
using LaneTag = hn::CappedTag<float, 16>;
using LaneVector = hn::Vec<LaneTag>;
using LaneMask = hn::Mask<LaneTag>;

/// A truth value for each lane.
struct Bool {
  Bool() = default;
  HWY_INLINE explicit Bool(bool all)
      : mask(all ? hn::Eq(hn::Zero(LaneTag()), hn::Zero(LaneTag()))
                 : hn::Ne(hn::Zero(LaneTag()), hn::Zero(LaneTag()))) {}
  HWY_INLINE explicit Bool(LaneMask m) : mask(m) {}
  LaneMask mask;
};
HWY_INLINE Bool operator&&(Bool a, Bool b) { return Bool(hn::And(a.mask, b.mask)); }
HWY_INLINE Bool operator||(Bool a, Bool b) { return Bool(hn::Or(a.mask, b.mask)); }
HWY_INLINE Bool operator!(Bool a) { return Bool(hn::Not(a.mask)); }

struct Lane {
  Lane() = default;
  HWY_INLINE Lane(Plain x) : v(hn::Set(LaneTag(), x)) {}  // NOLINT: kernels mix in literals
  HWY_INLINE explicit Lane(LaneVector x) : v(x) {}
  LaneVector v;
};
HWY_INLINE Lane operator-(Lane a) { return Lane(hn::Neg(a.v)); }
HWY_INLINE Lane operator+(Lane a, Lane b) { return Lane(hn::Add(a.v, b.v)); }
HWY_INLINE Lane operator-(Lane a, Lane b) { return Lane(hn::Sub(a.v, b.v)); }
HWY_INLINE Lane operator*(Lane a, Lane b) { return Lane(hn::Mul(a.v, b.v)); }
HWY_INLINE Lane operator/(Lane a, Lane b) { return Lane(hn::Div(a.v, b.v)); }
HWY_INLINE Bool operator<(Lane a, Lane b) { return Bool(hn::Lt(a.v, b.v)); }
HWY_INLINE Bool operator>(Lane a, Lane b) { return Bool(hn::Gt(a.v, b.v)); }
HWY_INLINE Bool operator<=(Lane a, Lane b) { return Bool(hn::Le(a.v, b.v)); }
HWY_INLINE Bool operator>=(Lane a, Lane b) { return Bool(hn::Ge(a.v, b.v)); }
HWY_INLINE Lane select(Bool c, Lane a, Lane b) { return Lane(hn::IfThenElse(c.mask, a.v, b.v)); }
// b < a ? b : a and a < b ? b : a, zeros and NaNs included: on x86 that is one instruction with the
// operands exchanged.
HWY_INLINE Lane min(Lane a, Lane b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return Lane(hn::Min(b.v, a.v));
#else
  return select(b < a, b, a);
#endif
}
HWY_INLINE Lane max(Lane a, Lane b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return Lane(hn::Max(b.v, a.v));
#else
  return select(a < b, b, a);
#endif
}
HWY_INLINE Lane abs(Lane a) { return Lane(hn::Abs(a.v)); }
HWY_INLINE Lane sqrt(Lane a) { return Lane(hn::Sqrt(a.v)); }
/// The answer of the first lane, for what is the same in all of them.
HWY_INLINE bool of_all(Bool c) { return hn::AllTrue(LaneTag(), c.mask); }

struct vec2 {
  Lane x, y;
};
struct vec4 {
  Lane x, y, z, w;
};

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// What kernels write, for lanes; core/base/glsl_shim.h has the same names for scalars.
#undef FAR_OUT
#undef FAR_INOUT
#undef FAR_PRECISE
#undef FAR_KERNEL
#undef FAR_FIXED
#undef FAR_CONSTANT
#undef FAR_BOOL
#undef FAR_SELECT
#undef FAR_UNIFORM
#define FAR_OUT(type) type&
#define FAR_INOUT(type) type&
#define FAR_PRECISE
#define FAR_KERNEL HWY_INLINE
#define FAR_FIXED(x) (x)
#define FAR_CONSTANT constexpr Plain
#define FAR_BOOL Bool
#define FAR_SELECT(c, a, b) select(c, a, b)
#define FAR_UNIFORM(c) of_all(c)

#endif  // include guard that Highway toggles
