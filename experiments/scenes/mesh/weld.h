// Vertices of a mesh that nearly coincide become one (--weld). CAD programs write a corner once for
// each face, and the copies may differ in the last digits.
#pragma once

#include <cstdint>
#include <string>

namespace farcull {

struct Mesh;

/// How far apart vertices may be that become one.
struct WeldTolerance {
  double value = 0;       // finite, >= 0
  bool relative = false;  // to the diagonal of the mesh's box
};
/// "0.001" in the units of the mesh, or "1e-7*size". Throws Error naming --weld.
WeldTolerance parse_weld(const std::string& text);

/// Merges vertices that triangles use: each becomes the nearest earlier one that is kept, if its
/// distance (in double) is at most the tolerance, of equal ones the first. So no vertex moves
/// farther, and the answer does not depend on anything else. Returns how many were merged.
/// Triangles stay in their order, those that become segments or points too.
std::uint64_t weld(Mesh& mesh, const WeldTolerance& tolerance);

}  // namespace farcull
