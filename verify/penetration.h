// Bounds of the penetration depth of two closed objects: the length of the shortest translation of
// one of them after which their insides have no point in common (Cameron and Culley, Determining
// the Minimum Translational Distance Between Two Convex Polyhedra, 1986).
//
// From above: a translation after which the insides are certainly apart (verify/separates.h).
//
// From below: by cores, convex sets inside the objects (verify/convex_core.h). If A is a core of
// object a and B one of object b, then a and b overlap after each translation inside the polytope
// B - A: the set of differences of a point of B and a point of A. A search divides the ball of
// translations that are shorter than the upper bound into boxes. A box is settled if one polytope
// holds it. The depth is at least the distance of the nearest box that is not settled. As the boxes
// become smaller, their middles are tried as translations.
//
// A polytope is found by the expanding polytope algorithm (van den Bergen, Proximity Queries and
// Penetration Depth Computation on 3D Game Objects, 2001), as a closed surface of triangles: each
// edge is passed equally often in both directions. From a point below the planes of all triangles,
// all of them are seen the same way round, so its winding number is not 0. So the point is inside
// the convex hull of the corners, whether or not the surface is convex.
//
// World units. Preconditions of verify/exact.h.
#pragma once

#include <optional>
#include <span>

#include "verify/convex_core.h"

namespace farcull {

struct Penetration {
  double lo = 0;                    // the depth is at least this
  double hi = 0;                    // and at most this: no less than the length of the translation
  Vec3 translation = Vec3::Zero();  // of object a
};

/// A question that needs no tight bounds: is the depth at most `most` (above 0, finite)? ways: unit
/// vectors along which a translation by `most` may separate, such as normals of faces that meet.
struct DepthLimit {
  double most = 0;
  std::span<const Vec3> ways = {};
};

/// starts: points inside both or near such points, such as common points of their surfaces.
/// threads: as in for_each_shared(); changes no answer. limit: the bounds are then those found when
/// its question was decided; if hi > most, nothing proves that the depth is at most `most`.
Penetration penetration(const ClosedObject& a, const ClosedObject& b, std::span<const Vec3> starts,
                        unsigned threads = 1, const std::optional<DepthLimit>& limit = {});

}  // namespace farcull
