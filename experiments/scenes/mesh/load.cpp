// Chooses the reader by the extension of the path, collects the faces that it reads, and keeps
// meshes by their real paths. Compressed contents are decompressed first. Formats that are not read
// are recognized, to name a converter.
#include "experiments/scenes/mesh/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/scenes/mesh/weld.h"
#include "experiments/system/text_table.h"

namespace farcull {

// Formats that are not read: a table of their extensions, their first bytes, and the commands that
// convert them. The commands were tried with assimp 5.2.5, meshio 5.0, Gmsh 4.8.4 and
// Blender 3.4.1.

namespace {

using namespace std::string_view_literals;

struct Converter {
  // {0}: the file, {1}: the result, each as a shell reads it; {2}: a script for Blender.
  const char* command;
  const char* extension = "";  // of the result
  const char* import = "";     // Blender's operator that reads the file; empty: Blender opens it
  const char* verb = "convert it: ";
};
constexpr const char* kUnpack = "unpack it: ";

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
  // The file begins with one of these, or, if one begins with '<', has it in kTellingBytes bytes.
  std::array<std::string_view, 2> signs = {};
};

constexpr std::array<Foreign, 29> kForeign = {{
    {"glTF", kAssimp, ".gltf .glb", {"glTF"}},
    {"FBX", kAssimp, ".fbx", {"Kaydara FBX Binary", "; FBX "}},
    {"COLLADA", kAssimp, ".dae", {"<COLLADA"}},
    {"X3D", kAssimp, ".x3d", {"<X3D"}},
    {"VTK", kMeshio, ".vtk .vtu", {"# vtk DataFile", "<VTKFile"}},
    {"a mesh of Gmsh", kGmshMesh, ".msh", {"$MeshFormat"}},
    {"a mesh of Medit", kMeshio, ".mesh", {"MeshVersionFormatted"}},
    {"STEP", kGmshShape, ".step .stp .p21", {"ISO-10303-21"}},
    {"a shape of OpenCASCADE", kGmshShape, ".brep", {"DBRep_DrawableShape"}},
    {"USD",
     {kNewBlender, ".obj", "wm.usd_import"},
     ".usd .usda .usdc .usdz",
     {"PXR-USDC", "#usda"}},
    {"Alembic", {kNewBlender, ".obj", "wm.alembic_import"}, ".abc", {"Ogawa"}},
    {"a file of Blender", kBlender, ".blend", {"BLENDER"}},
    {"compressed by xz",
     {"xz -dk {0} (Debian: xz-utils)", "", "", kUnpack},
     ".xz",
     {"\xfd"
      "7zXZ\0"sv}},
    {"compressed by zstd",
     {"zstd -d {0} (Debian: zstd)", "", "", kUnpack},
     ".zst",
     {"\x28\xb5\x2f\xfd"}},
    {"a zip archive", {"unzip {0} (Debian: unzip)", "", "", kUnpack}, ".zip", {"PK\x03\x04"}},
    {"compressed by bzip2", {"bzip2 -dk {0} (Debian: bzip2)", "", "", kUnpack}, ".bz2"},
    {"3DS", kAssimp, ".3ds"},
    {"3MF", kAssimp, ".3mf"},
    {"an input file of Abaqus", kMeshio, ".inp"},
    {"bulk data of Nastran", kMeshio, ".bdf .nas"},
    {"a mesh of Netgen", kMeshio, ".vol"},
    {"IGES", kGmshShape, ".iges .igs"},
    {"IFC", {"IfcConvert {0} {1} (ifcopenshell.org)", ".obj"}, ".ifc"},
    {"polygons of VTK",
     {"open it in ParaView and save its data as PLY (Debian: paraview)", "", "", ""},
     ".vtp"},
    {"VRML", {kNewBlender, ".obj", "import_scene.x3d"}, ".wrl .vrml", {"#VRML"}},
    {"AMF", kAssimp, ".amf", {"<amf"}},
    {"a robot in URDF",
     {"name the meshes that it names, or write a scene file (farcull help scene-file)", "", "", ""},
     ".urdf",
     {"<robot"}},
    {"a document of FreeCAD",
     {"open it in FreeCAD and export its shapes as STEP or STL (Debian: freecad)", "", "", ""},
     ".fcstd"},
    {"a document of a CAD program",
     {"open it there and export its shapes as STEP or STL", "", "", ""},
     ".sldprt .sldasm .x_t .x_b .ipt .iam .catpart .catproduct .prt .sat .3dm .jt .dxf .dwg .skp"},
}};

// The text as a string literal of Python, in double quotes.
std::string python_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "\"";
}

// The path with the extension in place of its own.
std::string with_extension(const std::string& path, const std::string& extension) {
  return (std::filesystem::path(path).parent_path() / (mesh_stem(path) + extension)).string();
}

