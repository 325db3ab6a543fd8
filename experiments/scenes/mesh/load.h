// Reads meshes from OBJ, OFF, PLY and STL files, also compressed by gzip, and writes OFF files.
// Coordinates are never rounded to float: text is rounded once, to double, and binary floats are
// widened exactly. Indices and sizes are checked against the contents of a file. A size in a header
// alone never causes an allocation.
#pragma once

#include <bit>
#include <map>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/scene/scene.h"

namespace farcull {

/// A triangle mesh with at least one triangle. Triangles may be degenerate. Vertices may be unused.
struct Mesh {
  std::vector<Vec3> vertices;                           // finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
  std::vector<std::uint32_t> source_face;               // face of each triangle in the file, from 0
  std::vector<std::uint32_t> group;        // for each triangle, an index into group_names
  std::vector<std::string> group_names;    // valid UTF-8, in order of first mention
  std::vector<std::uint32_t> folded = {};  // sorted indices of faces that are Triangulation::folded
  std::vector<std::string> notes = {};     // sentences about data that the reader skipped
};

/// A part of a mesh, with a copy of the vertices that the part uses.
struct MeshPart {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
};

enum class MeshFormat { kObj, kOff, kPly, kStl };

/// Returns the format for a path's extension, in upper or lower case. Ignores a final ".gz". Throws
/// foreign_mesh(path) if that is not empty, and another Error for other unknown extensions.
MeshFormat mesh_format(const std::string& path);
/// Returns the format for the name "obj", "off", "ply" or "stl". Throws Error naming --format for
/// other names.
MeshFormat named_format(const std::string& name);
bool has_mesh_extension(const std::string& path);
/// Returns an Error if the path's extension, with or without .gz, is that of a known format that
/// farcull cannot read. The Error tells how to convert the file. Otherwise returns empty.
std::optional<Error> foreign_mesh(const std::string& path);

/// Returns at most 100 sentences on data that load_mesh() skipped since the previous call, as in
/// "a.obj: 2 vertices that are not finite and that no face uses: passed over". Thread-safe.
std::vector<std::string> take_reading_notes();
void add_reading_notes(const std::string& path, const std::vector<std::string>& notes);

/// Reads a mesh.
/// - triangulate() turns a polygon of n vertices into n - 2 consecutive triangles. They cover a
///   simple planar polygon exactly. Mesh::folded lists the folded polygons.
/// - Vertices that are not finite and that no face uses become 0, 0, 0. Mesh::notes counts them.
/// - OBJ: each face belongs to the group that the last line `o` or `g` names. The same name after
///   `g` under two different `o` gives two groups. ASCII STL: each solid is a group, even if two
///   solids have the same name. Other formats: one group, "default".
/// - STL: corners at exactly the same position become one vertex; 0.0 and -0.0 count as equal.
/// - Contents compressed by gzip are decompressed, whatever the file's name.
/// Throws Error naming the path, and the line if the format has lines, in these cases: the file is
/// missing, not a regular file, unreadable, malformed, or shorter or longer than its header says; a
/// face has a corner that is not finite, an index out of range, or fewer than 3 vertices; there are
/// no triangles, or more than 2^32 - 1; gunzip() refuses the data (text.h).
Mesh load_mesh(const std::string& path);

/// Does the same as load_mesh() for the bytes of a file. name: stands for the path in errors.
Mesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name);

/// Returns the part as text of an OFF file. Numbers have 17 digits, so that no double changes.
std::string off_text(const MeshPart& part);
/// True if a name has exactly one placeholder for a number: %d, or %0Nd for N digits (1 to 9) with
/// leading zeros.
bool is_numbered(const std::string& name);
/// Returns the name with the number inserted. Preconditions: is_numbered(name), number >= 0.
std::string numbered(const std::string& name, long number);

/// The options --weld and --format for reading meshes (SceneArguments of scene_file.h).
struct MeshReading {
  std::string weld;                  // text for parse_weld(); empty: no welding
  std::optional<MeshFormat> format;  // format of the mesh on standard input, "-"
};

class MeshCache {
 public:
  /// Makes a cache without frames. Each path names one file.
  MeshCache() = default;
  /// Makes a cache with frames. In numbered names, %d or %0Nd stands for the current frame.
  explicit MeshCache(long first_frame) : frame_(first_frame) {}
  /// Sets the current frame. Precondition: the cache was constructed with a first frame.
  void set_frame(long frame) { frame_ = frame; }

  void read_as(MeshReading reading) { reading_ = std::move(reading); }
  /// Returns a suffix for the scene's name, such as ", welded at 1e-7*size"; "" without welding.
  std::string note() const { return reading_.weld.empty() ? "" : ", welded at " + reading_.weld; }
  /// Frees all meshes except those of numbered names.
  void clear() { meshes_.clear(); }

  /// Returns the mesh of the path, or of standard input for "-", welded as set by read_as(). The
  /// mesh is valid until clear(), or until get() of the same path in another frame. Throws Error as
  /// load_mesh() does. Without frames, throws Error for a numbered name that is not a file.
  const Mesh& get(const std::string& path);

  /// Returns the numbered names for which get() was called.
  std::vector<std::string> numbered_paths() const;

 private:
  struct Moving {
    long frame = 0;
    Mesh mesh;
  };

  Mesh read(const std::string& path) const;

  std::optional<long> frame_;
  MeshReading reading_;
  std::map<std::string, Mesh> meshes_;    // keys: real paths of files
  std::map<std::string, Moving> moving_;  // keys: numbered names
};

/// Returns the name of a file without its folder, without .gz and without its extension.
std::string mesh_stem(const std::string& path);

