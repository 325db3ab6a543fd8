// A tree of boxes (box_tree.h) is asked about one triangle after the other, some side by side.
// The pairs of a triangle a are those with b > a, so that pairs in the order of a are in order.
#include "core/pairs/ordered_pairs.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/pairs/grown_box.h"
#include "core/scene/box_join.h"

namespace farcull {
namespace {

/// Bit k: the box overlaps box k of the block.
unsigned overlapping(const WideBoxes& block, const Box& box) {
#ifdef __SSE2__
  std::array<__m128d, 3> lo, hi;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lo[axis] = _mm_set1_pd(box.lo[static_cast<Eigen::Index>(axis)]);
    hi[axis] = _mm_set1_pd(box.hi[static_cast<Eigen::Index>(axis)]);
  }
  unsigned out = 0;
  for (std::size_t k = 0; k < kWide; k += 2) {
    const auto meets = [&](std::size_t axis) {
      return _mm_and_pd(_mm_cmple_pd(_mm_load_pd(&block.column[axis][k]), hi[axis]),
                        _mm_cmpge_pd(_mm_load_pd(&block.column[axis + 3][k]), lo[axis]));
    };
    const __m128d all = _mm_and_pd(_mm_and_pd(meets(0), meets(1)), meets(2));
    out |= static_cast<unsigned>(_mm_movemask_pd(all)) << k;
  }
  return out;
#else
  std::array<std::uint8_t, kWide> meets;
  meets.fill(1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lo = box.lo[static_cast<Eigen::Index>(axis)];
    const double hi = box.hi[static_cast<Eigen::Index>(axis)];
    for (std::size_t k = 0; k < kWide; ++k) {
      meets[k] = static_cast<std::uint8_t>(meets[k] & (block.column[axis][k] <= hi) &
                                           (block.column[axis + 3][k] >= lo));
    }
  }
  unsigned out = 0;
  for (std::size_t k = 0; k < kWide; ++k) out |= static_cast<unsigned>(meets[k]) << k;
  return out;
#endif
}

}  // namespace

OrderedPairs::OrderedPairs(const Scene& scene, double clearance,
                           std::span<const ObjectPair> ignored, unsigned threads)
    : scene_(scene),
      ignored_(scene, ignored),
      threads_(threads),
      owner_(join_owners(scene)),
      boxes_(scene.triangles.size()),
      order_(scene.triangles.size()),
      blocks_(blocks_of_tree(scene.triangles.size())) {
  for (std::uint32_t t = 0; t < boxes_.size(); ++t) boxes_[t] = grown_box(scene, t, clearance);
  spatial_order(boxes_, order_);
  std::vector<Box> leaves(boxes_.size());
  for (std::size_t k = 0; k < leaves.size(); ++k) leaves[k] = boxes_[order_[k]];
  tree_ = make_tree(leaves, blocks_, 0);
  nodes_[0] = boxes_.size();
  for (std::size_t h = 1; h < nodes_.size(); ++h) nodes_[h] = (nodes_[h - 1] + kWide - 1) / kWide;
}

// Returns how many blocks were compared.
std::uint64_t OrderedPairs::append(std::uint32_t a, std::vector<TrianglePair>& out) const {
  struct Node {
    int height;
    std::uint64_t number;
  };
  // A node leaves at most 15 others behind for each level below it.
  std::array<Node, (kWide - 1) * BoxTree::kMostLevels + 1> stack;
  std::size_t size = 0;
  stack[size++] = {tree_.levels, 0};
  const std::size_t begin = out.size();
  std::uint64_t compared = 0;
  for (; size > 0; ++compared) {
    const auto [height, number] = stack[--size];
    const WideBoxes& block = blocks_[tree_.first[static_cast<std::size_t>(height - 1)] + number];
    unsigned meets = overlapping(block, boxes_[a]);
    for (std::uint64_t child = kWide * number; meets != 0; ++child, meets >>= 1) {
      // Missing boxes of a block overlap an infinite one.
      if ((meets & 1) == 0 || child >= nodes_[static_cast<std::size_t>(height - 1)]) continue;
      if (height > 1) {
        stack[size++] = {height - 1, child};
        continue;
      }
      const std::uint32_t b = order_[child];
      if (b > a && owner_[a] != owner_[b] && !ignored_({a, b})) out.push_back({a, b});
    }
  }
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end());
  return compared;
}

void OrderedPairs::next(std::size_t most, std::vector<TrianglePair>& out) {
  out.clear();
  if (at_end()) return;
  const auto left = static_cast<std::uint32_t>(boxes_.size()) - next_;
  const std::uint32_t asked = std::min(triangles_, left);
  struct Part {
    std::vector<TrianglePair> pairs;
    std::uint32_t done = 0;  // triangles whose pairs these are
    std::uint64_t compared = 0;
    bool complete = false;
  };
  std::vector<Part> parts(chunks_for(asked, 16, threads_));
  const std::size_t most_of_part = std::max<std::size_t>(most / parts.size(), 1);
  for_chunks(asked, parts.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Part& part = parts[chunk];
    for (std::size_t k = begin; k < end && part.pairs.size() < most_of_part; ++k, ++part.done)
      part.compared += append(next_ + static_cast<std::uint32_t>(k), part.pairs);
    part.complete = part.done == end - begin;
  });
  // Behind a part that is not complete there would be a gap: those are asked about again.
  bool full = false;
  for (const Part& part : parts) {
    out.insert(out.end(), part.pairs.begin(), part.pairs.end());
    next_ += part.done;
    compared_ += part.compared;
    full = !part.complete;
    if (full) break;
  }
  if (full) {
    triangles_ = std::max<std::uint32_t>(triangles_ / 2, 1);
  } else if (out.size() < most / 4) {
    triangles_ = std::min<std::uint32_t>(triangles_ * 2, 1 << 16);
  }
}

}  // namespace farcull
