// Compiles the filters with the proved bounds. filter_pairs() runs on SIMD lanes: each lane has a
// pair of its own. Every operation rounds once, so the answers are the same as those of
// filter_planes(). The operations on lanes are defined here, since verification shares no code with
// the canvas (core/native) that it checks.
//
// Pairs are gathered in batches, coordinate by coordinate, and compared with the planes of both
// triangles. The few pairs whose triangles cross each other's planes are gathered again, with
// reordered corners, so that all lanes are used. These pairs are compared along the common line of
// the planes.
#include "verify/filter.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "verify/filter_scalars.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "verify/filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

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
/// Bit i of the result is the answer of lane i.
HWY_INLINE unsigned bits_of(Truth a) {
  std::uint8_t bits[8] = {};  // StoreMaskBits() needs one byte, and may write 8
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
// min(a, b) is b < a ? b : a, and max(a, b) is a < b ? b : a, as in std::min() and std::max(), even
// for NaN. On x86, each is one instruction with exchanged operands.
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

/// One corner of each of kWide pairs, in memory as three rows: all x, all y, all z. Each row is
/// aligned. A row begins `stride` numbers after the row before.
template <int stride>
struct PointOf {
  const PlainReal* at = nullptr;
  HWY_INLINE Real x() const { return Real(hn::Load(Tag(), at)); }
  HWY_INLINE Real y() const { return Real(hn::Load(Tag(), at + stride)); }
  HWY_INLINE Real z() const { return Real(hn::Load(Tag(), at + 2 * stride)); }
};

constexpr int kBatch = 64;  // a batch of this size fits into the first-level cache
using Point = PointOf<kBatch>;

#define FAR_FILTER HWY_INLINE
#include "verify/filter_planes.inl"
#undef FAR_FILTER

/// Coordinates of pairs: row 3 k + axis is corner k of a, and row 9 + 3 k + axis is corner k of b.
struct alignas(64) Batch {
  double row[18][kBatch];

  Point point(int corner, int from) const { return {&row[3 * corner][from]}; }
};

HWY_INLINE void gather(const Scene& scene, std::span<const TrianglePair> pairs, std::size_t from,
                       int count, Batch& batch) {
  const auto gather_one = [&](std::uint32_t triangle, int row, int i) {
    for (const std::uint32_t vertex : scene.triangles[triangle]) {
      const double* p = scene.vertices[vertex].data();
      for (int axis = 0; axis < 3; ++axis) batch.row[row++][i] = p[axis];
    }
  };
  bool one = true;  // true if all pairs have the same a
  for (int i = 0; i < count; ++i) one &= pairs[from + i].a == pairs[from].a;
  if (one) {
    gather_one(pairs[from].a, 0, 0);
    for (int row = 0; row < 9; ++row)
      std::fill(batch.row[row] + 1, batch.row[row] + count, batch.row[row][0]);
  }
  const std::size_t last = pairs.size() - 1;
  for (int i = 0; i < count; ++i) {
    const TrianglePair& pair = pairs[from + i];
    // Prefetches vertex indices far ahead, and corners less far ahead.
    __builtin_prefetch(&scene.triangles[pairs[std::min(from + i + 2 * kAhead, last)].b]);
    prefetch(scene, pairs[std::min(from + i + kAhead, last)].b);
    if (!one) gather_one(pair.a, 0, i);
    gather_one(pair.b, 9, i);
  }
}

/// Fills the unused lanes of the last vector with copies of the last pair. Returns their end.
HWY_INLINE int fill_lanes(Batch& batch, int count) {
  const int end = (count + kWide - 1) / kWide * kWide;
  for (auto& row : batch.row) std::fill(row + count, row + end, row[count - 1]);
  return end;
}

/// Collects pairs whose triangles cross each other's planes. When a batch is full, compares its
/// pairs along the common line of the planes.
class Crossings {
 public:
  Crossings(double clearance, std::span<Triage> answers)
      : clearance_(clearance), answers_(answers) {}

  /// Adds pair `i` of a batch. The pair's answer will be in answers[where].
  HWY_INLINE void add(const Batch& batch, int i, const CornerOrder& order, std::size_t where) {
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        batch_.row[3 * k + axis][count_] = batch.row[3 * order.a[k] + axis][i];
        batch_.row[9 + 3 * k + axis][count_] = batch.row[9 + 3 * order.b[k] + axis][i];
      }
    }
    where_[count_++] = where;
    if (count_ == kBatch) compare();
  }

  /// Writes the answers of all pairs that were added.
  void compare() {
    if (count_ == 0) return;
    const int end = fill_lanes(batch_, count_);
    for (int from = 0; from < end; from += kWide) {
      const OnLine line = compare_on_line<FilterBounds>(
          batch_.point(0, from), batch_.point(1, from), batch_.point(2, from),
          batch_.point(3, from), batch_.point(4, from), batch_.point(5, from));
      // Triangles that miss each other may still be within a clearance > 0.
      const unsigned apart = clearance_ == 0 ? bits_of(line.apart) : 0;
      const unsigned meeting = bits_of(line.meeting);
      for (int i = 0; i < std::min(kWide, count_ - from); ++i) {
        answers_[where_[from + i]] = (apart >> i & 1)     ? Triage::no
                                     : (meeting >> i & 1) ? Triage::yes
                                                          : Triage::unknown;
      }
    }
    count_ = 0;
  }

 private:
  double clearance_;
  std::span<Triage> answers_;
  Batch batch_;
  std::array<std::size_t, kBatch> where_;
  int count_ = 0;
};

