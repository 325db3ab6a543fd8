// Vertices of a mesh that nearly coincide become one (--weld). CAD programs write a corner once for
// each face, and the copies may differ in the last digits.
#pragma once

#include <cstdint>
#include <string>

namespace farcull {

struct Mesh;

/// The largest distance of vertices that are merged.
struct WeldTolerance {
  double value = 0;       // finite, >= 0
  bool relative = false;  // to the diagonal of the mesh's box
};
/// "0.001" in the units of the mesh, or "1e-7*size". Throws Error naming --weld.
WeldTolerance parse_weld(const std::string& text);

/// Merges vertices that triangles use: each becomes the nearest earlier one that is kept, if its
/// distance (in double) is at most the tolerance; the first of several equally near ones. So no
/// vertex moves farther, and the answer depends on nothing else. Returns how many were merged.
/// Triangles stay in their order, also those that become segments or points.
std::uint64_t weld(Mesh& mesh, const WeldTolerance& tolerance);

}  // namespace farcull
