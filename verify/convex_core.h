// Finds *cores* of a closed object: convex polytopes inside the object. Cores give lower bounds of
// penetration depths (verify/penetration.h).
//
// A core is guessed in plain doubles, then proved. For each triangle of the object, a plane divides
// the triangle from the core; bounds of all roundings prove this. So the surface does not meet the
// core. One point of the core is inside the object, which is decided exactly. So the whole core is
// inside.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/box_pairs.h"
#include "verify/inside.h"
#include "verify/separation.h"

namespace farcull {

/// A closed object with a tree of boxes. It is made once and used for all pairs of the object.
class ClosedObject {
 public:
  using Corners = std::array<Vec3, 3>;

  /// surface: the result of doubted_surface_of(); not `open`. pieces: one corner of each connected
  /// piece of the object. Preconditions: the object has triangles; the scene outlives this
  /// ClosedObject.
  ClosedObject(const Scene& scene, std::uint32_t object, Surface surface,
               std::span<const Vec3> pieces);

  const std::vector<Corners>& triangles() const { return triangles_; }  // in the tree's order
  const std::vector<Vec3>& corners() const { return corners_; }         // without repetitions
  const std::vector<Vec3>& pieces() const { return pieces_; }
  const BoundsTree& tree() const { return tree_; }
  const Box& box() const { return box_; }
  double largest() const { return largest_; }  // the largest magnitude of a coordinate
  /// The corners of a core that is nearly the whole object: all corners, moved inward a little.
  /// Empty if this core is not proved: the object is not convex, or the proof would take too long.
  const std::vector<Vec3>& convex() const { return convex_; }
  /// True iff the point is strictly inside, decided exactly.
  bool has(const Vec3& point) const;
  /// True only if the point is proved to be outside. Precondition: the point is not on the surface.
  bool has_not(const Vec3& point) const;
  /// Returns the nearest point of the surface, in plain doubles.
  Vec3 nearest(const Vec3& point) const;

 private:
  const Scene& scene_;
  std::uint32_t object_;
  Surface surface_;
  std::vector<Corners> triangles_;
  std::vector<Vec3> corners_, pieces_, convex_;
  BoundsTree tree_{std::span<const Corners>()};
  Box box_ = Box::empty();
  double largest_ = 0;
};

/// Planes of a core are moved inward by this fraction of the diagonal of the core's region.
inline constexpr double kCoreInward = 1e-10;

/// Returns convex() if not empty, otherwise at most `most` cores of the object within the region.
/// seeds: points around which cores grow. The function adds seeds close to the surface.
std::vector<std::vector<Vec3>> cores_of(const ClosedObject& solid, const Box& region,
                                        std::span<const Vec3> seeds, std::size_t most);

/// True only if the inside of a, moved by the translation, and the inside of b have no common
/// point. False also if rounding errors leave a doubt.
bool separates(const ClosedObject& a, const ClosedObject& b, const Vec3& translation);

}  // namespace farcull
