// The inside of the mesh readers: what each of them calls to put a mesh together, and the readers
// by format.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "experiments/scenes/mesh/mesh.h"

namespace farcull {

/// Collects vertices and polygons, checks them and triangulates. `line` in its functions is 0 where
/// there are no lines.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string name);

  std::uint64_t vertex_count() const { return mesh_.vertices.size(); }
  /// p must be finite. Throws Error beyond 2^32 - 1 vertices.
  void add_vertex(const Vec3& p, long line);
  /// The faces added from now on belong to the group of this name; an empty name is "default".
  void set_group(std::string_view group_name);
  /// One polygon, corners in order as 0-based vertex indices. Throws Error if there are fewer than
  /// 3, if one is not a vertex added before, if the triangles exceed 2^32 - 1, or if it is neither
  /// convex nor within reach of ear clipping (more than 8,192 corners, or a search of more than 16
  /// corners^2 steps).
  void add_face(std::span<const std::uint32_t> corners, long line);
  /// Throws Error if there is no triangle.
  Mesh finish();

 private:
  std::string name_;
  Mesh mesh_;
  std::unordered_map<std::string, std::uint32_t> groups_;
  std::uint32_t group_ = 0;
  std::uint32_t faces_ = 0;
};

Mesh parse_obj(std::string_view bytes, const std::string& name);
Mesh parse_off(std::string_view bytes, const std::string& name);
Mesh parse_ply(std::string_view bytes, const std::string& name);
Mesh parse_stl(std::string_view bytes, const std::string& name);

/// Whether the length of the bytes is what a binary STL file with their header has.
bool is_binary_stl(std::string_view bytes);

}  // namespace farcull
