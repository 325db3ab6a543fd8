// Lets a kernel file (*.glsl) compile as C++ for SIMD. The macro `float` then means Lane, a vector
// of floats with one pixel per lane. Every operation rounds once per lane, as in
// core/base/glsl_shim.h, so the bits are the same. Google Highway compiles this file once for each
// instruction set (hwy/foreach_target.h). Include a kernel between `#define float Lane` and `#undef
// float`, as in offsets/lanes.cpp.
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

/// A SIMD vector of truth values, one per lane. D: Highway's tag for the vector type.
template <class D>
struct BoolOf {
  BoolOf() = default;
  HWY_INLINE explicit BoolOf(bool all)
      : mask(all ? hn::Eq(hn::Zero(D()), hn::Zero(D())) : hn::Ne(hn::Zero(D()), hn::Zero(D()))) {}
  HWY_INLINE explicit BoolOf(hn::Mask<D> m) : mask(m) {}
  hn::Mask<D> mask;

  friend HWY_INLINE BoolOf operator&&(BoolOf a, BoolOf b) {
    return BoolOf(hn::And(a.mask, b.mask));
  }
  friend HWY_INLINE BoolOf operator||(BoolOf a, BoolOf b) { return BoolOf(hn::Or(a.mask, b.mask)); }
  friend HWY_INLINE BoolOf operator!(BoolOf a) { return BoolOf(hn::Not(a.mask)); }
};

/// A SIMD vector of numbers, one per lane. D: Highway's tag for the vector type.
template <class D>
struct LaneOf {
  LaneOf() = default;
  HWY_INLINE LaneOf(hn::TFromD<D> x) : v(hn::Set(D(), x)) {}  // NOLINT: kernels mix in literals
  HWY_INLINE explicit LaneOf(hn::Vec<D> x) : v(x) {}
  hn::Vec<D> v;

  friend HWY_INLINE LaneOf operator-(LaneOf a) { return LaneOf(hn::Neg(a.v)); }
  friend HWY_INLINE LaneOf operator+(LaneOf a, LaneOf b) { return LaneOf(hn::Add(a.v, b.v)); }
  friend HWY_INLINE LaneOf operator-(LaneOf a, LaneOf b) { return LaneOf(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE LaneOf operator*(LaneOf a, LaneOf b) { return LaneOf(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE LaneOf operator/(LaneOf a, LaneOf b) { return LaneOf(hn::Div(a.v, b.v)); }
  friend HWY_INLINE BoolOf<D> operator<(LaneOf a, LaneOf b) { return BoolOf<D>(hn::Lt(a.v, b.v)); }
  friend HWY_INLINE BoolOf<D> operator>(LaneOf a, LaneOf b) { return BoolOf<D>(hn::Gt(a.v, b.v)); }
  friend HWY_INLINE BoolOf<D> operator<=(LaneOf a, LaneOf b) { return BoolOf<D>(hn::Le(a.v, b.v)); }
  friend HWY_INLINE BoolOf<D> operator>=(LaneOf a, LaneOf b) { return BoolOf<D>(hn::Ge(a.v, b.v)); }
  // min(a, b) is b < a ? b : a, and max(a, b) is a < b ? b : a, even for zeros and NaNs. The x86
  // instructions give these results if their operands are exchanged.
  friend HWY_INLINE LaneOf min(LaneOf a, LaneOf b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
    return LaneOf(hn::Min(b.v, a.v));
#else
    return LaneOf(hn::IfThenElse((b < a).mask, b.v, a.v));
#endif
  }
  friend HWY_INLINE LaneOf max(LaneOf a, LaneOf b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
    return LaneOf(hn::Max(b.v, a.v));
#else
    return LaneOf(hn::IfThenElse((a < b).mask, b.v, a.v));
#endif
  }
  friend HWY_INLINE LaneOf abs(LaneOf a) { return LaneOf(hn::Abs(a.v)); }
  friend HWY_INLINE LaneOf sqrt(LaneOf a) { return LaneOf(hn::Sqrt(a.v)); }
};

using Plain = float;  // the type float in files that define `float` as Lane
using LaneTag = hn::CappedTag<float, 16>;
using LaneVector = hn::Vec<LaneTag>;
using Lane = LaneOf<LaneTag>;
using Bool = BoolOf<LaneTag>;
HWY_INLINE Lane select(Bool c, Lane a, Lane b) { return Lane(hn::IfThenElse(c.mask, a.v, b.v)); }
/// Returns the common value of the lanes. Precondition: all lanes have the same value.
HWY_INLINE bool of_all(Bool c) { return hn::AllTrue(LaneTag(), c.mask); }

struct vec2 {
  Lane x, y;
};
struct vec4 {
  Lane x, y, z, w;
};

// Lanes of doubles, for source files that compute in double (offsets/fit.inl). Such a file defines
// `double` as WideLane, and each lane holds one triangle.
using PlainDouble = double;  // the type double in files that define `double` as WideLane
using WideTag = hn::CappedTag<double, 8>;
using NarrowTag = hn::Rebind<float, WideTag>;
using Wide = hn::Vec<WideTag>;
using WideLane = LaneOf<WideTag>;
using WideBool = BoolOf<WideTag>;
constexpr int kWide = static_cast<int>(hn::MaxLanes(WideTag()));
HWY_INLINE WideLane select(WideBool c, WideLane a, WideLane b) {
  return WideLane(hn::IfThenElse(c.mask, a.v, b.v));
}
/// Rounds each lane to the nearest float.
HWY_INLINE WideLane nearest(WideLane a) {
  return WideLane(hn::PromoteTo(WideTag(), hn::DemoteTo(NarrowTag(), a.v)));
}

struct dvec3 {
  WideLane x, y, z;
};

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// Defines the macros of kernels for lanes. core/base/glsl_shim.h defines them for scalars.
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
