// Two tables: extensions and first bytes. The commands were tried with assimp 5.2.5, meshio 5.0,
// Gmsh 4.8.4 and Blender 3.4.1.
#include "experiments/scenes/mesh/foreign.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "experiments/system/shell_word.h"

namespace farcull {
namespace {

enum class Converter {
  assimp,
  meshio,
  gmsh_mesh,
  gmsh_shape,
  blend,
  usd,
  abc,
  xz,
  bzip2,
  zstd,
  zip
};

struct Foreign {
  std::string_view name;
  Converter by;
};

struct Extension {
  std::string_view extension;
  Foreign format;
};

constexpr Foreign kGltf = {"glTF", Converter::assimp};
constexpr Foreign kFbx = {"FBX", Converter::assimp};
constexpr Foreign kDae = {"COLLADA", Converter::assimp};
constexpr Foreign k3ds = {"3DS", Converter::assimp};
constexpr Foreign kX3d = {"X3D", Converter::assimp};
constexpr Foreign k3mf = {"3MF", Converter::assimp};
constexpr Foreign kVtk = {"VTK", Converter::meshio};
constexpr Foreign kMedit = {"a mesh of Medit", Converter::meshio};
constexpr Foreign kAbaqus = {"an input file of Abaqus", Converter::meshio};
constexpr Foreign kNastran = {"bulk data of Nastran", Converter::meshio};
constexpr Foreign kNetgen = {"a mesh of Netgen", Converter::meshio};
constexpr Foreign kMsh = {"a mesh of Gmsh", Converter::gmsh_mesh};
constexpr Foreign kStep = {"STEP", Converter::gmsh_shape};
constexpr Foreign kIges = {"IGES", Converter::gmsh_shape};
constexpr Foreign kBrep = {"a shape of OpenCASCADE", Converter::gmsh_shape};
constexpr Foreign kUsd = {"USD", Converter::usd};
constexpr Foreign kAlembic = {"Alembic", Converter::abc};
constexpr Foreign kBlend = {"a file of Blender", Converter::blend};
constexpr Foreign kXz = {"compressed by xz", Converter::xz};
constexpr Foreign kBzip2 = {"compressed by bzip2", Converter::bzip2};
constexpr Foreign kZstd = {"compressed by zstd", Converter::zstd};
constexpr Foreign kZip = {"a zip archive", Converter::zip};

constexpr std::array<Extension, 30> kExtensions = {
    {{".gltf", kGltf},   {".glb", kGltf},    {".fbx", kFbx},    {".dae", kDae},
     {".3ds", k3ds},     {".x3d", kX3d},     {".3mf", k3mf},    {".vtk", kVtk},
     {".vtu", kVtk},     {".mesh", kMedit},  {".inp", kAbaqus}, {".bdf", kNastran},
     {".nas", kNastran}, {".vol", kNetgen},  {".msh", kMsh},    {".step", kStep},
     {".stp", kStep},    {".iges", kIges},   {".igs", kIges},   {".brep", kBrep},
     {".usd", kUsd},     {".usda", kUsd},    {".usdc", kUsd},   {".usdz", kUsd},
     {".abc", kAlembic}, {".blend", kBlend}, {".xz", kXz},      {".bz2", kBzip2},
     {".zst", kZstd},    {".zip", kZip}}};

struct Sign {
  std::string_view text;
  bool first;  // the file begins with it; else it stands among the first bytes
  Foreign format;
};

using namespace std::string_view_literals;
constexpr std::array<Sign, 18> kSigns = {{{"glTF"sv, true, kGltf},
                                          {"Kaydara FBX Binary"sv, true, kFbx},
                                          {"; FBX "sv, true, kFbx},
                                          {"<COLLADA"sv, false, kDae},
                                          {"<X3D"sv, false, kX3d},
                                          {"# vtk DataFile"sv, true, kVtk},
                                          {"<VTKFile"sv, false, kVtk},
                                          {"$MeshFormat"sv, true, kMsh},
                                          {"MeshVersionFormatted"sv, true, kMedit},
                                          {"ISO-10303-21"sv, true, kStep},
                                          {"DBRep_DrawableShape"sv, true, kBrep},
                                          {"PXR-USDC"sv, true, kUsd},
                                          {"#usda"sv, true, kUsd},
                                          {"Ogawa"sv, true, kAlembic},
                                          {"BLENDER"sv, true, kBlend},
                                          {"\xfd"
                                           "7zXZ\0"sv,
                                           true, kXz},
                                          {"\x28\xb5\x2f\xfd"sv, true, kZstd},
                                          {"PK\x03\x04"sv, true, kZip}}};

std::string lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

// A string of Python, in double quotes.
std::string python_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "\"";
}

std::string blender(const std::string& import, const std::string& from, const std::string& to) {
  return "blender -b --python-expr " +
         quoted("import bpy; bpy.ops.wm.read_factory_settings(use_empty=True); bpy.ops.wm." +
                import + "(filepath=" + python_text(from) +
                "); bpy.ops.wm.obj_export(filepath=" + python_text(to) + ")");
}

// The command, and where its program comes from.
std::string command(Converter by, const std::string& path) {
  const std::filesystem::path whole(path);
  const auto beside = [&](const char* extension) {
    return (whole.parent_path() / (mesh_stem(path) + extension)).string();
  };
  const std::string from = quoted(path);
  switch (by) {
    case Converter::assimp:
      return "assimp export " + from + " " + quoted(beside(".obj")) + " (Debian: assimp-utils)";
    case Converter::meshio:
      return "meshio convert " + from + " " + quoted(beside(".off")) + " (Debian: meshio-tools)";
    case Converter::gmsh_mesh:
      return "gmsh " + from + " -save -o " + quoted(beside(".stl")) + " (Debian: gmsh)";
    case Converter::gmsh_shape:
      return "gmsh " + from + " -2 -o " + quoted(beside(".stl")) + " (Debian: gmsh)";
    case Converter::blend:
      return "blender -b " + from + " --python-expr " +
             quoted("import bpy; bpy.ops.wm.obj_export(filepath=" + python_text(beside(".obj")) +
                    ")") +
             " (Debian: blender)";
    case Converter::usd:
      return blender("usd_import", path, beside(".obj")) + " (Blender of blender.org)";
    case Converter::abc:
      return blender("alembic_import", path, beside(".obj")) + " (Blender of blender.org)";
    case Converter::xz:
      return "xz -dk " + from + " (Debian: xz-utils)";
    case Converter::bzip2:
      return "bzip2 -dk " + from + " (Debian: bzip2)";
    case Converter::zstd:
      return "zstd -d " + from + " (Debian: zstd)";
    case Converter::zip:
      return "unzip " + from + " (Debian: unzip)";
  }
  return "";
}

// 3DS begins with the chunk of the whole file: its number and its length. The number of the next
// chunk follows: the version, or the editor's data.
bool is_3ds(std::string_view bytes) {
  if (bytes.size() < 16 || !bytes.starts_with("MM")) return false;
  const std::string_view chunk = bytes.substr(6, 2);
  return chunk == "\x02\0"sv || chunk == "\x3d\x3d"sv;
}

bool is_gltf_text(std::string_view bytes) {
  return bytes.starts_with("{") && bytes.find("\"asset\"") != std::string_view::npos;
}

Error refusal(const Foreign& format, const std::string& path, const std::string& how) {
  const bool packed = format.by == Converter::xz || format.by == Converter::bzip2 ||
                      format.by == Converter::zstd || format.by == Converter::zip;
  return Error(path,
               how + std::string(format.name) +
                   (packed ? ", which is not read (gzip is)"
                           : ", which is not read (OBJ, OFF, PLY and STL are)"),
               std::string(packed ? "unpack it: " : "convert it: ") + command(format.by, path));
}

}  // namespace

