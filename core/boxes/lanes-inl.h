// Compares one box with the sixteen boxes of a block, or with the boxes of a tree, by vector
// instructions. Compiled once for each instruction set (hwy/foreach_target.h).
#if defined(FARCULL_BOXES_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_BOXES_LANES_INL_H_
#undef FARCULL_BOXES_LANES_INL_H_
#else
#define FARCULL_BOXES_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>

#include "core/boxes/block.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE::boxes {

namespace hn = hwy::HWY_NAMESPACE;
template <class Number>
using Tag = hn::CappedTag<Number, kWide>;
template <class Number>
using Vector = hn::Vec<Tag<Number>>;
template <class Number>
constexpr std::size_t kLanes = hn::MaxLanes(Tag<Number>());

/// One box, with each coordinate copied to all lanes of a vector.
template <class Number>
struct OneBox {
  Vector<Number> x0, y0, z0, x1, y1, z1;

  HWY_INLINE OneBox(const WideBoxes<Number>& block, std::size_t lane)
      : OneBox(block.column[0][lane], block.column[1][lane], block.column[2][lane],
               block.column[3][lane], block.column[4][lane], block.column[5][lane]) {}
  HWY_INLINE explicit OneBox(const BoxOf<Number>& box)
      : OneBox(box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]) {}

 private:
  HWY_INLINE OneBox(Number ax, Number ay, Number az, Number bx, Number by, Number bz)
      : x0(hn::Set(Tag<Number>(), ax)),
        y0(hn::Set(Tag<Number>(), ay)),
        z0(hn::Set(Tag<Number>(), az)),
        x1(hn::Set(Tag<Number>(), bx)),
        y1(hn::Set(Tag<Number>(), by)),
        z1(hn::Set(Tag<Number>(), bz)) {}
};

template <class Number>
HWY_INLINE Vector<Number> column(const WideBoxes<Number>& block, std::size_t k, std::size_t from) {
  return hn::Load(Tag<Number>(), &block.column[k][from]);
}

/// Returns a mask of the block's boxes, from lane `from` on, that overlap or touch the box.
template <class Number>
HWY_INLINE hn::Mask<Tag<Number>> overlapping(const WideBoxes<Number>& block, std::size_t from,
                                             const OneBox<Number>& box) {
  const auto x =
      hn::And(hn::Le(column(block, 0, from), box.x1), hn::Ge(column(block, 3, from), box.x0));
  const auto y =
      hn::And(hn::Le(column(block, 1, from), box.y1), hn::Ge(column(block, 4, from), box.y0));
  const auto z =
      hn::And(hn::Le(column(block, 2, from), box.z1), hn::Ge(column(block, 5, from), box.z0));
  return hn::And(hn::And(x, y), z);
}

/// Returns a mask like overlapping(), but without the boxes that only touch the box.
template <class Number>
HWY_INLINE hn::Mask<Tag<Number>> overlapping_inside(const WideBoxes<Number>& block,
                                                    std::size_t from, const OneBox<Number>& box) {
  const auto along = [&](std::size_t axis, Vector<Number> lo, Vector<Number> hi) {
    return hn::And(hn::Lt(column(block, axis, from), hi),
                   hn::Gt(column(block, axis + 3, from), lo));
  };
  return hn::And(hn::And(along(0, box.x0, box.x1), along(1, box.y0, box.y1)),
                 along(2, box.z0, box.z1));
}

/// Returns the mask as bits, one for each lane.
template <class D>
HWY_INLINE std::uint32_t bits_of(D tag, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(tag, mask, bytes);
  return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8);
}

/// Returns overlapping() for all sixteen boxes of the block, one bit for each box.
template <class Number>
HWY_INLINE std::uint32_t overlapping_bits(const WideBoxes<Number>& block,
                                          const OneBox<Number>& box) {
  std::uint32_t out = 0;
  for (std::size_t from = 0; from < kWide; from += kLanes<Number>)
    out |= bits_of(Tag<Number>(), overlapping(block, from, box)) << from;
  return out;
}

using Gaps = std::array<double, kWide>;

/// Sets squares[k] to the squared distance between a box and box k of a block. Bit k of the result
/// is set if squares[k] <= square_limit.
HWY_INLINE std::uint32_t near_boxes(const WideBoxes<double>& block, const OneBox<double>& box,
                                    double square_limit, Gaps& squares) {
  const Tag<double> n;
  const auto zero = hn::Set(n, 0), most = hn::Set(n, square_limit);
  const auto gap = [&](std::size_t axis, std::size_t from, Vector<double> lo, Vector<double> hi) {
    const auto g = hn::Max(
        hn::Max(hn::Sub(column(block, axis, from), hi), hn::Sub(lo, column(block, axis + 3, from))),
        zero);
    return hn::Mul(g, g);
  };
  std::uint32_t out = 0;
  for (std::size_t from = 0; from < kWide; from += kLanes<double>) {
    const auto square = hn::Add(hn::Add(gap(0, from, box.x0, box.x1), gap(1, from, box.y0, box.y1)),
                                gap(2, from, box.z0, box.z1));
    hn::Store(square, n, &squares[from]);
    out |= bits_of(n, hn::Le(square, most)) << from;
  }
  return out;
}

/// Clears the lowest set bit of `bits` and returns its index. Precondition: bits != 0.
HWY_INLINE std::uint32_t next_bit(std::uint32_t& bits) {
  const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
  bits &= bits - 1;
  return bit;
}

/// Searches a tree, and calls visit(leaf) for each leaf >= `least` that the search reaches, in a
/// fixed order. Bit i of bits_of_block(k) tells whether to search child i of block k. Returns how
/// many blocks were examined.
template <class Number, class Bits, class Visit>
HWY_INLINE std::uint64_t for_leaves(const BoxTree<Number>& tree, std::uint32_t least,
                                    const Bits& bits_of_block, const Visit& visit) {
  struct Node {
    int height;
    std::uint32_t number;
  };
  // At most 15 nodes of each level wait on the stack: the siblings of a node on the current path.
  Node stack[(kWide - 1) * kMostLevels + 1];
  int size = 0;
  if (tree.levels > 0) stack[size++] = {tree.levels, 0};
  std::uint64_t compared = 0;
  for (; size > 0; ++compared) {
    const Node at = stack[--size];
    const int below = at.height - 1;
    std::uint32_t bits = bits_of_block(tree.first[static_cast<std::size_t>(below)] + at.number);
    while (bits != 0) {
      const std::uint32_t child = kWide * at.number + next_bit(bits);
      const std::uint64_t begin = std::uint64_t{child} << (4 * below);
      const std::uint64_t end = (std::uint64_t{child} + 1) << (4 * below);
      // Skips leaves before `least`. Skips unused places: an infinite box overlaps an empty box.
      if (end <= least || begin >= tree.leaves) continue;
      if (below == 0) {
        visit(child);
      } else {
        stack[size++] = {below, child};
      }
    }
  }
  return compared;
}

/// Calls visit(leaf) for each leaf >= `least` that overlaps `box`. Returns how many blocks were
/// compared with `box`.
template <class Number, class Visit>
HWY_INLINE std::uint64_t for_overlapping_leaves(const BoxTree<Number>& tree,
                                                const WideBoxes<Number>* blocks,
                                                const OneBox<Number>& box, std::uint32_t least,
                                                const Visit& visit) {
  return for_leaves(
      tree, least, [&](std::size_t block) { return overlapping_bits(blocks[block], box); }, visit);
}

}  // namespace farcull::HWY_NAMESPACE::boxes
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
