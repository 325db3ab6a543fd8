// Trees of boxes are built from the leaves up: each level is a row of blocks, and the box of a
// block is a box of the next level.
#include "core/proximity/box_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace farcull {
namespace {

// The lower 21 bits of x, two zeros before each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

std::size_t wide(std::size_t n) { return (n + kWide - 1) / kWide; }

}  // namespace

std::size_t blocks_of_tree(std::size_t leaves) {
  if (leaves == 0) return 0;
  std::size_t level = wide(leaves), out = level;
  while (level > 1) {
    level = wide(level);
    out += level;
  }
  return out;
}

BoxTree make_tree(std::span<const Box> leaves, std::span<WideBoxes> blocks, std::size_t at) {
  BoxTree out;
  if (leaves.empty()) return out;
  for (const Box& box : leaves) out.box.add(box);
  std::vector<Box> boxes(leaves.begin(), leaves.end());
  while (boxes.size() > 1 || out.levels == 0) {
    const std::size_t n = wide(boxes.size());
    for (std::size_t block = 0; block < n; ++block) {
      blocks[at + block].clear();
      Box all = Box::empty();
      const std::size_t end = std::min(boxes.size() - kWide * block, std::size_t{kWide});
      for (std::size_t k = 0; k < end; ++k) {
        const Box& box = boxes[kWide * block + k];
        blocks[at + block].set(k, box);
        all.add(box);
      }
      boxes[block] = all;
    }
    boxes.resize(n);
    out.first[static_cast<std::size_t>(out.levels++)] = at;
    at += n;
  }
  return out;
}

void morton_order(std::span<const Box> boxes, const Box& all, std::span<std::uint32_t> order) {
  constexpr double kMost = (1 << 21) - 1;
  // A cube, so that cells are as long as wide. By halves, which cannot be infinite.
  const double size = (0.5 * all.hi - 0.5 * all.lo).maxCoeff();
  std::vector<std::pair<std::uint64_t, std::uint32_t>> coded(boxes.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = 0.5 * boxes[k].lo[axis] + 0.5 * boxes[k].hi[axis];
      const double place = size > 0 ? (0.5 * middle - 0.5 * all.lo[axis]) / size : 0;
      code |= spread(static_cast<std::uint64_t>(std::clamp(place * kMost, 0.0, kMost))) << axis;
    }
    coded[k] = {code, static_cast<std::uint32_t>(k)};
  }
  std::ranges::sort(coded);
  for (std::size_t k = 0; k < coded.size(); ++k) order[k] = coded[k].second;
}

}  // namespace farcull
