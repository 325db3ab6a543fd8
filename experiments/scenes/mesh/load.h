// Meshes, and their files: OBJ, OFF, PLY and STL, also compressed by gzip; OFF is written as
// well. Coordinates are the doubles of the file, never rounded through float: text is converted
// with correct rounding, binary floats widen exactly. Indices, finiteness and sizes are checked
// against the contents; no memory is allocated just because a header claims a size.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace farcull {

// A triangle mesh.

/// A triangle mesh with at least one triangle. Degenerate triangles are kept; vertices that no
/// triangle names are kept.
struct Mesh {
  std::vector<Vec3> vertices;                           // finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
  std::vector<std::uint32_t> source_face;               // per triangle: 0-based face of the file
  std::vector<std::uint32_t> group;                     // per triangle: index into group_names
  std::vector<std::string> group_names;                 // valid UTF-8, in order of first mention
  std::vector<std::uint32_t> folded = {};  // faces that are Triangulation::folded, ascending
  std::vector<std::string> notes = {};     // what the reader passed over, one sentence each
};

/// Triangles with vertices of their own.
struct MeshPart {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
};

enum class MeshFormat { kObj, kOff, kPly, kStl };

/// The format that the extension of a path names, in upper or lower case; ".gz" after it is passed
/// over. Throws Error naming the path for any other extension: foreign_mesh(path), if that exists.
MeshFormat mesh_format(const std::string& path);
/// The format of "obj", "off", "ply" or "stl". Throws Error naming --format.
MeshFormat named_format(const std::string& name);
/// True iff mesh_format(path) would not throw.
bool has_mesh_extension(const std::string& path);
/// The Error for a path with the extension of a known format that is not read, compressed or not.
/// It says what converts the file. Empty for other extensions.
std::optional<Error> foreign_mesh(const std::string& path);

/// What load_mesh() has passed over since the last call, as in "a.obj: 2 vertices that are not
/// finite and that no face uses are passed over"; at most the first 100 sentences. Thread-safe.
std::vector<std::string> take_reading_notes();
/// Adds sentences about the file `path`.
void add_reading_notes(const std::string& path, const std::vector<std::string>& notes);

/// Reads a mesh. A polygon of n vertices becomes n-2 triangles in place, as triangulate()
/// (below) says: a planar simple polygon keeps its area exactly, convex or not; a folded polygon
/// gets some triangulation of its corners, and is listed in Mesh::folded. Vertices that are not
/// finite and that no face uses become 0, 0, 0, and Mesh::notes says how many. OBJ: the last `o` or
/// `g` names the group of the faces that follow; equal `g` of different `o` are different groups.
/// ASCII STL: each solid is a group, even if two have one name. Other formats: one group,
/// "default". STL: corners at one exact position become one vertex (0.0 and -0.0 are one position),
/// the first one read. Contents compressed by gzip are decompressed, whatever their name; lines
/// count in the decompressed text. Throws Error (where = path, line if the format has lines) if the
/// file is missing, is not a regular file, cannot be read, is malformed or shorter or longer than
/// it claims, has a face with a corner that is NaN, infinite or beyond double, an index out of
/// range, a polygon of fewer than 3 vertices, more than 2^32 - 1 triangles, no triangle, or gzip
/// data that are cut, damaged or suspiciously small (text.h).
Mesh load_mesh(const std::string& path);

/// load_mesh() for bytes in memory; `name` stands for the path in errors. Any bytes may be given.
Mesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name);

/// The part as OFF, each number with 17 significant digits, which identify a double.
std::string off_text(const MeshPart& part);
/// Whether a name holds exactly one place for a number: %d, or %0Nd for N digits (1 to 9) with
/// leading zeros.
bool is_numbered(const std::string& name);
/// The name with the number in its place. Precondition: is_numbered(name), number >= 0.
std::string numbered(const std::string& name, long number);

/// How the meshes of a scene are read, as --weld and --format say (SceneArguments of
/// scene_file.h).
struct MeshReading {
  std::string weld;                  // as parse_weld() takes it; empty: vertices stay as they are
  std::optional<MeshFormat> format;  // of standard input, "-"
};

class MeshCache {
 public:
  /// Without frames: every name is the name of a file.
  MeshCache() = default;
  /// With frames: a numbered name stands for the file of the current frame, see set_frame().
  explicit MeshCache(long first_frame) : frame_(first_frame) {}
  /// Precondition: constructed with a first frame.
  void set_frame(long frame) { frame_ = frame; }

  /// How meshes are read from now on.
  void read_as(MeshReading reading) { reading_ = std::move(reading); }
  /// The end of the scene's name, such as ", welded at 1e-7*size"; empty if nothing is welded.
  std::string note() const { return reading_.weld.empty() ? "" : ", welded at " + reading_.weld; }
  /// Frees the meshes of names without numbers.
  void clear() { meshes_.clear(); }

  /// The mesh of the path, or of standard input for "-", welded if that is set; valid until the
  /// same path is asked for in another frame. Throws Error as load_mesh, and without frames for a
  /// numbered name that is not a file. The meshes of two frames may differ in their triangles.
  const Mesh& get(const std::string& path);

  /// The numbered names that get() was called with.
  std::vector<std::string> numbered_paths() const;

 private:
  struct Moving {
    long frame = 0;
    Mesh mesh;
  };

  Mesh read(const std::string& path) const;

