// Trees of boxes, sixteen children a node, with the corners of the boxes as columns, so that one
// box is compared with sixteen at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/scene/scene.h"

namespace farcull {

constexpr std::uint32_t kWide = 16;

/// Sixteen boxes. A missing one is infinitely far from any other.
struct alignas(64) WideBoxes {
  std::array<std::array<double, kWide>, 6> column;  // x0, y0, z0, x1, y1, z1

  void clear() {
    for (std::size_t k = 0; k < 3; ++k) {
      column[k].fill(std::numeric_limits<double>::infinity());
      column[k + 3].fill(-std::numeric_limits<double>::infinity());
    }
  }
  void set(std::size_t lane, const Box& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      column[k][lane] = box.lo[static_cast<Eigen::Index>(k)];
      column[k + 3][lane] = box.hi[static_cast<Eigen::Index>(k)];
    }
  }
  Box get(std::size_t lane) const {
    return {{column[0][lane], column[1][lane], column[2][lane]},
            {column[3][lane], column[4][lane], column[5][lane]}};
  }
};

/// A tree over leaves 0 .. n - 1. A node of height h > 0 and number k holds the nodes of height
/// h - 1 with the numbers 16 k .. 16 k + 15, as far as there are any; their boxes are
/// blocks[first[h - 1] + k]. The root has the height `levels` and the number 0.
struct BoxTree {
  static constexpr int kMostLevels = 8;          // 2^32 leaves
  int levels = 0;                                // 0: no leaf, nothing else is set
  std::array<std::size_t, kMostLevels> first{};  // of each height, into blocks
  Box box = Box::empty();                        // of all leaves
};

/// Blocks of a tree over so many leaves.
std::size_t blocks_of_tree(std::size_t leaves);
/// The tree over the boxes, with its blocks at blocks[at] and behind: blocks_of_tree() of them.
BoxTree make_tree(std::span<const Box> leaves, std::span<WideBoxes> blocks, std::size_t at);

/// An order in which boxes that follow one another lie together, for a tree over them. Each cut
/// puts half of the boxes on either side, wherever they lie, and boxes that
/// reach across most of the others stand before them. So a box far away, or a huge one,
/// spoils no node but those that it is in. Any boxes, also infinite ones. O(n log n).
void spatial_order(std::span<const Box> boxes, std::span<std::uint32_t> order);

}  // namespace farcull
