// Enumerates the pairs of triangles that a certificate covers, in the order of the certificate.
//
// This enumeration shares no code with core's join, CGAL's join or the tree of verify/accounting.
// For each triangle in order, it finds the later triangles that form a pair with this triangle. So
// the pairs come in sorted order, and need not be stored or sorted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/tile.h"

namespace farcull {

/// Trees of boxes over triangles. The bounds of a box are minima and maxima of the given
/// coordinates, so nothing is rounded.
struct BoundsTree {
  struct Bounds {
    std::array<double, 3> lo, hi;
  };
  /// The nodes are in preorder: the left child follows its parent, and the right child follows the
  /// last node below the left child.
  struct Node {
    Bounds bounds;
    std::uint32_t first_triangle = 0;  // least triangle index below the node
    std::uint32_t last_triangle = 0;   // largest triangle index below the node
    std::uint32_t first = 0;           // index into BoundsTree::order
    std::uint32_t count = 0;
    std::uint32_t after = 0;  // index of the first later node that is not below this node
  };

  /// Computes the boxes of all triangles. The nodes are made by add(). Precondition: validate()
  /// accepts the scene.
  explicit BoundsTree(std::span<const std::array<Vec3, 3>> triangles);
  explicit BoundsTree(const Scene& scene);

  static Bounds bounds_of(const std::array<Vec3, 3>& corners);

  /// Appends the nodes of a binary tree over order[first] to order[first + count - 1], count > 0.
  void add(std::uint32_t first, std::uint32_t count);

  bool is_leaf(std::uint32_t node) const { return nodes[node].after == node + 1; }
  std::uint32_t left(std::uint32_t node) const { return node + 1; }
  std::uint32_t right(std::uint32_t node) const { return nodes[node + 1].after; }

  std::vector<Bounds> bounds;  // one per triangle
  std::vector<std::uint32_t> order;
  std::vector<Node> nodes;
};

/// Enumerates the pairs of triangles that count and whose closed boxes overlap, sorted by (a, b)
/// with a < b, each once. A pair counts if its triangles are of different objects, or of one object
/// that is `self`. Boxes overlap if they share a point (touching counts). With a clearance > 0
/// (world units, finite), boxes overlap if no gap along an axis, computed in double, is above the
/// clearance. With a tile, only pairs that belong to the tile are enumerated. Memory O(triangles).
/// Precondition: validate() accepts the scene. The scene must outlive the object.
class BoxPairs {
 public:
  explicit BoxPairs(const Scene& scene, double clearance = 0, const Tile& tile = {});

  /// Replaces `pairs` by the next pairs: at least `enough` pairs, or all remaining pairs. All pairs
  /// (a, b) with the same a come at once. After the last pair, empties `pairs` and returns false.
  bool next(std::vector<TrianglePair>& pairs, std::size_t enough);

 private:
  bool meet(const BoundsTree::Bounds& x, const BoundsTree::Bounds& y) const;

  const Scene& scene_;
  double clearance_;
  Tile tile_;
  BoundsTree tree_;
  std::uint32_t object_ = 0;    // object of triangle_
  std::uint32_t triangle_ = 0;  // next triangle whose partners are sought
};

}  // namespace farcull
