// Decides exactly whether a point lies inside an object.
//
// A mesh is *closed* if every edge, by the positions of its ends, belongs to an even number of its
// triangles; triangles with two equal corners do not count. A closed mesh is *oriented* if its
// triangles pass each edge equally often in both directions. The *winding number* of a point off an
// oriented mesh is the number of times that a ray from the point crosses triangles from behind,
// less the number of times from the front. The point is *inside* if this number is not 0. So a
// point in two shells that overlap is inside, and a point in a cavity whose shell is turned inside
// out is outside. For a closed mesh that is not oriented, a point is inside if the number of
// crossings is odd. Every ray that meets no edge gives the same answer.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace farcull {

/// on: the point lies on a triangle of the object. not_closed: the object has no inside.
enum class Inside : std::uint8_t { no, yes, on, not_closed };

enum class Surface : std::uint8_t { open, closed, doubled, oriented };
/// Returns the kind of surface of the object; never `doubled`. `closed` means closed, but not
/// oriented. An object without triangles is oriented.
Surface surface_of(const Scene& scene, std::uint32_t object);
/// Like surface_of(), but also finds doubled triangles. `doubled`: the surface is oriented, but at
/// some edge two triangles of one plane lie on each other, as in a file that has both sides of each
/// face. Two such triangles cancel in the winding number. So the winding number may be 0 at a point
/// that the surface encloses. `open`: the surface is not closed, or a triangle occurs more than
/// once and its occurrences do not cancel in orientation.
Surface doubted_surface_of(const Scene& scene, std::uint32_t object);
/// True iff the object is closed.
bool is_closed(const Scene& scene, std::uint32_t object);

/// Returns where the point (finite) lies; `on` even if the object is not closed. If a ray meets an
/// edge or runs in a triangle's plane, another direction is tried. The preconditions are those of
/// verify/exact.h. Throws std::logic_error if the scene does not have the object.
Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point);

/// Like the function above. surface: the result of surface_of() or doubted_surface_of().
Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point, Surface surface);

}  // namespace farcull
