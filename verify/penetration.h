// Bounds of the penetration depth of two objects that are closed: the length of the shortest
// translation of one of them after which their insides have no point in common (Cameron and Culley,
// Determining the Minimum Translational Distance Between Two Convex Polyhedra, 1986).
//
// From above: a translation, and a direction in which the translated object ends before the other
// one begins. separates() decides this in rational numbers.
//
// From below, by either of two proofs; each holds for any points that are found in any way.
// - Balls. A point p is inside both objects, r and s away from their surfaces. After a translation
//   of a by less than r + s, the ball of radius r around the moved p and the ball of radius s
//   around p still meet, and they are inside a and b.
// - Nearly convex objects. The Minkowski difference of a and b holds the difference of any point
//   of a and any point of b; if a and b are convex, it holds the convex hull of such differences.
//   If a closed surface with such corners is r away from the origin, and has the origin inside, the
//   ball of radius r lies in the hull: a translation by less than r leaves a common point.
//   Let c be a point inside an object, rho away from its surface, and let no corner be more than
//   epsilon above the plane of a face. Then every point of the surface is at most epsilon away
//   from the surface of the convex hull, so that all of the hull that is farther than that from
//   its surface is inside the object, if c is. The hull shrunk towards c by the factor 1 - epsilon
//   / rho is such a part. So each corner counts with an error of epsilon / rho times its distance
//   from c, and the radius r is less by the sum of the largest errors.
//   The surface is found by the expanding polytope algorithm (van den Bergen, Proximity Queries and
//   Penetration Depth Computation on 3D Game Objects, 2001).
//
// World units. Preconditions of verify/exact.h.
#pragma once

#include <span>

#include "core/scene/scene.h"

namespace farcull {

struct Penetration {
  double lo = 0;                    // the depth is at least this
  double hi = 0;                    // and at most this: no less than the length of the translation
  Vec3 translation = Vec3::Zero();  // of object a
  Vec3 direction = Vec3::Zero();    // in which a then ends before b begins; any length
};

/// True iff direction . (p + translation) <= direction . q for all corners p of a and q of b, and
/// the direction is not 0: then the translated insides have no common point. Exact.
bool separates(const Scene& scene, ObjectPair objects, const Vec3& direction,
               const Vec3& translation);

/// Preconditions: both objects are closed and have triangles. starts: points from which the search
/// for a common point inside both begins, such as common points of their surfaces.
Penetration penetration(const Scene& scene, ObjectPair objects, std::span<const Vec3> starts);

/// A lower bound of the distance of the point and the surface of the object, close to it.
double distance_below(const Scene& scene, std::uint32_t object, const Vec3& point);

}  // namespace farcull
