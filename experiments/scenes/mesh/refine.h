// A mesh of more triangles with the same surface.
#pragma once

#include <cstdint>

#include "experiments/scenes/mesh/mesh.h"

namespace farcull {

/// Divides the longest edge, all its triangles with it, again and again (Rivara 1984), until there
/// are `triangles` or a few more: one division adds as many as the edge has, two on a closed
/// surface. New vertices are midpoints, so the surface stays up to their rounding, and closed stays
/// closed; a triangle that names a vertex twice is left as it is. Edges of equal length are taken
/// in the order of their vertices: the same on every run. A part keeps the source face and the
/// group of its triangle. Nothing happens to a mesh that has as many already. Precondition: mesh
/// has a triangle.
Mesh refined(Mesh mesh, std::uint64_t triangles);

}  // namespace farcull