void filter_batches(const Scene& scene, std::span<const TrianglePair> pairs, double clearance,
                    std::span<Triage> answers) {
  Batch batch;
  Crossings crossings(clearance, answers);
  for (std::size_t begin = 0; begin < pairs.size(); begin += kBatch) {
    const int count = static_cast<int>(std::min<std::size_t>(kBatch, pairs.size() - begin));
    gather(scene, pairs, begin, count, batch);
    const int end = fill_lanes(batch, count);
    for (int from = 0; from < end; from += kWide) {
      const Point a[3] = {batch.point(0, from), batch.point(1, from), batch.point(2, from)};
      const Point b[3] = {batch.point(3, from), batch.point(4, from), batch.point(5, from)};
      const AgainstPlanes planes = against_planes<FilterBounds>(a, b, clearance);
      const int lanes = std::min(kWide, count - from);
      const unsigned apart = bits_of(planes.apart);
      for (int i = 0; i < lanes; ++i)
        answers[begin + from + i] = (apart >> i & 1) ? Triage::no : Triage::unknown;
      unsigned crossing = bits_of(planes.crossing) & ((1u << lanes) - 1);
      if (crossing == 0) continue;
      std::array<unsigned, 6> above;  // bit i: the corner is above the other plane in lane i
      for (int k = 0; k < 3; ++k) {
        above[k] = bits_of(planes.a.value[k] > Real(0.0));
        above[3 + k] = bits_of(planes.b.value[k] > Real(0.0));
      }
      for (; crossing != 0; crossing &= crossing - 1) {
        const int i = std::countr_zero(crossing);
        unsigned corners = 0;
        for (int k = 0; k < 6; ++k) corners |= (above[k] >> i & 1) << k;
        crossings.add(batch, from + i, kCornerOrders[corners], begin + from + i);
      }
    }
  }
  crossings.compare();
}

}  // namespace filters

using filters::filter_batches;

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

Triage filter_planes(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  return filters::filter_planes<FilterBounds>(a, b, clearance);
}

Triage filter_beyond_vertex(const Vec3& v, const Vec3& a1, const Vec3& a2, const Vec3& b1,
                            const Vec3& b2) {
  return filters::filter_beyond_vertex<FilterBounds>(v, a1, a2, b1, b2);
}

Triage filter_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  return filters::filter_beyond_edge<FilterBounds>(p, q, r, s);
}

Triage filter_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  return filters::filter_within<FilterBounds>(a, b, clearance);
}

HWY_EXPORT(filter_batches);

void filter_pairs(const Scene& scene, std::span<const TrianglePair> pairs, double clearance,
                  std::span<Triage> answers) {
  HWY_DYNAMIC_DISPATCH(filter_batches)(scene, pairs, clearance, answers);
}

}  // namespace farcull
#endif
