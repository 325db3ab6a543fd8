// Chooses the reader by the extension of the path. Compressed contents are decompressed first.
#include "experiments/scenes/mesh/load.h"

#include <filesystem>
#include <fstream>
#include <new>
#include <optional>

#include "core/base/error.h"
#include "experiments/scenes/mesh/builder.h"
#include "experiments/scenes/mesh/foreign.h"
#include "experiments/scenes/mesh/gzip.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

// A file is read as a whole, so that counts can be held against what is there; more than this is
// refused at once.
constexpr std::uint64_t kMaxMeshBytes = std::uint64_t{4} << 30;

std::optional<MeshFormat> find_format(const std::string& path) {
  std::string extension = lower_extension(path);
  if (extension.ends_with(".gz")) extension.resize(extension.size() - 3);
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".off") return MeshFormat::kOff;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".stl") return MeshFormat::kStl;
  return std::nullopt;
}

}  // namespace

MeshFormat mesh_format(const std::string& path) {
  if (const std::optional<MeshFormat> format = find_format(path)) return *format;
  if (const std::optional<Error> foreign = foreign_mesh(path)) throw *foreign;
  const std::string extension = lower_extension(path);
  if (extension == ".gz") {
    throw Error(path, "a compressed mesh needs the extension of its format before .gz",
                "name it as in bunny.obj.gz");
  }
  throw Error(path,
              extension.empty()
                  ? "a mesh file needs an extension that names its format"
                  : "no mesh format is known by the extension " + quote_token(extension),
              "give a file that ends in .obj, .off, .ply or .stl, or in one of these and .gz");
}

std::optional<Error> foreign_mesh(const std::string& path) {
  if (std::optional<Error> by_name = foreign_name(path)) return by_name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::string bytes(kTellingBytes, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return foreign_contents(bytes, path);
}

bool has_mesh_extension(const std::string& path) { return find_format(path).has_value(); }

namespace {

Mesh parse_plain(std::string_view bytes, MeshFormat format, const std::string& name) {
  if (bytes.empty()) throw Error(name, "the file is empty", "give a mesh with at least one face");
  switch (format) {
    case MeshFormat::kObj:
      return parse_obj(bytes, name);
    case MeshFormat::kOff:
      return parse_off(bytes, name);
    case MeshFormat::kPly:
      return parse_ply(bytes, name);
    case MeshFormat::kStl:
      return parse_stl(bytes, name);
  }
  throw Error(name, "no such mesh format", "use a MeshFormat");
}

// Where the contents are no mesh of this format, they may be one of another.
Mesh parse_known(std::string_view bytes, MeshFormat format, const std::string& name) {
  try {
    return parse_plain(bytes, format, name);
  } catch (const Error&) {
    if (const std::optional<Error> foreign = foreign_contents(bytes, name)) throw *foreign;
    throw;
  }
}

}  // namespace

Mesh load_mesh(const std::string& path) {
  const MeshFormat format = mesh_format(path);
  try {
    std::string bytes = read_file(path, kMaxMeshBytes);
    if (lower_extension(path).ends_with(".gz") && !bytes.empty() && !is_gzip(bytes)) {
      throw Error(path, "is named .gz, but its contents are not compressed by gzip",
                  "compress it with gzip, or give it the extension of what it holds");
    }
    return parse_mesh(bytes, format, path);
  } catch (const std::bad_alloc&) {
    throw Error(path, "the mesh does not fit into memory", "split it or use a larger machine");
  }
}

Mesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name) {
  // The header of a binary STL file may begin like anything.
  const bool compressed = is_gzip(bytes) && !(format == MeshFormat::kStl && is_binary_stl(bytes));
  if (!compressed) return parse_known(bytes, format, name);
  return parse_known(gunzip(bytes, name, {.max_bytes = kMaxMeshBytes}), format, name);
}

}  // namespace farcull
