// Whether one object lies inside another, exactly.
//
// Semantics: a mesh is *closed* if every edge, by the positions of its ends, belongs to an even
// number of its triangles; triangles with two equal corners do not count. A point off the mesh is
// *inside* if a ray from it crosses the mesh an odd number of times. For a closed mesh this is the
// same for every ray that meets no edge.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace farcull {

/// on: the point lies on a triangle of the object. not_closed: the object has no inside.
enum class Inside : std::uint8_t { no, yes, on, not_closed };

/// True iff the object is closed; an object without triangles is closed.
bool is_closed(const Scene& scene, std::uint32_t object);

/// Says where the point (finite) lies; `on` is also the answer for an object that is not closed.
/// Rays that meet an edge or run in a triangle's plane are cast again in another direction.
/// Preconditions of verify/exact.h. Throws std::logic_error for an object that the scene does not
/// have.
Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point);

/// The same with the result of is_closed(), which takes most of the time.
Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point, bool closed);

}  // namespace farcull
