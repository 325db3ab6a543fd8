// Chooses a reader by the extension of the path, collects the faces that the reader finds, and
// caches meshes by their real paths.
#include "experiments/scenes/mesh/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

#include "core/base/text.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

// File formats that farcull cannot read, with advice to the user.
struct Foreign {
  const char* remedy;
  std::string_view extensions;
};
constexpr std::array<Foreign, 7> kForeign = {{
    {"convert it with assimp export (Debian: assimp-utils)",
     " .gltf .glb .fbx .dae .x3d .3ds .3mf .amf "},
    {"convert it with meshio convert (Debian: meshio-tools)",
     " .vtk .vtu .mesh .inp .bdf .nas .vol "},
    {"convert it with gmsh -2 -o FILE.stl (Debian: gmsh)",
     " .step .stp .p21 .brep .iges .igs .msh "},
    {"export it from Blender", " .usd .usda .usdc .usdz .abc .blend .wrl .vrml "},
    {"unpack it; gzip alone is read", " .xz .zst .zip .bz2 "},
    {"name the meshes that it names, or write a scene file (farcull help scene-file)", " .urdf "},
    {"export it as STL or OBJ from a program that opens it",
     " .ifc .vtp .fcstd .sldprt .sldasm .x_t .x_b .ipt .iam .catpart .catproduct .prt .sat .3dm "
     ".jt .dxf .dwg .skp "},
}};

bool is_compressed(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string()) == ".gz";
}

std::filesystem::path plain_name(const std::string& path) {
  const std::filesystem::path name(path);
  return is_compressed(path) ? name.stem() : name.filename();
}

std::string extension_of(const std::string& path) {
  return lower_case(plain_name(path).extension().string());
}

// Larger files are refused, since a file is read into memory as a whole.
constexpr std::uint64_t kMaxMeshBytes = std::uint64_t{4} << 30;

struct Reader {
  std::string_view extension;
  Mesh (*parse)(std::string_view bytes, const std::string& name);
};
// Readers in the order of the enumerators of MeshFormat.
constexpr std::array<Reader, 4> kReaders = {
    {{".obj", parse_obj}, {".off", parse_off}, {".ply", parse_ply}, {".stl", parse_stl}}};

std::optional<MeshFormat> find_format(const std::string& extension) {
  const auto found = std::ranges::find(kReaders, extension, &Reader::extension);
  if (found == kReaders.end()) return std::nullopt;
  return static_cast<MeshFormat>(found - kReaders.begin());
}

Mesh parse_known(std::string_view bytes, MeshFormat format, const std::string& name) {
  if (bytes.empty()) throw Error(name, "the file is empty", "give a mesh with at least one face");
  return kReaders.at(static_cast<std::size_t>(format)).parse(bytes, name);
}

// A placeholder for a number in a file name: %d, or %0Nd with a digit N.
struct Place {
  std::size_t at = std::string::npos;  // position of the %
  std::size_t size = 0;
  int digits = 1;
};

// Returns the first placeholder in a name, and true if the name has exactly one placeholder.
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

// Returns the absolute path without symbolic links, or `path` itself if the file does not exist.
// Calls realpath(), since std::filesystem would need memory for several copies of a long path.
std::string real_path(const std::string& path) {
  const std::unique_ptr<char, void (*)(void*)> file(::realpath(path.c_str(), nullptr), &std::free);
  return file ? file.get() : path;
}

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();

struct ReadingNotes {
  std::mutex mutex;
  std::vector<std::string> notes;
};
ReadingNotes& reading_notes() {
  static ReadingNotes made;
  return made;
}

}  // namespace

std::string mesh_stem(const std::string& path) { return plain_name(path).stem().string(); }

std::optional<Error> foreign_mesh(const std::string& path) {
  const std::string extension = extension_of(path);
  for (const Foreign& format : kForeign) {
    if (extension.empty() || format.extensions.find(" " + extension + " ") == std::string::npos)
      continue;
    return Error(path, "is a " + extension + " file; OBJ, OFF, PLY and STL are read",
                 format.remedy);
  }
  return std::nullopt;
}

MeshFormat named_format(const std::string& name) {
  if (const std::optional<MeshFormat> format = find_format("." + name)) return *format;
  throw Error("--format", quote_token(name) + " is no format", "give obj, off, ply or stl");
}

MeshFormat mesh_format(const std::string& path) {
  const std::string extension = extension_of(path);
  if (const std::optional<MeshFormat> format = find_format(extension)) return *format;
  if (const std::optional<Error> foreign = foreign_mesh(path)) throw *foreign;
  if (is_compressed(path) && extension.empty()) {
    throw Error(path, "a compressed mesh needs the extension of its format before .gz",
                "name it as in bunny.obj.gz");
  }
  throw Error(path,
              extension.empty() ? "a mesh file needs an extension that names its format"
                                : "no mesh format is known by the extension " +
                                      quote_token(extension + (is_compressed(path) ? ".gz" : "")),
              "give a file that ends in .obj, .off, .ply or .stl, or in one of these and .gz");
}

bool has_mesh_extension(const std::string& path) {
  return find_format(extension_of(path)).has_value();
}

void add_reading_notes(const std::string& path, const std::vector<std::string>& notes) {
  constexpr std::size_t kMost = 100;
  ReadingNotes& all = reading_notes();
  const std::lock_guard lock(all.mutex);
  for (const std::string& note : notes) {
    if (all.notes.size() < kMost) all.notes.push_back(path + ": " + note);
  }
}

std::vector<std::string> take_reading_notes() {
  ReadingNotes& all = reading_notes();
  const std::lock_guard lock(all.mutex);
  return std::exchange(all.notes, {});
}

Mesh load_mesh(const std::string& path) {
  const MeshFormat format = mesh_format(path);
  try {
    std::string bytes = read_file(path, kMaxMeshBytes);
    if (is_compressed(path) && !bytes.empty() && !is_gzip(bytes)) {
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
  // The header of a binary STL file may hold any bytes, even the magic number of gzip.
  const bool compressed = is_gzip(bytes) && !(format == MeshFormat::kStl && is_binary_stl(bytes));
  if (!compressed) return parse_known(bytes, format, name);
  return parse_known(gunzip(bytes, name, {.max_bytes = kMaxMeshBytes}), format, name);
}

MeshBuilder::MeshBuilder(std::string name, std::uint32_t first)
    : name_(std::move(name)), first_(first) {}

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
                  fmt::format("vertex {} (counted from {}) is not finite, and face {} uses it",
                              corner + first_, first_, faces_ + first_),
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
    throw Error(path, "stands for numbered files, and it is not said which",
                "add --frames FIRST:LAST, as in --frames 1:100, or name one file");
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
