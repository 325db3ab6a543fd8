// Pairs are gathered in batches, coordinate by coordinate. All meet the planes of both triangles;
// the few whose planes cross are gathered again, their corners in the order in which they are
// compared along the line, so that the lanes stay full.
#include "verify/filter_lanes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "verify/corner_order.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "verify/filter_lanes.cpp"
#include <hwy/foreach_target.h>

#include "verify/filter_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace filters {

// Pairs whose second corners are fetched ahead; the first ones are mostly those of the pair before.
constexpr std::size_t kAhead = 8;

/// Coordinates of pairs: row 3 k + axis is of corner k of a, row 9 + 3 k + axis of corner k of b.
struct alignas(64) Batch {
  double row[18][kBatch];

  Point point(int corner, int from) const { return {&row[3 * corner][from]}; }
};

HWY_INLINE void gather(const Scene& scene, std::span<const TrianglePair> pairs, std::size_t from,
                       int count, Batch& batch) {
  for (int i = 0; i < count; ++i) {
    const TrianglePair& pair = pairs[from + i];
    prefetch(scene, pairs[std::min(from + i + kAhead, pairs.size() - 1)].b);
    const auto& a = scene.triangles[pair.a];
    const auto& b = scene.triangles[pair.b];
    for (int k = 0; k < 3; ++k) {
      const double* p = scene.vertices[a[k]].data();
      const double* q = scene.vertices[b[k]].data();
      for (int axis = 0; axis < 3; ++axis) {
        batch.row[3 * k + axis][i] = p[axis];
        batch.row[9 + 3 * k + axis][i] = q[axis];
      }
    }
  }
}

/// Fills the lanes beyond `count` with the last pair, and returns the end of the filled ones.
HWY_INLINE int fill_lanes(Batch& batch, int count) {
  const int end = (count + kWide - 1) / kWide * kWide;
  for (auto& row : batch.row) std::fill(row + count, row + end, row[count - 1]);
  return end;
}

/// Pairs whose planes cross, until they fill a batch.
class Crossings {
 public:
  Crossings(double clearance, std::span<Triage> answers)
      : clearance_(clearance), answers_(answers) {}

  /// Pair `i` of a batch, the answer about which belongs at `where`.
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

  /// Answers for all that were added.
  void compare() {
    if (count_ == 0) return;
    const int end = fill_lanes(batch_, count_);
    for (int from = 0; from < end; from += kWide) {
      const OnLine line = compare_on_line<FilterBounds>(
          batch_.point(0, from), batch_.point(1, from), batch_.point(2, from),
          batch_.point(3, from), batch_.point(4, from), batch_.point(5, from));
      // Triangles that miss each other may be within a clearance.
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

/// Which corners are above the other triangle's plane, for each lane.
class CornersAbove {
 public:
  HWY_INLINE explicit CornersAbove(const AgainstPlanes& planes) {
    for (int k = 0; k < 3; ++k) {
      bits_[k] = bits_of(planes.a.value[k] > Real(0.0));
      bits_[3 + k] = bits_of(planes.b.value[k] > Real(0.0));
    }
  }
  HWY_INLINE const CornerOrder& order(int lane) const {
    unsigned above = 0;
    for (int k = 0; k < 6; ++k) above |= (bits_[k] >> lane & 1) << k;
    return kCornerOrders[above];
  }

 private:
  std::array<unsigned, 6> bits_;
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
      for (int i = 0; i < lanes; ++i) {
        answers[begin + from + i] = (apart >> i & 1) ? Triage::no : Triage::unknown;
      }
      unsigned crossing = bits_of(planes.crossing) & ((1u << lanes) - 1);
      if (crossing == 0) continue;
      const CornersAbove above(planes);
      for (; crossing != 0; crossing &= crossing - 1) {
        const int i = std::countr_zero(crossing);
        crossings.add(batch, from + i, above.order(i), begin + from + i);
      }
    }
  }
  crossings.compare();
}

}  // namespace filters

void filter_pairs_on_lanes(const Scene& scene, std::span<const TrianglePair> pairs,
                           double clearance, std::span<Triage> answers) {
  filters::filter_batches(scene, pairs, clearance, answers);
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {
HWY_EXPORT(filter_pairs_on_lanes);

void filter_pairs(const Scene& scene, std::span<const TrianglePair> pairs, double clearance,
                  std::span<Triage> answers) {
  HWY_DYNAMIC_DISPATCH(filter_pairs_on_lanes)(scene, pairs, clearance, answers);
}

}  // namespace farcull
#endif
