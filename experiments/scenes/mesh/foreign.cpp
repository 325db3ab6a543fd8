// Formats that are not read: a table of their extensions, their first bytes, and the commands that
// convert them. The commands were tried with assimp 5.2.5, meshio 5.0, Gmsh 4.8.4 and
// Blender 3.4.1.
#include "experiments/scenes/mesh/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "experiments/scenes/mesh/text.h"
#include "experiments/system/shell_word.h"

namespace farcull {
namespace {

using namespace std::string_view_literals;

struct Converter {
  // {0}: the file, {1}: the result, each as a shell reads it; {2}: a script for Blender.
  const char* command;
  const char* extension = "";  // of the result
  const char* import = "";  // of the script: how Blender reads the file, where it does not open it
  bool packed = false;      // the file is unpacked, not converted
};

constexpr Converter kAssimp = {"assimp export {0} {1} (Debian: assimp-utils)", ".obj"};
constexpr Converter kMeshio = {"meshio convert {0} {1} (Debian: meshio-tools)", ".off"};
constexpr Converter kGmshMesh = {"gmsh {0} -save -o {1} (Debian: gmsh)", ".stl"};
constexpr Converter kGmshShape = {"gmsh {0} -2 -o {1} (Debian: gmsh)", ".stl"};
constexpr Converter kBlender = {"blender -b {0} --python-expr {2} (Debian: blender)", ".obj"};
constexpr const char* kNewBlender = "blender -b --python-expr {2} (Blender of blender.org)";

struct Foreign {
  std::string_view name;
  Converter by;
  std::string_view extensions;
  // The file begins with one of these; with '<', it holds it among its first bytes.
  std::array<std::string_view, 2> signs = {};
};

constexpr std::array<Foreign, 22> kForeign = {{
    {"glTF", kAssimp, ".gltf .glb", {"glTF"}},
    {"FBX", kAssimp, ".fbx", {"Kaydara FBX Binary", "; FBX "}},
    {"COLLADA", kAssimp, ".dae", {"<COLLADA"}},
    {"X3D", kAssimp, ".x3d", {"<X3D"}},
    {"VTK", kMeshio, ".vtk .vtu", {"# vtk DataFile", "<VTKFile"}},
    {"a mesh of Gmsh", kGmshMesh, ".msh", {"$MeshFormat"}},
    {"a mesh of Medit", kMeshio, ".mesh", {"MeshVersionFormatted"}},
    {"STEP", kGmshShape, ".step .stp", {"ISO-10303-21"}},
    {"a shape of OpenCASCADE", kGmshShape, ".brep", {"DBRep_DrawableShape"}},
    {"USD", {kNewBlender, ".obj", "usd_import"}, ".usd .usda .usdc .usdz", {"PXR-USDC", "#usda"}},
    {"Alembic", {kNewBlender, ".obj", "alembic_import"}, ".abc", {"Ogawa"}},
    {"a file of Blender", kBlender, ".blend", {"BLENDER"}},
    {"compressed by xz",
     {"xz -dk {0} (Debian: xz-utils)", "", "", true},
     ".xz",
     {"\xfd"
      "7zXZ\0"sv}},
    {"compressed by zstd",
     {"zstd -d {0} (Debian: zstd)", "", "", true},
     ".zst",
     {"\x28\xb5\x2f\xfd"}},
    {"a zip archive", {"unzip {0} (Debian: unzip)", "", "", true}, ".zip", {"PK\x03\x04"}},
    {"compressed by bzip2", {"bzip2 -dk {0} (Debian: bzip2)", "", "", true}, ".bz2"},
    {"3DS", kAssimp, ".3ds"},
    {"3MF", kAssimp, ".3mf"},
    {"an input file of Abaqus", kMeshio, ".inp"},
    {"bulk data of Nastran", kMeshio, ".bdf .nas"},
    {"a mesh of Netgen", kMeshio, ".vol"},
    {"IGES", kGmshShape, ".iges .igs"},
}};

// A string of Python, in double quotes.
std::string python_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "\"";
}

// The command, and where its program comes from.
std::string command(const Converter& by, const std::string& path) {
  const std::filesystem::path whole(path);
  const std::string to = (whole.parent_path() / (mesh_stem(path) + by.extension)).string();
  std::string script = "import bpy; ";
  if (*by.import != '\0') {
    script += fmt::format(
        "bpy.ops.wm.read_factory_settings(use_empty=True); bpy.ops.wm.{}(filepath={}); ", by.import,
        python_text(path));
  }
  script += "bpy.ops.wm.obj_export(filepath=" + python_text(to) + ")";
  return fmt::format(fmt::runtime(by.command), quoted(path), quoted(to), farcull::quoted(script));
}

// 3DS begins with the chunk of the whole file: its number and its length. The number of the next
// chunk follows: the version, or the editor's data.
bool is_3ds(std::string_view bytes) {
  if (bytes.size() < 16 || !bytes.starts_with("MM")) return false;
  const std::string_view chunk = bytes.substr(6, 2);
  return chunk == "\x02\0"sv || chunk == "\x3d\x3d"sv;
}

Error refusal(const Foreign& format, const std::string& path, const char* how) {
  return Error(path,
               fmt::format("{}{}, which is not read ({})", how, format.name,
                           format.by.packed ? "gzip is" : "OBJ, OFF, PLY and STL are"),
               (format.by.packed ? "unpack it: " : "convert it: ") + command(format.by, path));
}

const Foreign& named(std::string_view name) {
  return *std::ranges::find(kForeign, name, &Foreign::name);
}

}  // namespace

std::string lower_extension(const std::string& path) {
  const std::filesystem::path name(path);
  const std::string last = lower_case(name.extension().string());
  return last == ".gz" ? lower_case(name.stem().extension().string()) + last : last;
}

std::string mesh_stem(const std::string& path) {
  const std::filesystem::path name(path);
  return lower_case(name.extension().string()) == ".gz" ? name.stem().stem().string()
                                                        : name.stem().string();
}

std::optional<Error> foreign_name(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension.empty() || extension.ends_with(".gz")) return std::nullopt;
  for (const Foreign& format : kForeign) {
    if ((std::string(format.extensions) + " ").find(extension + " ") != std::string::npos)
      return refusal(format, path, "is ");
  }
  return std::nullopt;
}

std::optional<Error> foreign_contents(std::string_view bytes, const std::string& path) {
  bytes = bytes.substr(0, kTellingBytes);
  for (const Foreign& format : kForeign) {
    for (const std::string_view sign : format.signs) {
      const std::size_t at = sign.empty() ? std::string_view::npos : bytes.find(sign);
      if (at == 0 || (at != std::string_view::npos && sign.starts_with('<')))
        return refusal(format, path, "holds ");
    }
  }
  // bzip2: the size of its blocks follows, then the first digits of pi.
  if (bytes.size() > 10 && bytes.starts_with("BZh") && bytes.substr(4, 3) == "1AY")
    return refusal(named("compressed by bzip2"), path, "holds ");
  if (is_3ds(bytes)) return refusal(named("3DS"), path, "holds ");
  if (bytes.starts_with("{") && bytes.find("\"asset\"") != std::string_view::npos)
    return refusal(named("glTF"), path, "holds ");
  return std::nullopt;
}

}  // namespace farcull
