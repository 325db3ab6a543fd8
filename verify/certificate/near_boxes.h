// The pairs of triangles of two objects that may be within some distance, by their boxes: for the
// checker of distances. An enumeration of its own, as box_pairs.h is; it shares no code with
// core/proximity, which culls.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/bounds_tree.h"

namespace farcull {

/// Whether two boxes are farther apart than a length, in doubles whose rounding is bounded.
class FarBoxes {
 public:
  /// length: world units, >= 0, may be infinite.
  explicit FarBoxes(double length);
  /// True only if each point of one box is farther than the length from each of the other.
  bool proved(const BoundsTree::Bounds& x, const BoundsTree::Bounds& y) const;

 private:
  double length_;
  double scale_ = 1;    // a power of two
  double squared_ = 0;  // above (length * scale)^2
};

/// Precondition: validate() accepts the scene. It must outlive the object.
class NearBoxes {
 public:
  explicit NearBoxes(const Scene& scene);

  /// Begins with the objects a <= b. length: world units, >= 0, may be infinite.
  void ask(std::uint32_t a, std::uint32_t b, double length);

  /// Appends pairs of triangles, one of each object, or any two of the object that both are; in no
  /// order, until there are at least `enough` or no more. Among all that are appended since ask()
  /// each pair whose boxes are not proved to be farther apart than the length is there once. False
  /// when none is left.
  bool next(std::vector<TrianglePair>& pairs, std::size_t enough);

 private:
  const Scene& scene_;
  BoundsTree tree_;
  std::vector<std::uint32_t> roots_;  // by object; of one without triangles none
  FarBoxes far_{0};
  std::vector<std::array<std::uint32_t, 2>> open_;  // pairs of nodes still to be looked into
};

}  // namespace farcull
