// The pairs that a certificate speaks about, in the order in which it speaks about them.
//
// An enumeration of its own: neither core's join, which culling uses, nor CGAL's, nor the tree of
// verify/accounting. It needs what they do not have, a sorted order without storing or sorting all
// pairs: triangle after triangle, each asked for its partners.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// All pairs of triangles that count (of different objects, and of one object where it is `self`)
/// whose closed boxes share a point (touching counts), sorted by (a, b), a < b, each once. Boxes
/// are minima and maxima of the coordinates as given and are only compared, so nothing is rounded.
/// With a clearance > 0 (world units, finite): the pairs whose boxes are not farther apart than
/// that along an axis, by differences in double. Memory O(triangles). Precondition: validate()
/// accepts the scene. It must outlive the object.
class BoxPairs {
 public:
  explicit BoxPairs(const Scene& scene, double clearance = 0);

  /// Replaces `pairs` by the next ones: all partners of the next triangles, until there are at
  /// least `enough` or the scene ends. False, with none, after the last.
  bool next(std::vector<TrianglePair>& pairs, std::size_t enough);

 private:
  struct Bounds {
    std::array<double, 3> lo, hi;
  };
  /// A binary tree over `order_`, its nodes in preorder: the left child follows its parent.
  struct Node {
    Bounds bounds;
    std::uint32_t last_triangle = 0;  // the largest index below it
    std::uint32_t first = 0;          // into order_
    std::uint32_t count = 0;
    std::uint32_t after = 0;  // the first node that is not below it
  };

  bool meet(const Bounds& x, const Bounds& y) const;
  void build(std::uint32_t first, std::uint32_t count);

  const Scene& scene_;
  double clearance_;
  std::vector<Bounds> bounds_;  // per triangle
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::uint32_t object_ = 0;    // of triangle_
  std::uint32_t triangle_ = 0;  // the next to be asked
};

}  // namespace farcull
