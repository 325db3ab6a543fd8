// Trees of boxes over triangles, for the enumerations of this folder. Boxes are minima and maxima
// of the coordinates as given, so nothing is rounded.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

struct BoundsTree {
  struct Bounds {
    std::array<double, 3> lo, hi;
  };
  /// The nodes are in preorder: the left child follows its parent, the right one starts where the
  /// left one ends.
  struct Node {
    Bounds bounds;
    std::uint32_t last_triangle = 0;  // the largest index below it
    std::uint32_t first = 0;          // into order
    std::uint32_t count = 0;
    std::uint32_t after = 0;  // the first node that is not below it
  };

  /// The boxes of all triangles of the scene, and no nodes. Precondition: validate() accepts it.
  explicit BoundsTree(const Scene& scene);

  /// Appends the nodes of a binary tree over the triangles first .. first + count - 1, count > 0.
  void add(std::uint32_t first, std::uint32_t count);

  bool is_leaf(std::uint32_t node) const { return nodes[node].after == node + 1; }

  std::vector<Bounds> bounds;  // per triangle
  std::vector<std::uint32_t> order;
  std::vector<Node> nodes;
};

}  // namespace farcull
