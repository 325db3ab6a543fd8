// Convex sets of points that lie inside a closed object: its *cores*. Bounds of penetration depths
// are made of them (verify/penetration.h).
//
// A core is found in any way, in plain doubles. Then it is proved:
// - each triangle of the object is divided from the core by a plane, with all roundings, so that
//   the surface does not meet the core;
// - one point of the core is inside the object, exactly. So all of it is.
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

/// A closed object with a tree of boxes; made once for all pairs of the object.
class ClosedObject {
 public:
  using Corners = std::array<Vec3, 3>;

  /// surface: by doubted_surface_of(), not open. pieces: a corner of each piece of the object that
  /// hangs together. Precondition: the object has triangles. The scene has to outlive this.
  ClosedObject(const Scene& scene, std::uint32_t object, Surface surface,
               std::span<const Vec3> pieces);

  const std::vector<Corners>& triangles() const { return triangles_; }  // in the tree's order
  const std::vector<Vec3>& corners() const { return corners_; }         // each once
  const std::vector<Vec3>& pieces() const { return pieces_; }
  const BoundsTree& tree() const { return tree_; }
  const Box& box() const { return box_; }
  double largest() const { return largest_; }  // coordinate, by magnitude
  /// The whole object as a core, if it is convex: all corners, moved inward a little.
  const std::vector<Vec3>& convex() const { return convex_; }
  bool has(const Vec3& point) const;      // strictly inside, exactly
  Vec3 nearest(const Vec3& point) const;  // point of the surface, in plain doubles
  /// True if a point off the surface is certainly outside.
  bool has_not(const Vec3& point) const;

 private:
  void find_convex();

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

/// Cores of the part of the object in the region; at most `most`. seeds: points near which cores
/// are wanted; others are added at the surface. Empty if none is found.
std::vector<std::vector<Vec3>> cores_of(const ClosedObject& solid, const Box& region,
                                        std::span<const Vec3> seeds, std::size_t most);

}  // namespace farcull