/// Collects vertices and polygons, checks them and triangulates the polygons. The parameter `line`
/// is the number of a line in the file; 0 for formats without lines.
class MeshBuilder {
 public:
  /// first: the number that error messages give to the first vertex and to the first face.
  explicit MeshBuilder(std::string name, std::uint32_t first = 0);

  std::uint64_t vertex_count() const { return mesh_.vertices.size(); }
  /// p may be infinite or NaN if no face uses this vertex. Throws Error beyond 2^32 - 1 vertices.
  void add_vertex(const Vec3& p, long line);
  /// Puts all faces that are added from now on into the group of this name. An empty name means
  /// "default". within: the enclosing unit, such as an object of OBJ. The same name in another unit
  /// is another group, which gets the suffix #2, #3 and so on.
  void set_group(std::string_view group_name, std::string_view within = {});
  /// Adds a polygon. corners: indices of vertices from 0. Throws Error if there are fewer than 3
  /// corners, if a corner is not a vertex added before or is not finite, if the mesh would have
  /// more than 2^32 - 1 triangles, or if the polygon is Triangulation::too_large.
  void add_face(std::span<const std::uint32_t> corners, long line);
  void note(std::string text) { mesh_.notes.push_back(std::move(text)); }
  /// Returns the mesh. Throws Error if there is no triangle.
  Mesh finish();

 private:
  std::string name_;
  std::uint64_t first_;
  Mesh mesh_;
  std::unordered_map<std::string, std::uint32_t> groups_, repeats_;
  std::unordered_set<std::string> group_names_;
  std::uint32_t group_ = 0;
  std::uint32_t faces_ = 0;
  std::unordered_map<std::uint32_t, long> not_finite_;  // keys: vertices; values: their lines
};

Mesh parse_obj(std::string_view bytes, const std::string& name);
Mesh parse_off(std::string_view bytes, const std::string& name);
Mesh parse_ply(std::string_view bytes, const std::string& name);
Mesh parse_stl(std::string_view bytes, const std::string& name);

/// True if the length is that of a binary STL file with the number of triangles in the header.
bool is_binary_stl(std::string_view bytes);

/// Returns the sign of the area of the triangle a, b, c in the plane of the coordinates u (to the
/// right) and v (up): 1 for a left turn at b, -1 for a right turn, 0 if the three points are
/// collinear in this plane. The sign is exact for all finite doubles.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
/// Returns turn(), computed by rounded arithmetic; 0 if the sign is uncertain. A sign is uncertain
/// if the points are close to a line, or if products of differences overflow or underflow.
int certain_turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
using Turn = int (*)(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);

enum class Triangulation {
  whole,      // the triangles cover the polygon, have one orientation, and do not overlap
  too_large,  // no triangles: the polygon is not convex, and has more than 8,192 corners or needs
              // more than 16 corners^2 steps
  folded,     // the polygon is not simple in its plane: the triangles overlap or face both ways
};

/// Triangulates a polygon. Appends corners.size() - 2 triangles, or none if the polygon is
/// too_large. Triangles are indices into `corners`. Signs are exact, since a triangle outside the
/// polygon could collide with objects that the polygon does not touch. The polygon is projected
/// along a coordinate axis. In absolute value, the normal's component on this axis is at least half
/// of the largest component. Triangles have the orientation of the polygon; some may be degenerate
/// if corners are collinear. Returns `whole` for a simple planar polygon, for a nonplanar polygon
/// with a simple projection, for collinear corners, and, if possible, for a polygon that touches
/// itself along a seam. by: replaces turn() in tests. Precondition: at least 3 finite corners.
Triangulation triangulate(std::span<const Vec3> corners,
                          std::vector<std::array<std::uint32_t, 3>>& triangles, Turn by = turn);

// Welding (--weld; weld.cpp) merges vertices of a mesh that nearly coincide. CAD programs write a
// corner once for each face, and the copies may differ in the last digits.

/// The largest distance at which weld() merges two vertices.
struct WeldTolerance {
  double value = 0;       // finite, >= 0
  bool relative = false;  // true: `value` is a fraction of the diagonal of the mesh's box
  double length(const Box& box) const {
    return value * (relative ? (box.hi - box.lo).stableNorm() : 1);
  }
};
/// Reads "0.001" (in units of the mesh) or "1e-7*size" (relative). Throws Error naming `option`.
WeldTolerance parse_weld(const std::string& text, const char* option = "--weld");

/// Visits the vertices that triangles use, in ascending order. Merges a vertex into the nearest
/// vertex kept before, if their distance (in double) is at most the tolerance; in a tie, into the
/// first of the nearest vertices. Otherwise keeps the vertex. Keeps all triangles in order, even
/// triangles that become segments or points. Returns the number of merged vertices.
std::uint64_t weld(Mesh& mesh, const WeldTolerance& tolerance);

struct WeldHint {
  std::uint64_t open_edges = 0;  // edges that belong to an odd number of triangles
  double tolerance = 0;          // as a fraction of the diagonal of the object's box
  Vec3 place;                    // one end of an open edge
};
/// Returns a hint with the least tolerance among 1e-13, 1e-12, .. 1e-5 at which welding the ends of
/// the object's open edges closes all of them; empty if no tolerance does, or if no edge is open.
std::optional<WeldHint> weld_hint(const Scene& scene, const Object& object);

/// Hashes a position. Callers add 0.0 to coordinates, so that -0.0 and 0.0 have the same hash.
struct PositionHash {
  std::size_t operator()(const std::array<double, 3>& at) const {
    std::uint64_t hash = 0;
    for (const double x : at) {
      // Doubles often differ only in their high bits. The shift mixes these into the low bits.
      hash = (std::rotl(hash, 21) ^ std::bit_cast<std::uint64_t>(x)) * kGolden;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

}  // namespace farcull