// The command that converts the file to the path `to`, and the source of its program.
std::string command(const Converter& by, const std::string& path, const std::string& to) {
  std::string script = "import bpy; ";
  if (*by.import != '\0') {
    script +=
        fmt::format("bpy.ops.wm.read_factory_settings(use_empty=True); bpy.ops.{}(filepath={}); ",
                    by.import, python_text(path));
  }
  script += "bpy.ops.wm.obj_export(filepath=" + python_text(to) + ")";
  return fmt::format(fmt::runtime(by.command), quoted(path), quoted(to), farcull::quoted(script));
}

// A 3DS file is one chunk: it begins with that chunk's number ("MM") and length. The number of the
// first chunk inside follows: that of the version, or of the editor's data.
bool is_3ds(std::string_view bytes) {
  if (bytes.size() < 16 || !bytes.starts_with("MM")) return false;
  const std::string_view chunk = bytes.substr(6, 2);
  return chunk == "\x02\0"sv || chunk == "\x3d\x3d"sv;
}

// No command may write to the file itself, or to another one that is there. A file with a wrong
// extension is renamed first, also because converters go by the extension.
Error refusal(const Foreign& format, const std::string& path, const char* how) {
  const bool packed = format.by.verb == kUnpack;
  const std::string_view extensions = format.extensions;
  const std::string own(extensions.substr(0, extensions.find(' ')));
  std::error_code error;
  const bool known =
      (std::string(extensions) + " ").find(lower_extension(path) + " ") != std::string::npos;
  std::string from = path, remedy, to = with_extension(path, format.by.extension);
  if (!known && *format.by.verb != '\0') {
    from = packed ? path + own : with_extension(path, own);
    if (std::filesystem::exists(from, error)) from = with_extension(path, "-renamed" + own);
    remedy =
        "rename it first: mv " + farcull::quoted(path) + " " + farcull::quoted(from) + ", then ";
  }
  if (to != path && std::filesystem::exists(to, error))
    to = with_extension(path, std::string("-converted") + format.by.extension);
  return Error(path,
               fmt::format("{}{}, which is not read ({})", how, format.name,
                           packed ? "gzip is" : "OBJ, OFF, PLY and STL are"),
               remedy + format.by.verb + command(format.by, from, to));
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
  // IFC is written in the form of STEP, and polygons of VTK in that of its grids.
  const std::size_t schema = bytes.find("FILE_SCHEMA");
  if (bytes.starts_with("ISO-10303-21") && schema != std::string_view::npos &&
      bytes.find("IFC", schema) != std::string_view::npos)
    return refusal(named("IFC"), path, "holds ");
  if (bytes.find("<VTKFile") != std::string_view::npos &&
      bytes.find("\"PolyData\"") != std::string_view::npos)
    return refusal(named("polygons of VTK"), path, "holds ");
  for (const Foreign& format : kForeign) {
    for (const std::string_view sign : format.signs) {
      const std::size_t at = sign.empty() ? std::string_view::npos : bytes.find(sign);
      if (at == 0 || (at != std::string_view::npos && sign.starts_with('<')))
        return refusal(format, path, "holds ");
    }
  }
  // bzip2 begins with BZh, one digit for the size of its blocks, and the first digits of pi.
  if (bytes.size() > 10 && bytes.starts_with("BZh") && bytes.substr(4, 3) == "1AY")
    return refusal(named("compressed by bzip2"), path, "holds ");
  if (is_3ds(bytes)) return refusal(named("3DS"), path, "holds ");
  if (bytes.starts_with("{") && bytes.find("\"asset\"") != std::string_view::npos)
    return refusal(named("glTF"), path, "holds ");
  return std::nullopt;
}

