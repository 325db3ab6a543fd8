// Boxes of runs and of their triangles on the lanes of this processor. Only comparisons decide, so
// every instruction set gives the same pairs in the same order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/pairs/run_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>

#include "core/pairs/run_pairs.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Numbers = hn::CappedTag<float, 16>;
using Words = hn::RebindToUnsigned<Numbers>;
using Mask = hn::Mask<Numbers>;
using WordMask = hn::Mask<Words>;
constexpr std::size_t kLanes = hn::MaxLanes(Numbers());
static_assert(16 % kLanes == 0);

/// A box in all lanes.
struct OneBox {
  hn::Vec<Numbers> x0, y0, z0, x1, y1, z1;

  HWY_INLINE OneBox(const BoxBlock& block, std::size_t lane)
      : OneBox(block.column[0][lane], block.column[1][lane], block.column[2][lane],
               block.column[3][lane], block.column[4][lane], block.column[5][lane]) {}
  HWY_INLINE explicit OneBox(const FloatBox& box)
      : OneBox(box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]) {}

 private:
  HWY_INLINE OneBox(float ax, float ay, float az, float bx, float by, float bz)
      : x0(hn::Set(Numbers(), ax)),
        y0(hn::Set(Numbers(), ay)),
        z0(hn::Set(Numbers(), az)),
        x1(hn::Set(Numbers(), bx)),
        y1(hn::Set(Numbers(), by)),
        z1(hn::Set(Numbers(), bz)) {}
};

HWY_INLINE hn::Vec<Numbers> column(const BoxBlock& block, std::size_t k, std::size_t from) {
  return hn::Load(Numbers(), &block.column[k][from]);
}

// Boxes of the block, from lane `from` on, that overlap the box; touching counts.
HWY_INLINE Mask overlapping(const BoxBlock& block, std::size_t from, const OneBox& box) {
  const Mask x =
      hn::And(hn::Le(column(block, 0, from), box.x1), hn::Ge(column(block, 3, from), box.x0));
  const Mask y =
      hn::And(hn::Le(column(block, 1, from), box.y1), hn::Ge(column(block, 4, from), box.y0));
  const Mask z =
      hn::And(hn::Le(column(block, 2, from), box.z1), hn::Ge(column(block, 5, from), box.z0));
  return hn::And(hn::And(x, y), z);
}
// The same where touching does not count.
HWY_INLINE Mask overlapping_inside(const BoxBlock& block, std::size_t from, const OneBox& box) {
  const Mask x =
      hn::And(hn::Lt(column(block, 0, from), box.x1), hn::Gt(column(block, 3, from), box.x0));
  const Mask y =
      hn::And(hn::Lt(column(block, 1, from), box.y1), hn::Gt(column(block, 4, from), box.y0));
  const Mask z =
      hn::And(hn::Lt(column(block, 2, from), box.z1), hn::Gt(column(block, 5, from), box.z0));
  return hn::And(hn::And(x, y), z);
}
// All sixteen as bits.
HWY_INLINE std::uint32_t overlapping_bits(const BoxBlock& block, const OneBox& box) {
  std::uint32_t out = 0;
  for (std::size_t from = 0; from < 16; from += kLanes) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Numbers(), overlapping(block, from, box), bytes);
    out |= static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8) << from;
  }
  return out;
}

// The runs of object b that meet the box of one run of a.
class Query {
 public:
  HWY_INLINE Query(const RunTrees& trees, std::uint32_t b, const OneBox& box, std::uint32_t least)
      : trees_(trees), tree_(trees.tree(b)), box_(box), least_(least) {}

  // Calls visit(run) for each run of b, counted from 0 within b, whose box overlaps. Runs before
  // `least_` are left out.
  template <class Visit>
  HWY_INLINE void for_each_run(const Visit& visit) const {
    struct Place {
      int level;
      std::uint32_t block;
    };
    Place stack[16 * RunTrees::kMostLevels];
    int size = 0;
    stack[size++] = {tree_.levels - 1, 0};
    while (size > 0) {
      const Place at = stack[--size];
      const std::size_t level = static_cast<std::size_t>(at.level);
      std::uint32_t bits = overlapping_bits(trees_.blocks()[tree_.first[level] + at.block], box_);
      for (; bits != 0; bits &= bits - 1) {
        const std::uint32_t child =
            16 * at.block + static_cast<std::uint32_t>(std::countr_zero(bits));
        const std::uint64_t behind = (std::uint64_t{child} + 1) << (4 * level);
        if (behind <= least_) continue;
        if (level == 0) {
          visit(child);
        } else {
          stack[size++] = {at.level - 1, child};
        }
      }
    }
  }

 private:
  const RunTrees& trees_;
  const RunTrees::Tree& tree_;
  const OneBox& box_;
  std::uint32_t least_;
};

// Compares the triangles of two blocks.
class Comparison {
 public:
  // vertices: of the two, or null where neighbours stay.
  HWY_INLINE Comparison(const RunBlock& a, const RunBlock& b, const VertexBlock* a_vertices,
                        const VertexBlock* b_vertices)
      : a_(a), b_(b), a_vertices_(a_vertices), b_vertices_(b_vertices) {}

  // Writes to `certain` and `perhaps`, which have room for 272 pairs each.
  HWY_INLINE void write(TrianglePair*& certain, TrianglePair*& perhaps) const {
    const OneBox bound(b_.bound);
    for (std::uint32_t rows = overlapping_bits(a_.boxes, bound); rows != 0; rows &= rows - 1) {
      write_row(static_cast<std::size_t>(std::countr_zero(rows)), certain, perhaps);
    }
  }

