// Writes a mesh for each object, and a scene file that names the meshes.
#include "experiments/scenes/write_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/system/output_file.h"

namespace farcull {

namespace {

constexpr std::size_t kLongestName = 100;  // bytes, well below what file systems take

// Writes files to a folder. The destructor removes what is new unless keep() was called.
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

// A unique name for each object, valid for a file and a group; without '_', which precedes the
// number of a frame.
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

// The triangles of an object.
MeshPart part_of(const Scene& scene, const Object& object, PartMaker& parts) {
  if (object.triangle_count == 0)
    throw std::logic_error("mesh_write: object '" + object.name + "' has no triangle");
  for (std::uint32_t t = 0; t < object.triangle_count; ++t)
    parts.add(scene.triangles[object.first_triangle + t]);
  return parts.take();
}

// An OBJ file with all objects as groups.
std::string obj_text(const Scene& scene) {
  std::string out;
  const std::vector<std::string> names = file_names(scene);
  PartMaker parts(scene.vertices);
  std::uint64_t first = 1;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const MeshPart part = part_of(scene, scene.objects[o], parts);
    out += obj_object(part, names[o], first);
    first += part.vertices.size();
  }
  return out;
}

// The pairs of ignored objects, by the names that a scene file gives them.
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

WrittenScene write_groups(const std::function<const Scene&(long)>& at, FrameRange range,
                          const std::string& folder, const Progress& progress) {
  Folder out(folder);
  std::string name, scene_name;
  bool self = false;
  for (long frame = range.first; frame <= range.last; ++frame) {
    if (progress) progress(fmt::format("writing frame {}", frame));
    const Scene& scene = at(frame);
    if (frame == range.first) {
      scene_name = scene.name;
      name = scene_name.substr(0, scene_name.find_first_of(":@"));
      self = !scene.objects.empty() && scene.objects[0].self;
    }
    require_nothing_ignored(scene, "a scene of objects that come and go");
    for (const Object& object : scene.objects) {
      if (object.self == self) continue;
      throw Error(scene.name, "objects come and go and only some are tested against themselves",
                  "write single frames, or leave --frames out");
    }
    out.write(fmt::format("{}_{:04}.obj", name, frame), obj_text(scene));
  }
  out.write("scene.json",
            scene_file_text(scene_name, {{name, name + "_%04d.obj", true, self}}, {}));
  return out.keep("scene.json");
}

// Writes the objects of frames: one file for every frame, or one in all if the object never moves.
class FrameFiles {
 public:
  FrameFiles(const std::string& folder, FrameRange range) : out_(folder), range_(range) {}

  void add(const Scene& scene, long frame) {
    if (frame == range_.first) {
      scene_name_ = scene.name;
      objects_ = scene.objects;
      ignored_ = ignored_names(scene);
      names_ = file_names(scene);
      meshes_.resize(names_.size());
    }
    const auto same = [](const Object& a, const Object& b) {
      return a.name == b.name && a.self == b.self;
    };
    if (!std::equal(objects_.begin(), objects_.end(), scene.objects.begin(), scene.objects.end(),
                    same) ||
        ignored_ != ignored_names(scene)) {
      throw std::logic_error("write_frames: the objects change");
    }
    PartMaker parts(scene.vertices);
    for (std::size_t o = 0; o < objects_.size(); ++o)
      add(o, off_text(part_of(scene, scene.objects[o], parts)), frame);
  }

  WrittenScene finish() {
    // A scene file of frames must name at least one numbered mesh.
    const bool none =
        std::none_of(meshes_.begin(), meshes_.end(), [](const Mesh& m) { return m.moves; });
    std::vector<SceneFileObject> list;
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      if (none) number_from_first(o, range_.last + 1);
      const bool moves = meshes_[o].moves;
      if (!moves) out_.write(names_[o] + ".off", meshes_[o].first);
      list.push_back({.name = objects_[o].name,
                      .mesh = names_[o] + (moves ? "_%04d.off" : ".off"),
                      .self = objects_[o].self});
    }
    out_.write("scene.json", scene_file_text(scene_name_, list, ignored_));
    return out_.keep("scene.json");
  }

 private:
  struct Mesh {
    std::string first;  // text of the first frame; dropped once another frame differs
    bool moves = false;
  };

  void add(std::size_t object, std::string text, long frame) {
    Mesh& mesh = meshes_[object];
    if (frame == range_.first) {
      mesh.first = std::move(text);
      return;
    }
    if (!mesh.moves) {
      if (text == mesh.first) return;
      number_from_first(object, frame);
    }
    out_.write(numbered_name(object, frame), text);
  }

  // Writes the text of the first frame for all frames before `end`.
  void number_from_first(std::size_t object, long end) {
    for (long frame = range_.first; frame < end; ++frame)
      out_.write(numbered_name(object, frame), meshes_[object].first);
    meshes_[object] = {"", true};
  }

  std::string numbered_name(std::size_t object, long frame) const {
    return fmt::format("{}_{:04}.off", names_[object], frame);
  }

  Folder out_;
  FrameRange range_;
  std::string scene_name_;
  std::vector<Object> objects_;
  std::vector<std::pair<std::string, std::string>> ignored_;
  std::vector<std::string> names_;
  std::vector<Mesh> meshes_;
};

}  // namespace

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

WrittenScene write_frames(const std::function<const Scene&(long)>& at, FrameRange range,
                          bool objects_change, const std::string& folder,
                          const Progress& progress) {
  if (objects_change) return write_groups(at, range, folder, progress);
  FrameFiles files(folder, range);
  for (long frame = range.first; frame <= range.last; ++frame) {
    if (progress) progress(fmt::format("writing frame {}", frame));
    files.add(at(frame), frame);
  }
  return files.finish();
}

}  // namespace farcull
