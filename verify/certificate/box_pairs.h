// The pairs that a certificate speaks about, in the order in which it speaks about them.
//
// An enumeration of its own: neither core's join, which culling uses, nor CGAL's, nor the tree of
// verify/accounting. It needs what they do not have, a sorted order without storing or sorting all
// pairs: triangle after triangle, each asked for its partners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/bounds_tree.h"

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
  bool meet(const BoundsTree::Bounds& x, const BoundsTree::Bounds& y) const;

  const Scene& scene_;
  double clearance_;
  BoundsTree tree_;
  std::uint32_t object_ = 0;    // of triangle_
  std::uint32_t triangle_ = 0;  // the next to be asked
};

}  // namespace farcull