namespace {

// Larger files are refused. A file is read as a whole, so that the counts in it can be compared
// with its length.
constexpr std::uint64_t kMaxMeshBytes = std::uint64_t{4} << 30;

struct Reader {
  std::string_view extension;
  MeshFormat format;
  Mesh (*parse)(std::string_view bytes, const std::string& name);
};
// In the order of MeshFormat.
constexpr std::array<Reader, 4> kReaders = {{{".obj", MeshFormat::kObj, parse_obj},
                                             {".off", MeshFormat::kOff, parse_off},
                                             {".ply", MeshFormat::kPly, parse_ply},
                                             {".stl", MeshFormat::kStl, parse_stl}}};

std::optional<MeshFormat> find_format(const std::string& path) {
  std::string extension = lower_extension(path);
  if (extension.ends_with(".gz")) extension.resize(extension.size() - 3);
  const auto found = std::ranges::find(kReaders, extension, &Reader::extension);
  return found == kReaders.end() ? std::nullopt : std::optional(found->format);
}

// If parsing fails, the contents may be in a known format that is not read: the error says so.
Mesh parse_known(std::string_view bytes, MeshFormat format, const std::string& name) {
  try {
    if (bytes.empty()) throw Error(name, "the file is empty", "give a mesh with at least one face");
    return kReaders.at(static_cast<std::size_t>(format)).parse(bytes, name);
  } catch (const Error&) {
    if (const std::optional<Error> foreign = foreign_contents(bytes, name)) throw *foreign;
    throw;
  }
}

// ---- names of files with a place for a number

struct Place {
  std::size_t at = std::string::npos;  // of the %
  std::size_t size = 0;
  int digits = 1;
};

// The first place for a number, and whether it is the only one.
std::pair<Place, bool> place_in(const std::string& name) {
  Place found;
  int count = 0;
  for (std::size_t at = name.find('%'); at != std::string::npos; at = name.find('%', at + 1)) {
    const std::string rest = name.substr(at + 1, 3);
    Place place{.at = at};
    if (rest.starts_with('d')) {
      place.size = 2;
    } else if (rest.size() == 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' &&
               rest[2] == 'd') {
      place.size = 4;
      place.digits = rest[1] - '0';
    } else {
      continue;
    }
    if (count++ == 0) found = place;
  }
  return {found, count == 1};
}

// The absolute path without links; `path` itself if there is no such file. Calls the C library,
// since std::filesystem would hold several more paths at once.
std::string real_path(const std::string& path) {
#ifdef _WIN32
  char* const found = ::_fullpath(nullptr, path.c_str(), 0);
#else
  char* const found = ::realpath(path.c_str(), nullptr);
#endif
  const std::unique_ptr<char, void (*)(void*)> file(found, &std::free);
  return file ? file.get() : path;
}

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();

}  // namespace

MeshFormat named_format(const std::string& name) {
  const auto found = std::ranges::find(kReaders, "." + name, &Reader::extension);
  if (found != kReaders.end()) return found->format;
  throw Error("--format", quote_token(name) + " is no format", "give obj, off, ply or stl");
}

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

struct ReadingNotes {
  std::mutex mutex;
  std::vector<std::string> notes;
};
ReadingNotes& reading_notes() {
  static ReadingNotes made;
  return made;
}

void add_reading_notes(const std::string& path, const std::vector<std::string>& notes) {
  constexpr std::size_t kMost = 100;
  ReadingNotes& all = reading_notes();
  const std::lock_guard lock(all.mutex);
  for (const std::string& note : notes) {
    if (all.notes.size() < kMost) all.notes.push_back(path + ": " + note);
  }
}

}  // namespace

std::vector<std::string> take_reading_notes() {
  ReadingNotes& all = reading_notes();
  const std::lock_guard lock(all.mutex);
  return std::exchange(all.notes, {});
}

Mesh load_mesh(const std::string& path) {
  const MeshFormat format = mesh_format(path);
  try {
    std::string bytes = read_file(path, kMaxMeshBytes);
    if (lower_extension(path).ends_with(".gz") && !bytes.empty() && !is_gzip(bytes)) {
      throw Error(path, "is named .gz, but its contents are not compressed by gzip",
                  "rename it: without .gz it is read as what it holds");
    }
    Mesh mesh = parse_mesh(bytes, format, path);
    add_reading_notes(path, mesh.notes);
    return mesh;
  } catch (const std::bad_alloc&) {
    throw Error(path, "the mesh does not fit into memory", "split it or use a larger machine");
  }
}

Mesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name) {
  // The header of a binary STL file may begin with any bytes, those of gzip included.
  const bool compressed = is_gzip(bytes) && !(format == MeshFormat::kStl && is_binary_stl(bytes));
  if (!compressed) return parse_known(bytes, format, name);
  return parse_known(gunzip(bytes, name, {.max_bytes = kMaxMeshBytes}), format, name);
}

// ---- the builder

MeshBuilder::MeshBuilder(std::string name) : name_(std::move(name)) {}

void MeshBuilder::add_vertex(const Vec3& p, long line) {
  if (mesh_.vertices.size() == kMaxCount)
    throw Error(name_, "more than 4294967295 vertices", "split the mesh", line);
  if (!p.allFinite()) not_finite_[static_cast<std::uint32_t>(mesh_.vertices.size())] = line;
  mesh_.vertices.push_back(p);
}

