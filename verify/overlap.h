// Decides whether two objects without crossing triangles overlap, or merely touch.
//
// The kinds of contact (verify/contact.h) do not decide this. Two equal boxes overlap if one is
// moved along an axis by half of its length, but no two of their triangles cross. A surface may
// also pass through another surface along an edge. So one of two proofs is needed to say that two
// objects merely touch:
//
// - A plane has the two objects on different sides (both may touch the plane). Then their insides
//   have no point in common.
// - Both objects are closed, and no *piece* of a triangle shows an overlap. The planes of the
//   triangles that meet a triangle t cut t into pieces (for triangles in the plane of t, the lines
//   of their edges cut t). A piece is entirely inside the other object, outside it or on its
//   surface. So one point of the piece decides.
//
// Why the pieces suffice: if the objects overlap, the boundary of the overlap has a point on a
// face, with the overlap on one side of the face. If this face meets the other surface, one of its
// pieces shows the overlap. If not, the face is inside the other object, and so is the surface
// around the face, up to triangles that meet the other surface; their pieces show the overlap. If
// this connected part of the surface has no such triangle, one of its vertices shows the overlap.
// The answer is unknown if a piece has its own object on neither side, as in a fold.
//
// There are two rules by which a point is inside a mesh: a ray from the point crosses the mesh an
// odd number of times; or it crosses more often in one direction than in the other. If both rules
// hold, the point is inside. If only one rule shows an overlap, the answer is unknown. So
// overlapping shells cannot hide an overlap.
//
// All decisions are exact. The preconditions are those of verify/exact.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/scene/scene.h"
#include "verify/inside.h"

namespace farcull {

/// unknown: the proof would take too long; or an object is not closed, has overlapping shells, or
/// has faces that do not face outward.
enum class Overlap : std::uint8_t { no, yes, unknown };

/// Decides whether two objects overlap. contacts: all pairs of a triangle of a and one of b that
/// share a point; none is of ContactKind::crossing. parts_a: a vertex of each connected part of a;
/// parts_b: likewise of b. surfaces: the results of doubted_surface_of() for a and b.
Overlap overlap_of_touching(const Scene& scene, ObjectPair objects,
                            std::span<const TrianglePair> contacts, std::span<const Vec3> parts_a,
                            std::span<const Vec3> parts_b, std::array<Surface, 2> surfaces);

/// Returns whether a point off the surface of a closed object is inside the object
/// (verify/inside.h). surface: the result of doubted_surface_of(). If the surface is `closed` or
/// `doubled`, a point inside two shells may have an even number of crossings, or the winding number
/// 0. Then the answer is `no` only if a ray along an axis meets nothing; otherwise it is `yes` or
/// `unknown`.
Overlap overlap_at(const Scene& scene, std::uint32_t object, const Vec3& point, Surface surface);

/// True if one of these planes has the objects on different sides: planes perpendicular to an axis,
/// and planes of triangles of contacts (of at most 64 triangles).
bool plane_divides(const Scene& scene, ObjectPair objects, std::span<const TrianglePair> contacts);

}  // namespace farcull