 private:
  HWY_INLINE void write_row(std::size_t row, TrianglePair*& certain, TrianglePair*& perhaps) const {
    const OneBox box(a_.boxes, row);
    const bool same = &a_ == &b_;
    for (std::size_t from = same ? row / kLanes * kLanes : 0; from < 16; from += kLanes) {
      WordMask met = hn::RebindMask(Words(), overlapping(b_.boxes, from, box));
      if (same) met = hn::And(met, behind(row, from));
      if (hn::AllFalse(Words(), met)) continue;
      if (a_vertices_ != nullptr) {
        met = hn::And(met, hn::Not(neighbours(row, from)));
        if (hn::AllFalse(Words(), met)) continue;
      }
      const WordMask inside = hn::RebindMask(Words(), overlapping_inside(b_.boxes, from, box));
      put(row, from, hn::And(met, inside), certain);
      const WordMask touching = hn::And(met, hn::Not(inside));
      if (!hn::AllFalse(Words(), touching)) put(row, from, touching, perhaps);
    }
  }
  // Lanes of the block that stand behind the row.
  HWY_INLINE WordMask behind(std::size_t row, std::size_t from) const {
    return hn::Gt(hn::Iota(Words(), static_cast<std::uint32_t>(from)),
                  hn::Set(Words(), static_cast<std::uint32_t>(row)));
  }
  HWY_INLINE WordMask neighbours(std::size_t row, std::size_t from) const {
    const Words w;
    const auto p = hn::Load(w, &b_vertices_->corner[0][from]),
               q = hn::Load(w, &b_vertices_->corner[1][from]),
               r = hn::Load(w, &b_vertices_->corner[2][from]);
    const auto has = [&](std::size_t corner) {
      const auto v = hn::Set(w, a_vertices_->corner[corner][row]);
      return hn::Or(hn::Or(hn::Eq(p, v), hn::Eq(q, v)), hn::Eq(r, v));
    };
    return hn::Or(hn::Or(has(0), has(1)), has(2));
  }
  HWY_INLINE void put(std::size_t row, std::size_t from, WordMask mask, TrianglePair*& out) const {
    const Words w;
    const auto one = hn::Set(w, a_.triangles[row]);
    const auto others = hn::Compress(hn::Load(w, &b_.triangles[from]), mask);
    hn::StoreInterleaved2(hn::Min(one, others), hn::Max(one, others), w, &out->a);
    out += hn::CountTrue(w, mask);
  }

  const RunBlock& a_;
  const RunBlock& b_;
  const VertexBlock* a_vertices_;
  const VertexBlock* b_vertices_;
};

}  // namespace

void pair_runs_here(const RunTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
                    std::uint32_t to, std::size_t most, std::vector<RunPair>& out) {
  if (trees.tree(b).levels == 0) return;
  const std::uint32_t first_a = trees.first_run(a), first_b = trees.first_run(b);
  for (std::uint32_t run = from; run < to && out.size() <= most; ++run) {
    const std::uint32_t own = run - first_a;
    const BoxBlock& block = trees.blocks()[trees.tree(a).first[0] + own / 16];
    const OneBox box(block, own % 16);
    Query(trees, b, box, a == b ? own : 0).for_each_run([&](std::uint32_t other) {
      out.push_back({run, first_b + other});
    });
  }
}

void compare_blocks_here(const BlockSpans& blocks, std::span<const VertexBlock> vertices,
                         std::span<const BlockPair> pairs, RunFindings& out) {
  constexpr std::size_t kRoom = 17 * 16, kFlush = 4096;
  std::vector<TrianglePair> certain(kFlush + kRoom), perhaps(kFlush + kRoom);
  TrianglePair *next = certain.data(), *next_perhaps = perhaps.data();
  const auto flush = [](std::vector<TrianglePair>& from, TrianglePair*& end, std::size_t least,
                        std::vector<TrianglePair>& to) {
    if (static_cast<std::size_t>(end - from.data()) < least) return;
    to.insert(to.end(), from.data(), end);
    end = from.data();
  };
  for (const BlockPair& pair : pairs) {
    const bool drops = pair.drops_neighbours;
    Comparison(blocks[pair.a], blocks[pair.b], drops ? &vertices[pair.a] : nullptr,
               drops ? &vertices[pair.b] : nullptr)
        .write(next, next_perhaps);
    flush(certain, next, kFlush, out.certain);
    flush(perhaps, next_perhaps, kFlush, out.perhaps);
  }
  flush(certain, next, 0, out.certain);
  flush(perhaps, next_perhaps, 0, out.perhaps);
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(pair_runs_here);
HWY_EXPORT(compare_blocks_here);

void pair_runs(const RunTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
               std::uint32_t to, std::size_t most, std::vector<RunPair>& out) {
  HWY_DYNAMIC_DISPATCH(pair_runs_here)(trees, a, b, from, to, most, out);
}
void compare_blocks(const BlockSpans& blocks, std::span<const VertexBlock> vertices,
                    std::span<const BlockPair> pairs, RunFindings& out) {
  HWY_DYNAMIC_DISPATCH(compare_blocks_here)(blocks, vertices, pairs, out);
}

}  // namespace farcull
#endif
