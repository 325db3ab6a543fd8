// Meshes from files: OBJ, OFF, PLY and STL, each of them also compressed by gzip. Coordinates are
// the doubles of the file, never rounded through float (text is converted with correct rounding,
// binary floats widen exactly). What is read is checked here, whatever the file claims: indices,
// finiteness, sizes; nothing is allocated because a header says so.
#pragma once

#include <optional>
#include <string>
#include <string_view>

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

/// Reads a mesh. A polygon of n vertices becomes n-2 triangles in place: as polygon.h
/// says: a planar simple polygon keeps its area exactly, convex or not; one that is folded gets
/// some triangulation of its corners, and is named in Mesh::folded. OBJ: `o` and `g` name the group
/// of the faces that follow, whichever came last. Other formats: one group, "default". STL: corners
/// at one exact position become one vertex (0.0 and -0.0 are one position), the first one read.
/// What gzip has compressed is decompressed, whatever the name says; lines are those of the text.
/// Throws Error (where = path, line where the format has lines) if the file is missing, is not a
/// regular file, cannot be read, is malformed or shorter or longer than it claims, holds NaN,
/// infinity or a value beyond double, an index out of range, a polygon of fewer than 3 vertices,
/// more than 2^32 - 1 triangles, no triangle, or gzip data that are cut, damaged or suspiciously
/// small (gzip.h). The Error for contents of a known format that is not read names its converter.
Mesh load_mesh(const std::string& path);

/// The same on bytes in memory; `name` stands for the path in errors. Any bytes may be given.
Mesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name);

}  // namespace farcull