  std::optional<long> frame_;
  MeshReading reading_;
  std::map<std::string, Mesh> meshes_;    // by the file's real path
  std::map<std::string, Moving> moving_;  // by the name
};

/// The extension in lower case, with its dot; for a compressed file the last two: ".obj.gz" for
/// "a.OBJ.gz".
std::string lower_extension(const std::string& path);
/// The name of a file without its folder and without lower_extension().
std::string mesh_stem(const std::string& path);

// Internals of the mesh readers: the functions that assemble a mesh, and one reader per format.
// Polygons are triangulated with exact signs, since the triangles get exact tests: a triangle
// outside its polygon would collide with objects that the polygon does not touch.

/// Collects vertices and polygons, checks them and triangulates. `line` is 0 for formats without
/// lines.
class MeshBuilder {
 public:
  /// first: the number of the first vertex and face in messages about vertices.
  explicit MeshBuilder(std::string name, std::uint32_t first = 0);

  std::uint64_t vertex_count() const { return mesh_.vertices.size(); }
  /// p may be infinite or NaN if no face uses it. Throws Error beyond 2^32 - 1 vertices.
  void add_vertex(const Vec3& p, long line);
  /// The faces added from now on belong to the group of this name within `within`, such as an
  /// object of OBJ; an empty name is "default". If a group of another `within` has the name, #2, #3
  /// .. is added to the name.
  void set_group(std::string_view group_name, std::string_view within = {});
  /// One polygon, corners in order as 0-based vertex indices. Throws Error if there are fewer than
  /// 3, if one is not a vertex added before or is not finite, if the triangles exceed 2^32 - 1, or
  /// if it is neither convex nor within reach of ear clipping (more than 8,192 corners, or a search
  /// of more than 16 corners^2 steps).
  void add_face(std::span<const std::uint32_t> corners, long line);
  /// Adds a sentence to Mesh::notes.
  void note(std::string text) { mesh_.notes.push_back(std::move(text)); }
  /// Throws Error if there is no triangle.
  Mesh finish();

 private:
  std::string name_;
  std::uint64_t first_;
  Mesh mesh_;
  std::unordered_map<std::string, std::uint32_t> groups_, repeats_;
  std::unordered_set<std::string> group_names_;
  std::uint32_t group_ = 0;
  std::uint32_t faces_ = 0;
  std::unordered_map<std::uint32_t, long> not_finite_;  // vertices, and their lines
};

Mesh parse_obj(std::string_view bytes, const std::string& name);
Mesh parse_off(std::string_view bytes, const std::string& name);
Mesh parse_ply(std::string_view bytes, const std::string& name);
Mesh parse_stl(std::string_view bytes, const std::string& name);

/// True if the bytes have exactly the length that their header, as of a binary STL file, gives.
bool is_binary_stl(std::string_view bytes);

/// The sign of the area of the triangle a, b, c in the plane of the coordinates u and v: 1 if it
/// turns left at b (u to the right, v up), -1 if it turns right, 0 if the three are collinear
/// there. Exact for finite doubles of any size.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
/// turn() by rounded arithmetic, if that is certain of the sign. Returns 0 if turn() has to add
/// without rounding: the three points are close to a line, or products of differences overflow or
/// underflow.
int certain_turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
using Turn = int (*)(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);

enum class Triangulation {
  whole,      // the triangles have the area of the polygon, all one orientation, and do not overlap
  too_large,  // no triangles: neither convex nor within reach of ear clipping
  folded,     // the polygon is not simple in its plane: the triangles overlap or face both ways
};

/// Triangles of a polygon, as positions in `corners`: always size - 2 of them (none if too_large),
/// in the orientation of the polygon; some may be degenerate if corners are collinear. The polygon
/// is projected along a coordinate axis (a coordinate is dropped) and cut there. The normal's
/// component on that axis is the largest, or at least half as large as the largest. The result is
/// `whole` for a simple planar polygon, for a nonplanar one with a simple projection, for collinear
/// corners, and, if possible, for a polygon that touches itself along a seam. `by` lets tests
/// replace turn(). Precondition: 3 corners or more, finite.
Triangulation triangulate(std::span<const Vec3> corners,
                          std::vector<std::array<std::uint32_t, 3>>& triangles, Turn by = turn);

// Vertices of a mesh that nearly coincide become one (--weld; weld_vertices.cpp). CAD programs
// write a corner once for each face, and the copies may differ in the last digits.

/// The largest distance at which two vertices become one.
struct WeldTolerance {
  double value = 0;       // finite, >= 0
  bool relative = false;  // a fraction of the diagonal of the mesh's box
  /// The distance where `box` is around the coordinates.
  double length(const Box& box) const {
    return value * (relative ? (box.hi - box.lo).stableNorm() : 1);
  }
};
/// "0.001" in the units of the mesh, or "1e-7*size". Throws Error naming the option.
WeldTolerance parse_weld(const std::string& text, const char* option = "--weld");

/// Merges vertices that triangles use. Each vertex, in order, becomes the nearest one that was kept
/// before, if the distance (in double) is at most the tolerance; of equally near ones, the first.
/// Otherwise it is kept. So no vertex moves farther than the tolerance. Returns how many were
/// merged. Triangles stay in order, even those that become segments or points.
std::uint64_t weld(Mesh& mesh, const WeldTolerance& tolerance);

}  // namespace farcull