std::string lower_extension(const std::string& path) {
  const std::filesystem::path name(path);
  const std::string last = lower(name.extension().string());
  return last == ".gz" ? lower(name.stem().extension().string()) + last : last;
}

std::string mesh_stem(const std::string& path) {
  const std::filesystem::path name(path);
  return lower(name.extension().string()) == ".gz" ? name.stem().stem().string()
                                                   : name.stem().string();
}

std::optional<Error> foreign_name(const std::string& path) {
  std::string extension = lower_extension(path);
  if (extension.ends_with(".gz")) return std::nullopt;
  for (const Extension& known : kExtensions) {
    if (extension == known.extension) return refusal(known.format, path, "is ");
  }
  return std::nullopt;
}

std::optional<Error> foreign_contents(std::string_view bytes, const std::string& path) {
  bytes = bytes.substr(0, kTellingBytes);
  for (const Sign& sign : kSigns) {
    const std::size_t at = bytes.find(sign.text);
    if (at == 0 || (at != std::string_view::npos && !sign.first))
      return refusal(sign.format, path, "holds ");
  }
  // bzip2: the size of its blocks follows, then the first digits of pi.
  if (bytes.size() > 10 && bytes.starts_with("BZh") && bytes.substr(4, 3) == "1AY")
    return refusal(kBzip2, path, "holds ");
  if (is_3ds(bytes)) return refusal(k3ds, path, "holds ");
  if (is_gltf_text(bytes)) return refusal(kGltf, path, "holds ");
  return std::nullopt;
}

}  // namespace farcull
