// Whether one object lies inside another, exactly.
//
// Semantics: a mesh is *closed* if every edge, by the positions of its ends, belongs to an even
// number of its triangles; triangles with two equal corners do not count. It is *oriented* if these
// triangles also pass each edge equally often in both directions. The *winding number* of a point
// off an oriented mesh is how often a ray from it crosses triangles from behind, less how often
// from the front. The point is *inside* if that is not 0. So it is inside two shells that overlap,
// and outside in a cavity whose shell is turned inside out. For a closed mesh that is not oriented,
// the point is inside if the number of crossings is odd. Both are the same for every ray that meets
// no edge.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace farcull {

/// on: the point lies on a triangle of the object. not_closed: the object has no inside.
enum class Inside : std::uint8_t { no, yes, on, not_closed };

enum class Surface : std::uint8_t { open, closed, doubled, oriented };
/// The kind of surface of the object. `closed`: not oriented as well. Never `doubled`. An object
/// without triangles is oriented.
Surface surface_of(const Scene& scene, std::uint32_t object);
/// As above, but for callers that expect doubled triangles. `doubled`: oriented, and two triangles
/// of one plane with a common edge lie on each other, as in a file that has both sides of each
/// face. The winding number does not count these, so it may be 0 in a place that they enclose. An
/// object with triangles that occur twice in the same orientation is `open`.
Surface doubted_surface_of(const Scene& scene, std::uint32_t object);
/// True iff the object is closed.
bool is_closed(const Scene& scene, std::uint32_t object);

/// Says where the point (finite) lies; `on` is also the answer for an object that is not closed.
/// If a ray meets an edge or runs in a triangle's plane, another direction is tried.
/// Preconditions of verify/exact.h. Throws std::logic_error for an object that the scene does not
/// have.
Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point);

/// The same with the result of surface_of(), which takes most of the time.
Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point, Surface surface);

}  // namespace farcull
