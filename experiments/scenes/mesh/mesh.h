// A triangle mesh.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// A triangle mesh with at least one triangle. Degenerate triangles are kept; vertices that no
/// triangle names are kept.
struct Mesh {
  std::vector<Vec3> vertices;                           // finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
  std::vector<std::uint32_t> source_face;               // per triangle: 0-based face of the file
  std::vector<std::uint32_t> group;                     // per triangle: index into group_names
  std::vector<std::string> group_names;                 // valid UTF-8, in order of first mention
  std::vector<std::uint32_t> folded =
      {};  // faces of the file that are folded (builder.h), ascending
};

/// Triangles with vertices of their own.
struct MeshPart {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
};

}  // namespace farcull
