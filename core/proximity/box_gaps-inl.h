// The gaps of one box from sixteen others, on lanes.
#if defined(FARCULL_PROXIMITY_BOX_GAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_PROXIMITY_BOX_GAPS_INL_H_
#undef FARCULL_PROXIMITY_BOX_GAPS_INL_H_
#else
#define FARCULL_PROXIMITY_BOX_GAPS_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>

#include "core/pairs/box_tree.h"
#include "core/proximity/triangle_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE::proximity {

using Gaps = std::array<double, kWide>;

/// A box in all lanes.
struct OneBox {
  Number x0, y0, z0, x1, y1, z1;

  HWY_INLINE OneBox(const WideBoxes& block, std::size_t lane)
      : x0(number(block.column[0][lane])),
        y0(number(block.column[1][lane])),
        z0(number(block.column[2][lane])),
        x1(number(block.column[3][lane])),
        y1(number(block.column[4][lane])),
        z1(number(block.column[5][lane])) {}
  HWY_INLINE explicit OneBox(const Box& box)
      : x0(number(box.lo[0])),
        y0(number(box.lo[1])),
        z0(number(box.lo[2])),
        x1(number(box.hi[0])),
        y1(number(box.hi[1])),
        z1(number(box.hi[2])) {}
};

/// The squared gaps from a box to those of a block; returns which are at most `square_limit`,
/// as bits.
HWY_INLINE std::uint32_t near_boxes(const WideBoxes& block, const OneBox& box, double square_limit,
                                    Gaps& squares) {
  const Numbers n;
  const Number zero = number(0), most = number(square_limit);
  const auto gap = [&](std::size_t axis, std::size_t from, Number lo, Number hi) {
    const Number x0 = hn::Load(n, &block.column[axis][from]);
    const Number x1 = hn::Load(n, &block.column[axis + 3][from]);
    const Number g = hn::Max(hn::Max(hn::Sub(x0, hi), hn::Sub(lo, x1)), zero);
    return hn::Mul(g, g);
  };
  std::uint32_t out = 0;
  for (std::size_t from = 0; from < kWide; from += kLanes) {
    const Number square =
        hn::Add(hn::Add(gap(0, from, box.x0, box.x1), gap(1, from, box.y0, box.y1)),
                gap(2, from, box.z0, box.z1));
    hn::Store(square, n, &squares[from]);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(n, hn::Le(square, most), bytes);
    out |= static_cast<std::uint32_t>(bytes[0]) << from;
  }
  return out;
}

/// The lowest bit, which is taken away. Precondition: there is one.
HWY_INLINE std::size_t next_bit(std::uint32_t& bits) {
  const auto bit = static_cast<std::size_t>(std::countr_zero(bits));
  bits &= bits - 1;
  return bit;
}

}  // namespace farcull::HWY_NAMESPACE::proximity
HWY_AFTER_NAMESPACE();

#endif
