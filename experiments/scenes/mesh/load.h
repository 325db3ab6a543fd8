// Meshes from files: OBJ, OFF, PLY and STL, each of them also compressed by gzip; OBJ and OFF are
// written as well. Coordinates are
// the doubles of the file, never rounded through float (text is converted with correct rounding,
// binary floats widen exactly). What is read is checked here, whatever the file claims: indices,
// finiteness, sizes; nothing is allocated because a header says so.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "experiments/scenes/mesh/mesh.h"

namespace farcull {

enum class MeshFormat { kObj, kOff, kPly, kStl };

/// The format that the extension of a path names, in any case; the one before ".gz" where it ends
/// so. Throws Error naming the path for any other extension: foreign_mesh(path) where there is one.
MeshFormat mesh_format(const std::string& path);
/// True iff mesh_format(path) would not throw.
bool has_mesh_extension(const std::string& path);
/// The Error for a path or a file of a format that is not read and that has a known converter: it
/// names the format and the command. Looks into the file where the extension is not known. Empty
/// where nothing is known about it.
std::optional<Error> foreign_mesh(const std::string& path);

/// Reads a mesh. A polygon of n vertices becomes n-2 triangles in place, as triangulate()
/// (builder.h) says: a planar simple polygon keeps its area exactly, convex or not; one that is
/// folded gets some triangulation of its corners, and is named in Mesh::folded. OBJ: `o` and `g`
/// name the group of the faces that follow, whichever came last. Other formats: one group,
/// "default". STL: corners at one exact position become one vertex (0.0 and -0.0 are one position),
/// the first one read. What gzip has compressed is decompressed, whatever the name says; lines are
/// those of the text. Throws Error (where = path, line where the format has lines) if the file is
/// missing, is not a regular file, cannot be read, is malformed or shorter or longer than it
/// claims, holds NaN, infinity or a value beyond double, an index out of range, a polygon of fewer
/// than 3 vertices, more than 2^32 - 1 triangles, no triangle, or gzip data that are cut, damaged
/// or suspiciously small (text.h). The Error for contents of a known format that is not read names
/// its converter.
Mesh load_mesh(const std::string& path);

/// The same on bytes in memory; `name` stands for the path in errors. Any bytes may be given.
Mesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name);

/// The part as OFF, each number with 17 significant digits, which identify a double.
std::string off_text(const MeshPart& part);
/// The same as an object of OBJ. first: number of its first vertex in the file, from 1.
std::string obj_object(const MeshPart& part, const std::string& name, std::uint64_t first);

/// Whether a name holds one place for a number: %d, or %0Nd for N digits (1 to 9) with leading
/// zeros.
bool is_numbered(const std::string& name);
/// The name with the number in its place. Precondition: is_numbered(name), number >= 0.
std::string numbered(const std::string& name, long number);

class MeshCache {
 public:
  /// Without frames every name is that of a file.
  MeshCache() = default;
  /// Numbered names are files of the frame that set_frame() gives.
  explicit MeshCache(long first_frame) : frame_(first_frame) {}
  /// Precondition: made with a frame.
  void set_frame(long frame) { frame_ = frame; }

  /// The mesh of the path; valid until the same path is asked for in another frame. Throws Error as
  /// load_mesh, and for a numbered name without frames that is no file. The meshes of two frames
  /// may differ in their triangles.
  const Mesh& get(const std::string& path);

  /// The numbered names that were asked for.
  std::vector<std::string> numbered_paths() const;

 private:
  struct Moving {
    long frame = 0;
    Mesh mesh;
  };

  std::optional<long> frame_;
  std::map<std::string, Mesh> meshes_;    // by the file's real path
  std::map<std::string, Moving> moving_;  // by the name
};

/// How many bytes of a file foreign_contents() looks at.
constexpr std::size_t kTellingBytes = 1024;

/// The Error for a path whose extension names a format that is not read: it names the format and
/// the command that converts the file. Empty for other extensions.
std::optional<Error> foreign_name(const std::string& path);
/// The same for a file whose first bytes show such a format, whatever its name.
std::optional<Error> foreign_contents(std::string_view bytes, const std::string& path);

/// The extension in lower case, with its dot. That of a compressed file counts with the one before
/// it: of "a.OBJ.gz" it is ".obj.gz".
std::string lower_extension(const std::string& path);
/// The name of a file without its folder and its extension, as lower_extension() has it.
std::string mesh_stem(const std::string& path);

}  // namespace farcull
