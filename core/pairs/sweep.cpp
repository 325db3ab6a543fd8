// The sweep over the entries of a pixel, on the lanes of this processor. Only comparisons of floats
// and of integers decide, so every instruction set gives the same pairs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/pairs/sweep.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <limits>

#include "core/pairs/sweep.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Numbers = hn::CappedTag<float, kSweepPadding>;
using Words = hn::RebindToUnsigned<Numbers>;
using Mask = hn::Mask<Words>;

HWY_INLINE Mask as_words(hn::Mask<Numbers> mask) { return hn::RebindMask(Words(), mask); }

// Compares entry x with the entries behind it.
class RowOfSweep {
 public:
  HWY_INLINE RowOfSweep(const SweepColumns& columns, std::size_t x, bool drops_neighbours)
      : columns_(columns), drops_neighbours_(drops_neighbours), x_(x) {
    for (std::size_t k = 0; k < 6; ++k) number_[k] = hn::Set(Numbers(), columns.numbers(k)[x]);
    for (std::size_t k = 0; k < 3; ++k) word_[k] = hn::Set(Words(), columns.words(k)[x]);
  }

  // The entries of a vector from y on that begin before the far end of x.
  HWY_INLINE hn::Mask<Numbers> in_reach(std::size_t y) const {
    return hn::Le(number(2, y), number_[5]);
  }
  // The entries of `reach` that meet x and make a pair with it.
  HWY_INLINE Mask met(hn::Mask<Numbers> reach, std::size_t y) const {
    const auto x = hn::And(hn::Ge(number(3, y), number_[0]), hn::Le(number(0, y), number_[3]));
    const auto z = hn::And(reach, hn::Ge(number(5, y), number_[2]));
    const auto h = hn::And(hn::Ge(number(4, y), number_[1]), hn::Le(number(1, y), number_[4]));
    const Mask meets = as_words(hn::And(hn::And(x, h), z));
    const Mask other = hn::Ne(word(1, y), word_[1]);
    const Mask here = hn::Eq(hn::And(word(2, y), word_[2]), hn::Zero(Words()));
    const Mask kept = hn::And(meets, hn::And(other, here));
    if (!drops_neighbours_ || hn::AllFalse(Words(), kept)) return kept;
    return hn::And(kept, hn::Not(neighbours(y)));
  }
  // Writes the pairs of x with the entries of the mask, and returns how many.
  HWY_INLINE std::size_t write(Mask mask, std::size_t y, TrianglePair* out) const {
    const auto others = hn::Compress(word(0, y), mask);
    const auto least = hn::Min(others, word_[0]), most = hn::Max(others, word_[0]);
    hn::StoreInterleaved2(least, most, Words(), &out->a);
    return hn::CountTrue(Words(), mask);
  }

 private:
  HWY_INLINE hn::Vec<Numbers> number(std::size_t column, std::size_t y) const {
    return hn::LoadU(Numbers(), columns_.numbers(column) + y);
  }
  HWY_INLINE hn::Vec<Words> word(std::size_t column, std::size_t y) const {
    return hn::LoadU(Words(), columns_.words(column) + y);
  }
  // The entries with the owner of x that share one of its vertices.
  HWY_INLINE Mask neighbours(std::size_t y) const {
    const auto p = word(4, y), q = word(5, y), r = word(6, y);
    const auto equal = [&](std::size_t corner) {
      const auto vertex = hn::Set(Words(), columns_.words(corner)[x_]);
      return hn::Or(hn::Or(hn::Eq(p, vertex), hn::Eq(q, vertex)), hn::Eq(r, vertex));
    };
    const Mask shared = hn::Or(hn::Or(equal(4), equal(5)), equal(6));
    return hn::And(shared, hn::Eq(word(3, y), hn::Set(Words(), columns_.words(3)[x_])));
  }

  const SweepColumns& columns_;
  bool drops_neighbours_;
  std::size_t x_;
  hn::Vec<Numbers> number_[6];
  hn::Vec<Words> word_[3];
};

}  // namespace

std::size_t sweep(Sweep& state, std::span<TrianglePair> out) {
  static_assert(sizeof(TrianglePair) == 2 * sizeof(std::uint32_t));
  const SweepColumns& columns = *state.columns;
  const std::size_t n = columns.size();
  std::size_t found = 0;
  std::uint64_t tests = 0;
  std::size_t x = state.next;
  for (; x < n && found + (n - x) + kSweepPadding <= out.size(); ++x) {
    const RowOfSweep row(columns, x, state.drops_neighbours);
    for (std::size_t y = x + 1; y < n; y += hn::Lanes(Numbers())) {
      const auto reach = row.in_reach(y);
      if (state.sorted) {
        const std::size_t in_reach = hn::CountTrue(Numbers(), reach);
        tests += in_reach;
        if (in_reach == 0) break;
      }
      const Mask met = row.met(reach, y);
      if (!hn::AllFalse(Words(), met)) found += row.write(met, y, &out[found]);
    }
    if (!state.sorted) tests += n - x - 1;
  }
  state.tests += tests;
  state.next = x;
  return found;
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(sweep);

std::size_t sweep_on(Sweep& state, std::span<TrianglePair> out) {
  return HWY_DYNAMIC_DISPATCH(sweep)(state, out);
}

void SweepColumns::start(std::size_t count) {
  count_ = 0;
  if (stride_ < count + kSweepPadding) {
    stride_ = 2 * count + kSweepPadding;
    numbers_.resize(6 * stride_);
    words_.resize(7 * stride_);
  }
}

namespace {
constexpr float kInf = std::numeric_limits<float>::infinity();
}  // namespace

void SweepColumns::finish() {
  const std::size_t count = count_;
  for (std::size_t k = 0; k < kSweepPadding; ++k) {
    add({kInf, kInf, kInf, -kInf, -kInf, -kInf, 0, 0, 0, 0, 0, 0, 0});
  }
  count_ = count;
}

}  // namespace farcull
#endif
