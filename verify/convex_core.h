// Convex sets of points that lie inside a closed object: its *cores*. They give bounds of
// penetration depths (verify/penetration.h).
//
// A core is guessed in plain doubles, then proved. A plane divides each triangle of the object from
// the core, which bounds of all roundings show; so the surface does not meet the core. One point of
// the core is inside the object, which is decided exactly; so all of the core is inside.
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

/// A closed object with a tree of boxes. It is made once for all pairs of the object.
class ClosedObject {
 public:
  using Corners = std::array<Vec3, 3>;

  /// surface: by doubted_surface_of(), not `open`. pieces: one corner of each connected piece of
  /// the object. Precondition: the object has triangles. The scene has to outlive this.
  ClosedObject(const Scene& scene, std::uint32_t object, Surface surface,
               std::span<const Vec3> pieces);

  const std::vector<Corners>& triangles() const { return triangles_; }  // in the tree's order
  const std::vector<Vec3>& corners() const { return corners_; }         // without repetitions
  const std::vector<Vec3>& pieces() const { return pieces_; }
  const BoundsTree& tree() const { return tree_; }
  const Box& box() const { return box_; }
  double largest() const { return largest_; }  // the largest magnitude of a coordinate
  /// The whole object as a core: all corners, moved inward a little. Empty if it is not convex.
  const std::vector<Vec3>& convex() const { return convex_; }
  /// True iff the point is strictly inside, decided exactly.
  bool has(const Vec3& point) const;
  /// True only if the point is certainly outside. Precondition: it is not on the surface.
  bool has_not(const Vec3& point) const;
  /// The nearest point of the surface, in plain doubles.
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

/// A core is made smaller by this much, relative to the size of its region.
inline constexpr double kCoreInward = 1e-10;

/// At most `most` cores of the part of the object in the region; empty if none is found. seeds:
/// points to grow cores around; the function adds points close to the surface.
std::vector<std::vector<Vec3>> cores_of(const ClosedObject& solid, const Box& region,
                                        std::span<const Vec3> seeds, std::size_t most);

/// True only if the insides of a, moved by the translation, and of b have no point in common. Uses
/// bounds of all roundings: false if the insides are too near to decide.
bool separates(const ClosedObject& a, const ClosedObject& b, const Vec3& translation);

}  // namespace farcull
