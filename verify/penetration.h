// Bounds of the penetration depth of two closed objects. The depth is the length of the shortest
// translation of one object after which the insides have no point in common (Cameron and Culley,
// Determining the Minimum Translational Distance Between Two Convex Polyhedra, 1986).
//
// Upper bound: the length of a translation that is proved to separate the insides (separates()).
//
// Lower bound. Let A be a core (verify/convex_core.h) of a, and B a core of b. The differences B -
// A form a polytope. After each translation of a inside this polytope, the objects overlap. A
// search divides the ball of translations shorter than the upper bound into boxes. A box is settled
// if one polytope contains it. The depth is at least the distance from 0 to the nearest box that is
// not settled. The middles of boxes are tried as translations.
//
// The expanding polytope algorithm (van den Bergen, Proximity Queries and Penetration Depth
// Computation on 3D Game Objects, 2001) gives a polytope as a closed surface of triangles: each
// edge is passed equally often in both directions. A point below the planes of all triangles sees
// all triangles the same way round, so its winding number is not 0. So the point is inside the
// convex hull of the corners, whether or not the surface is convex.
//
// Lengths are in world units. The preconditions are those of verify/exact.h.
#pragma once

#include <optional>
#include <span>

#include "verify/convex_core.h"

namespace farcull {

struct Penetration {
  double lo = 0;                    // the depth is at least this
  double hi = 0;                    // the depth and the length of the translation are at most this
  Vec3 translation = Vec3::Zero();  // of object a; after it the insides are apart
};

/// Restricts a search to one question: is the depth at most `most` (above 0, finite)? ways: unit
/// vectors along which a translation by `most` may separate the objects, for example normals of
/// faces that meet.
struct DepthLimit {
  double most = 0;
  std::span<const Vec3> ways = {};
};

/// Returns bounds of the depth of a and b. starts: points that are inside both objects or nearly
/// so, such as common points of their surfaces. threads: as in for_each_shared(); changes no
/// answer. With a limit, the search ends when the question of DepthLimit is decided; if hi >
/// limit.most, no proof was found that the depth is at most limit.most.
Penetration penetration(const ClosedObject& a, const ClosedObject& b, std::span<const Vec3> starts,
                        unsigned threads = 1, const std::optional<DepthLimit>& limit = {});

}  // namespace farcull
