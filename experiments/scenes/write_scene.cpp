// Writes a mesh for each object, and a scene file that names the meshes.
#include "experiments/scenes/scene_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

constexpr std::size_t kLongestName = 100;  // bytes, well below the limits of file systems

// Writes files to a folder. Unless keep() was called, the destructor removes the files and the
// folder that this object created.
class Folder {
 public:
  explicit Folder(const std::string& path) : path_(path) {
    std::error_code error;
    if (std::filesystem::is_directory(path_, error)) return;
    made_ = std::filesystem::create_directory(path_, error);
    if (made_) return;
    const std::string why = error ? error.message() : std::string(std::strerror(EEXIST));
    throw Error(path, "the folder cannot be made: " + why,
                "name one in a folder that is there and that you may write to");
  }
  ~Folder() {
    if (kept_) return;
    std::error_code error;
    for (const std::filesystem::path& file : added_) std::filesystem::remove(file, error);
    if (made_) std::filesystem::remove(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) {
    const std::filesystem::path file = path_ / name;
    std::error_code error;
    const bool there = std::filesystem::exists(std::filesystem::symlink_status(file, error));
    write_output(file.string(), text);
    if (!there) added_.push_back(file);
    ++written_.files;
    written_.bytes += text.size();
  }
  WrittenScene keep(const std::string& scene_file) {
    kept_ = true;
    written_.scene_file = (path_ / scene_file).string();
    return written_;
  }

 private:
  std::filesystem::path path_;
  bool made_ = false;
  bool kept_ = false;
  std::vector<std::filesystem::path> added_;
  WrittenScene written_;
};

// Returns a file name without extension for each object. No two names are equal.
std::vector<std::string> file_names(const Scene& scene) {
  std::vector<std::string> names;
  std::set<std::string> used;
  for (const Object& object : scene.objects) {
    std::string name = object.name.substr(0, kLongestName);
    for (char& c : name) {
      const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '-' || c == '.';
      if (!plain) c = '-';
    }
    if (name.empty() || name[0] == '.') name.insert(0, "object");
    std::string free = name;
    for (int n = 2; !used.insert(free).second; ++n) free = fmt::format("{}-{}", name, n);
    names.push_back(free);
  }
  return names;
}

MeshPart part_of(const Scene& scene, const Object& object, PartMaker& parts) {
  if (object.triangle_count == 0)
    throw std::logic_error("mesh_write: object '" + object.name + "' has no triangle");
  for (std::uint32_t t = 0; t < object.triangle_count; ++t)
    parts.add(scene.triangles[object.first_triangle + t]);
  return parts.take();
}

// Returns the names of each pair of ignored objects. Throws Error if two names match other pairs.
std::vector<std::pair<std::string, std::string>> ignored_names(const Scene& scene) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const ObjectPair& pair : scene.ignored) {
    const std::string &a = scene.objects[pair.a].name, &b = scene.objects[pair.b].name;
    if (pairs_between(scene, a, b, scene.name, "ignore") != std::vector{pair}) {
      throw Error(
          scene.name,
          fmt::format("the names '{}' and '{}' of two ignored objects fit others too", a, b),
          "give each object a name of its own, without *");
    }
    out.emplace_back(a, b);
  }
  return out;
}

}  // namespace

std::string scene_file_text(const std::string& name, const std::vector<SceneFileObject>& objects,
                            const std::vector<std::pair<std::string, std::string>>& ignored) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const SceneFileObject& object : objects) {
    Json& out = list.emplace_back(Json{{"name", object.name}, {"mesh", object.mesh}});
    if (object.self) out["self"] = true;
  }
  Json out = {{"name", name}, {"objects", list}};
  if (!ignored.empty()) out["ignore"] = ignored;
  return out.dump(2) + "\n";
}

WrittenScene write_scene(const Scene& scene, const std::string& folder) {
  Folder out(folder);
  PartMaker parts(scene.vertices);
  std::vector<SceneFileObject> objects;
  const std::vector<std::string> names = file_names(scene);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const std::string file = names[o] + ".off";
    out.write(file, off_text(part_of(scene, scene.objects[o], parts)));
    objects.push_back({.name = scene.objects[o].name, .mesh = file, .self = scene.objects[o].self});
  }
  out.write("scene.json", scene_file_text(scene.name, objects, ignored_names(scene)));
  return out.keep("scene.json");
}

}  // namespace farcull
