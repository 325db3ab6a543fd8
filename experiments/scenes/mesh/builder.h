// The inside of the mesh readers: what each of them calls to put a mesh together, and the readers
// by format. Polygons become triangles by exact signs, since exact tests answer about the triangles
// afterwards: a triangle outside its polygon would collide with what the polygon does not touch.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/scene/scene.h"
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

/// The sign of the area of the triangle a, b, c in the plane of the coordinates u and v: 1 if it
/// turns left at b (u to the right, v up), -1 if it turns right, 0 if the three are collinear
/// there. Exact for finite doubles of any size.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
/// The same where rounded arithmetic is certain of the sign; 0 where turn() has to add without
/// rounding: three points close to a line, or products of differences that overflow or underflow.
int certain_turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
using Turn = int (*)(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);

enum class Triangulation {
  whole,      // the triangles have the area of the polygon, all one orientation, and do not overlap
  too_large,  // no triangles: neither convex nor within reach of ear clipping
  folded,     // the polygon is not simple in its plane: the triangles overlap or face both ways
};

/// Triangles of a polygon, as positions in `corners`: always size - 2 of them (none if too_large),
/// in the orientation of the polygon; some may be degenerate where corners are collinear. The
/// polygon is cut in its projection along the axis nearest to its normal, up to a factor of 2
/// between components; the projection only drops a coordinate. A simple planar polygon is cut into
/// triangles as `whole` says; so is one that is not planar, if its projection is simple, and one
/// that touches itself along a seam, where that can be done. A polygon whose corners are collinear
/// is whole. `by` is for tests of what another sign does. Precondition: 3 corners or more, finite.
Triangulation triangulate(std::span<const Vec3> corners,
                          std::vector<std::array<std::uint32_t, 3>>& triangles, Turn by = turn);

}  // namespace farcull
