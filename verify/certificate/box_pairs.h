// Enumerates the pairs of triangles that a certificate is about, in the certificate's order.
//
// This enumeration shares no code with core's join, which culling uses, nor with CGAL's join or the
// tree of verify/accounting. Unlike these it gives the pairs in sorted order without storing or
// sorting all of them: it takes the triangles in order, and finds the partners of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/tile.h"

namespace farcull {

/// Trees of boxes over triangles. Boxes are minima and maxima of the coordinates as given, so
/// nothing is rounded.
struct BoundsTree {
  struct Bounds {
    std::array<double, 3> lo, hi;
  };
  /// The nodes are in preorder: the left child follows its parent, the right one starts where the
  /// left one ends.
  struct Node {
    Bounds bounds;
    std::uint32_t first_triangle = 0;  // the least index below it
    std::uint32_t last_triangle = 0;   // the largest
    std::uint32_t first = 0;           // into order
    std::uint32_t count = 0;
    std::uint32_t after = 0;  // the first node that is not below it
  };

  /// The boxes of these triangles, or of all triangles of the scene, and no nodes. Precondition:
  /// validate() accepts the scene.
  explicit BoundsTree(std::span<const std::array<Vec3, 3>> triangles);
  explicit BoundsTree(const Scene& scene);

  static Bounds bounds_of(const std::array<Vec3, 3>& corners);

  /// Appends the nodes of a binary tree over the triangles first .. first + count - 1, count > 0.
  void add(std::uint32_t first, std::uint32_t count);

  bool is_leaf(std::uint32_t node) const { return nodes[node].after == node + 1; }
  std::uint32_t left(std::uint32_t node) const { return node + 1; }
  std::uint32_t right(std::uint32_t node) const { return nodes[node + 1].after; }

  std::vector<Bounds> bounds;  // per triangle
  std::vector<std::uint32_t> order;
  std::vector<Node> nodes;
};

/// All pairs of triangles that count (of different objects, and of one object where it is `self`)
/// whose closed boxes share a point (touching counts), sorted by (a, b), a < b, each once. Boxes
/// are only compared. With a clearance > 0 (world units, finite): the pairs whose boxes are no
/// farther apart than the clearance along any axis, by differences in double. With a tile: only
/// those of these pairs that belong to it. Memory O(triangles). Precondition: validate() accepts
/// the scene. The scene must outlive the object.
class BoxPairs {
 public:
  explicit BoxPairs(const Scene& scene, double clearance = 0, const Tile& tile = {});

  /// Replaces `pairs` by the next ones: all partners of the next triangles, until there are at
  /// least `enough` or the scene ends. Returns false, with no pairs, after the last pair.
  bool next(std::vector<TrianglePair>& pairs, std::size_t enough);

 private:
  bool meet(const BoundsTree::Bounds& x, const BoundsTree::Bounds& y) const;

  const Scene& scene_;
  double clearance_;
  Tile tile_;
  BoundsTree tree_;
  std::uint32_t object_ = 0;    // of triangle_
  std::uint32_t triangle_ = 0;  // the next one whose partners are sought
};

}  // namespace farcull