void MeshBuilder::set_group(std::string_view group_name, std::string_view within) {
  const std::string group = group_name.empty() ? "default" : clean_name(group_name);
  const auto [entry, is_new] = groups_.try_emplace(fmt::format("{}\n{}", within, group),
                                                   static_cast<std::uint32_t>(groups_.size()));
  group_ = entry->second;
  if (!is_new) return;
  std::string name = group;
  while (!group_names_.insert(name).second)
    name = fmt::format("{}#{}", group, ++repeats_.try_emplace(group, 1).first->second);
  mesh_.group_names.push_back(name);
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners, long line) {
  if (corners.size() < 3) {
    throw Error(name_, fmt::format("face {} is a polygon with {} vertices", faces_, corners.size()),
                "give it 3 or more, or delete it", line);
  }
  std::vector<Vec3> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    if (corner >= mesh_.vertices.size()) {
      throw Error(name_,
                  fmt::format("face {} names vertex {} (counted from 0) of {}", faces_, corner,
                              mesh_.vertices.size()),
                  "correct the index, or see whether the file is damaged", line);
    }
    if (const auto bad = not_finite_.find(corner);
        !not_finite_.empty() && bad != not_finite_.end()) {
      throw Error(name_,
                  fmt::format("vertex {} (counted from 0) is not finite, and face {} uses it",
                              corner, faces_),
                  "give it finite coordinates that a double can hold", bad->second);
    }
    points.push_back(mesh_.vertices[corner]);
  }
  if (corners.size() - 2 > kMaxCount - mesh_.triangles.size())
    throw Error(name_, "more than 4294967295 triangles", "split the mesh", line);
  if (mesh_.group_names.empty()) set_group("");

  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(corners.size() - 2);
  const Triangulation made = triangulate(points, triangles);
  if (made == Triangulation::folded) mesh_.folded.push_back(faces_);
  if (made == Triangulation::too_large) {
    throw Error(name_,
                fmt::format("face {} is a polygon with {} vertices that is not convex, too large "
                            "to triangulate here",
                            faces_, corners.size()),
                "triangulate the mesh where it was made", line);
  }
  for (const auto& [a, b, c] : triangles) {
    mesh_.triangles.push_back({corners[a], corners[b], corners[c]});
    mesh_.source_face.push_back(faces_);
    mesh_.group.push_back(group_);
  }
  ++faces_;
}

Mesh MeshBuilder::finish() {
  if (mesh_.triangles.empty())
    throw Error(name_, "the mesh has no triangles", "give a mesh with at least one face");
  for (const auto& [vertex, line] : not_finite_) mesh_.vertices[vertex] = Vec3(0, 0, 0);
  if (!not_finite_.empty()) {
    note(counted(not_finite_.size(), "vertex that is", "vertices that are") +
         " not finite and that no face uses: passed over");
  }
  return std::move(mesh_);
}

// ---- the cache

bool is_numbered(const std::string& name) { return place_in(name).second; }

std::string numbered(const std::string& name, long number) {
  const Place place = place_in(name).first;
  return name.substr(0, place.at) + fmt::format("{:0{}}", number, place.digits) +
         name.substr(place.at + place.size);
}

Mesh MeshCache::read(const std::string& path) const {
  Mesh mesh;
  if (path == "-") {
    if (!reading_.format) {
      throw Error("-", "standard input does not say in which format it is",
                  "add --format obj, off, ply or stl");
    }
    mesh = parse_mesh(read_standard_input(kMaxMeshBytes), *reading_.format, "standard input");
    add_reading_notes("standard input", mesh.notes);
  } else {
    mesh = load_mesh(path);
  }
  if (reading_.weld.empty()) return mesh;
  const std::uint64_t merged = weld(mesh, parse_weld(reading_.weld));
  if (merged > 0) {
    add_reading_notes(path, {counted(merged, "vertex", "vertices") +
                             " merged with others that are at most " + reading_.weld + " away"});
  }
  return mesh;
}

const Mesh& MeshCache::get(const std::string& path) {
  if (frame_ && is_numbered(path)) {
    const std::string file = numbered(path, *frame_);
    const auto found = moving_.find(path);
    if (found == moving_.end())
      return moving_.emplace(path, Moving{*frame_, read(file)}).first->second.mesh;
    Moving& moving = found->second;
    if (moving.frame != *frame_) moving = {*frame_, read(file)};
    return moving.mesh;
  }
  std::error_code error;
  if (!frame_ && is_numbered(path) && !std::filesystem::exists(path, error)) {
    throw Error(
        path, "stands for numbered files, and it is not said which",
        "add --frames FIRST:LAST to farcull run or verify, as in --frames 1:100, or name one "
        "file");
  }
  const std::string key = real_path(path);
  auto entry = meshes_.find(key);
  if (entry == meshes_.end()) entry = meshes_.emplace(key, read(path)).first;
  return entry->second;
}

std::vector<std::string> MeshCache::numbered_paths() const {
  std::vector<std::string> out;
  for (const auto& [path, moving] : moving_) out.push_back(path);
  return out;
}

}  // namespace farcull
