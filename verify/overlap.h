// Decides whether two objects without crossing triangles overlap, or merely touch.
//
// The kinds of contact (verify/contact.h) do not tell. Two boxes side by side with three pairs of
// faces in common planes overlap, and no two of their triangles cross; and a surface may pass
// through another one along an edge of it. So an object pair is called a touch only by one of two
// proofs:
//
// - A plane has one object on either side, both perhaps on it. Then no inside of one meets an
//   inside of the other.
// - Both objects are closed, and no *piece* of a triangle shows an overlap. A triangle of one
//   object that meets triangles of the other is cut into pieces by the planes of those (by the
//   lines of their edges, where they lie in its own plane). Inside a piece nothing changes: all of
//   it is inside the other object, outside, or on its surface; so one point of it decides. Were
//   there an overlap, its boundary would have a point on a face, with the overlap on one side of
//   it. If the face has a contact, one of its pieces shows that. If not, the face is inside the
//   other object, and so is all that is connected with it up to the next contact, where a piece
//   of a triangle is inside; without any contact one vertex of the part of the object shows it.
//   Such a piece shows nothing if its own object is on neither side of it, as in a fold; then the
//   answer is unknown.
//
// Here a point may be inside a mesh if a ray from it crosses the mesh an odd number of times, or
// more often in one sense than in the other, so that overlapping shells hide nothing; it is inside
// for certain if both hold. Where only one of them tells of an overlap, the answer is unknown.
//
// Everything is decided in rational numbers. Preconditions of verify/exact.h.
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
/// connected part of a; parts_b likewise. surfaces: of a and b, by
/// doubted_surface_of().
Overlap overlap_of_touching(const Scene& scene, ObjectPair objects,
                            std::span<const TrianglePair> contacts, std::span<const Vec3> parts_a,
                            std::span<const Vec3> parts_b, std::array<Surface, 2> surfaces);

/// Whether a point off the surface of a closed object is inside it (verify/inside.h). If the object
/// is only closed, or doubled, an even number of crossings or a winding number of 0 may also be a
/// place inside two shells. Then the answer is "no" only if a ray along an axis meets nothing, and
/// else unknown. surface: that of doubted_surface_of().
Overlap overlap_at(const Scene& scene, std::uint32_t object, const Vec3& point, Surface surface);

/// Whether a plane along the axes, or the plane of a triangle in one of the contacts, has one
/// object on either side.
bool plane_divides(const Scene& scene, ObjectPair objects, std::span<const TrianglePair> contacts);

}  // namespace farcull
