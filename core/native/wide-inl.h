// Lanes of doubles, for texts in doubles as core/native/glsl_lanes-inl.h is for kernels in floats:
// `double` stands for WideLane, and each lane is a triangle of its own.
#if defined(FARCULL_NATIVE_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_WIDE_INL_H_
#undef FARCULL_NATIVE_WIDE_INL_H_
#else
#define FARCULL_NATIVE_WIDE_INL_H_
#endif

#include "core/native/glsl_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

using PlainDouble = double;  // where `double` stands for WideLane
using WideTag = hn::CappedTag<double, 8>;
using Wide = hn::Vec<WideTag>;
using WideMask = hn::Mask<WideTag>;
using NarrowTag = hn::Rebind<float, WideTag>;
constexpr int kWide = static_cast<int>(hn::MaxLanes(WideTag()));

/// A truth value for each lane.
struct WideBool {
  HWY_INLINE explicit WideBool(WideMask m) : mask(m) {}
  WideMask mask;
};
HWY_INLINE WideBool operator&&(WideBool a, WideBool b) { return WideBool(hn::And(a.mask, b.mask)); }

struct WideLane {
  WideLane() = default;
  HWY_INLINE WideLane(PlainDouble x) : v(hn::Set(WideTag(), x)) {}  // NOLINT: texts mix in literals
  HWY_INLINE explicit WideLane(Wide x) : v(x) {}
  Wide v;
};
HWY_INLINE WideLane operator-(WideLane a) { return WideLane(hn::Neg(a.v)); }
HWY_INLINE WideLane operator+(WideLane a, WideLane b) { return WideLane(hn::Add(a.v, b.v)); }
HWY_INLINE WideLane operator-(WideLane a, WideLane b) { return WideLane(hn::Sub(a.v, b.v)); }
HWY_INLINE WideLane operator*(WideLane a, WideLane b) { return WideLane(hn::Mul(a.v, b.v)); }
HWY_INLINE WideLane operator/(WideLane a, WideLane b) { return WideLane(hn::Div(a.v, b.v)); }
HWY_INLINE WideBool operator<(WideLane a, WideLane b) { return WideBool(hn::Lt(a.v, b.v)); }
HWY_INLINE WideBool operator>(WideLane a, WideLane b) { return WideBool(hn::Gt(a.v, b.v)); }
HWY_INLINE WideBool operator<=(WideLane a, WideLane b) { return WideBool(hn::Le(a.v, b.v)); }
HWY_INLINE WideBool operator>=(WideLane a, WideLane b) { return WideBool(hn::Ge(a.v, b.v)); }
HWY_INLINE WideLane select(WideBool c, WideLane a, WideLane b) {
  return WideLane(hn::IfThenElse(c.mask, a.v, b.v));
}
// As for Lane: b < a ? b : a and a < b ? b : a.
HWY_INLINE WideLane min(WideLane a, WideLane b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return WideLane(hn::Min(b.v, a.v));
#else
  return select(b < a, b, a);
#endif
}
HWY_INLINE WideLane max(WideLane a, WideLane b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return WideLane(hn::Max(b.v, a.v));
#else
  return select(a < b, b, a);
#endif
}
HWY_INLINE WideLane abs(WideLane a) { return WideLane(hn::Abs(a.v)); }
HWY_INLINE WideLane sqrt(WideLane a) { return WideLane(hn::Sqrt(a.v)); }
/// Rounded to float.
HWY_INLINE WideLane nearest(WideLane a) {
  return WideLane(hn::PromoteTo(WideTag(), hn::DemoteTo(NarrowTag(), a.v)));
}

struct dvec3 {
  WideLane x, y, z;
};

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
