// Chooses the reader by the extension of the path.
#include "experiments/scenes/mesh/load.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>

#include "core/base/error.h"
#include "experiments/scenes/mesh/builder.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

// A file is read as a whole, so that counts can be held against what is there; more than this is
// refused at once.
constexpr std::uint64_t kMaxMeshBytes = std::uint64_t{4} << 30;

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

std::optional<MeshFormat> find_format(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".off") return MeshFormat::kOff;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".stl") return MeshFormat::kStl;
  return std::nullopt;
}

}  // namespace

MeshFormat mesh_format(const std::string& path) {
  if (const std::optional<MeshFormat> format = find_format(path)) return *format;
  const std::string extension = lower_extension(path);
  throw Error(path,
              extension.empty()
                  ? "a mesh file needs an extension that names its format"
                  : "no mesh format is known by the extension " + quote_token(extension),
              "give a file that ends in .obj, .off, .ply or .stl");
}

bool has_mesh_extension(const std::string& path) { return find_format(path).has_value(); }

Mesh load_mesh(const std::string& path) {
  const MeshFormat format = mesh_format(path);
  try {
    return parse_mesh(read_file(path, kMaxMeshBytes), format, path);
  } catch (const std::bad_alloc&) {
    throw Error(path, "the mesh does not fit into memory", "split it or use a larger machine");
  }
}

Mesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name) {
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

}  // namespace farcull
