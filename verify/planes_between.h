// The two parallel planes that keep two triangles apart, in exact arithmetic. They show of many
// other pairs of triangles at once that they are no nearer.
#pragma once

#include <array>
#include <memory>

#include "core/scene/scene.h"

namespace farcull {

/// Let p and q be closest points of the triangles a and b, and w = q - p. One plane goes through p,
/// the other one through q, both perpendicular to w. The reach of a triangle is how far it extends
/// beyond the first plane in the direction of w; the start of a triangle is how far behind the
/// second plane it begins. Both are in one unit, and negative on the other side of the plane.
/// If the reach of s is at most the start of t, then w.(y - x) >= w.w for all points x of s and y
/// of t, so |y - x| >= |w|: s and t are no nearer than a and b. If it is below the start, they are
/// farther apart.
class PlanesBetween {
 public:
  /// Throws std::logic_error if the triangles meet.
  PlanesBetween(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

  /// Never below the exact reach, and equal to it if it is a double, such as 0.
  double reach(const std::array<Vec3, 3>& t) const { return place(t, 0); }
  /// Never above the exact start, and equal to it if it is a double.
  double start(const std::array<Vec3, 3>& t) const { return place(t, 1); }

 private:
  struct Planes;
  double place(const std::array<Vec3, 3>& t, int side) const;

  std::shared_ptr<const Planes> planes_;
};

}  // namespace farcull
