#include "core/pairs/run_pairs.h"

#include <algorithm>

namespace farcull {
namespace {

FloatBox bound_of(const BoxBlock& block) {
  FloatBox out{};
  for (std::size_t k = 0; k < 3; ++k) {
    out.lo[k] = std::ranges::min(block.column[k]);
    out.hi[k] = std::ranges::max(block.column[k + 3]);
  }
  return out;
}

}  // namespace

RunTrees::RunTrees(const Runs& runs, std::span<const Box> regions)
    : runs_(&runs), trees_(runs.objects.size()) {
  for (std::uint32_t o = 0; o < trees_.size(); ++o) {
    const std::uint32_t count = regions[o].is_empty() ? 0 : runs.count(o);
    Tree& tree = trees_[o];
    std::size_t below = 0, boxes = count;  // of the level: its first block below, its boxes
    while (boxes > 0) {
      const std::size_t first = blocks_.size(), size = (boxes + 15) / 16;
      blocks_.resize(first + size);
      for (std::size_t k = 0; k < 16 * size; ++k) {
        const FloatBox box = k >= boxes         ? kNowhere
                             : tree.levels == 0 ? runs.bound(o, static_cast<std::uint32_t>(k))
                                                : bound_of(blocks_[below + k]);
        blocks_[first + k / 16].set(k % 16, box);
      }
      tree.first[static_cast<std::size_t>(tree.levels++)] = first;
      if (size == 1) break;
      below = first;
      boxes = size;
    }
  }
}

void fill_vertices(const Scene& scene, std::span<const std::uint32_t> triangles, VertexBlock& out) {
  for (std::uint32_t k = 0; k < kRun; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      out.corner[c][k] = k < triangles.size() ? scene.triangles[triangles[k]][c] : 0;
    }
  }
}

}  // namespace farcull
