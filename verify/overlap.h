// Decides whether two objects without crossing triangles overlap, or merely touch.
//
// The kinds of contact (verify/contact.h) do not tell. Two equal boxes overlap if one is moved
// along an axis by half of its length, but no two of their triangles cross. Also, a surface may
// pass through another one along an edge. So an object pair is called a touch only by one of two
// proofs:
//
// - A plane has the two objects on different sides; both may touch it. Then their insides have no
// point in common.
// - Both objects are closed, and no *piece* of a triangle shows an overlap. The pieces of a
// triangle that has contacts are cut out by the planes of the triangles that it meets (by the lines
// of their edges, if these lie in its own plane). All of a piece is inside the other object,
// outside it, or on its surface, so one point of the piece decides.
//
// Why the pieces suffice: if the objects overlap, the boundary of the overlap has a point on a
// face, with the overlap on one side of the face. If this face has a contact, one of its pieces
// shows the overlap. If not, the face is inside the other object, and so is all that is connected
// with it up to the next contact, where a piece of a triangle is inside. If there is no contact in
// that part of the object, one of its vertices shows the overlap. The answer is unknown if a piece
// has its own object on neither side, as in a fold.
//
// Two rules may say that a point is inside a mesh: a ray from it crosses the mesh an odd number of
// times, or more often in one direction than in the other. If both rules say so, the point is
// inside. If only one shows an overlap, the answer is unknown, so overlapping shells hide nothing.
//
// All decisions are made in rational numbers. Preconditions of verify/exact.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/scene/scene.h"
#include "verify/inside.h"

namespace farcull {

/// unknown: an object is not closed, its shells overlap, its faces do not all face outward, or the
/// proof would take too long.
enum class Overlap : std::uint8_t { no, yes, unknown };

/// Preconditions: `contacts` are all pairs of a triangle of object a and a triangle of object b
/// that share a point, and none of them is of ContactKind::crossing. parts_a: a vertex of each
/// connected part of a; parts_b likewise. surfaces: of a and b, by doubted_surface_of().
Overlap overlap_of_touching(const Scene& scene, ObjectPair objects,
                            std::span<const TrianglePair> contacts, std::span<const Vec3> parts_a,
                            std::span<const Vec3> parts_b, std::array<Surface, 2> surfaces);

/// Whether a point off the surface of a closed object is inside it (verify/inside.h). surface: by
/// doubted_surface_of(). If it is `closed` or `doubled`, no rule is certain that a point is
/// outside: a point inside two shells may have an even number of crossings, or the winding number
/// 0. Then the answer is `no` only if a ray along an axis meets nothing, else `unknown`.
Overlap overlap_at(const Scene& scene, std::uint32_t object, const Vec3& point, Surface surface);

/// Whether a plane across an axis, or the plane of a triangle of one of the contacts, has the two
/// objects on different sides.
bool plane_divides(const Scene& scene, ObjectPair objects, std::span<const TrianglePair> contacts);

}  // namespace farcull
