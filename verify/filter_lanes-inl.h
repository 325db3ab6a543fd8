// The text of filter_planes.inl on lanes of doubles: each lane is a pair of its own, and every
// operation rounds once, so that the answers are those of the scalars. The verification has its own
// few operations on lanes, since it shares no code with the canvas (core/native) that it checks.
#if defined(FARCULL_VERIFY_FILTER_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_VERIFY_FILTER_LANES_INL_H_
#undef FARCULL_VERIFY_FILTER_LANES_INL_H_
#else
#define FARCULL_VERIFY_FILTER_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "verify/filter_bounds.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace filters {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
constexpr int kWide = static_cast<int>(hn::MaxLanes(Tag()));
using PlainReal = double;

struct Truth {
  HWY_INLINE explicit Truth(hn::Mask<Tag> m) : mask(m) {}
  hn::Mask<Tag> mask;
};
HWY_INLINE Truth operator&&(Truth a, Truth b) { return Truth(hn::And(a.mask, b.mask)); }
HWY_INLINE Truth operator||(Truth a, Truth b) { return Truth(hn::Or(a.mask, b.mask)); }
HWY_INLINE Truth operator!(Truth a) { return Truth(hn::Not(a.mask)); }
HWY_INLINE bool of_all(Truth a) { return hn::AllTrue(Tag(), a.mask); }
/// Bit i: the answer of lane i.
HWY_INLINE unsigned bits_of(Truth a) {
  std::uint8_t bits[8] = {};  // StoreMaskBits() writes one, and may write 8
  hn::StoreMaskBits(Tag(), a.mask, bits);
  return bits[0] & ((1u << kWide) - 1);
}

struct Real {
  HWY_INLINE Real(PlainReal x) : v(hn::Set(Tag(), x)) {}  // NOLINT: the text mixes in literals
  HWY_INLINE explicit Real(hn::Vec<Tag> x) : v(x) {}
  hn::Vec<Tag> v;
};
HWY_INLINE Real operator-(Real a) { return Real(hn::Neg(a.v)); }
HWY_INLINE Real operator+(Real a, Real b) { return Real(hn::Add(a.v, b.v)); }
HWY_INLINE Real operator-(Real a, Real b) { return Real(hn::Sub(a.v, b.v)); }
HWY_INLINE Real operator*(Real a, Real b) { return Real(hn::Mul(a.v, b.v)); }
HWY_INLINE Truth operator<(Real a, Real b) { return Truth(hn::Lt(a.v, b.v)); }
HWY_INLINE Truth operator>(Real a, Real b) { return Truth(hn::Gt(a.v, b.v)); }
// b < a ? b : a and a < b ? b : a, as std::min() and std::max() choose, NaNs included: on x86 that
// is one instruction with the operands exchanged.
HWY_INLINE Real min(Real a, Real b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return Real(hn::Min(b.v, a.v));
#else
  return Real(hn::IfThenElse(hn::Lt(b.v, a.v), b.v, a.v));
#endif
}
HWY_INLINE Real max(Real a, Real b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return Real(hn::Max(b.v, a.v));
#else
  return Real(hn::IfThenElse(hn::Lt(a.v, b.v), b.v, a.v));
#endif
}
HWY_INLINE Real abs(Real a) { return Real(hn::Abs(a.v)); }
HWY_INLINE Real sqrt(Real a) { return Real(hn::Sqrt(a.v)); }

/// A corner of kWide pairs in memory: each coordinate of all of them, aligned, the coordinates
/// `stride` apart.
template <int stride>
struct PointOf {
  const PlainReal* at = nullptr;
  HWY_INLINE Real x() const { return Real(hn::Load(Tag(), at)); }
  HWY_INLINE Real y() const { return Real(hn::Load(Tag(), at + stride)); }
  HWY_INLINE Real z() const { return Real(hn::Load(Tag(), at + 2 * stride)); }
};

constexpr int kBatch = 64;  // pairs whose corners lie in the fastest cache
using Point = PointOf<kBatch>;

#define FAR_FILTER HWY_INLINE
#include "verify/filter_planes.inl"
#undef FAR_FILTER

}  // namespace filters
}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
