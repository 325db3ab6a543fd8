// Two paths are one file where device and inode are equal, links followed. A file that is still to
// be made is known by its folder's device and inode, and its name.
#include "experiments/command/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "core/base/error.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "standard output";

// The file of a path. A file that is still to be made is known by its folder and its name.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  std::string name;      // empty where the file exists
  bool regular = false;  // or still to be made

  using Key = std::tuple<dev_t, ino_t, std::string>;
  Key key() const { return {device, inode, name}; }
};

// The file that writing to the path makes: a link to a file that is not there leads on to that
// file. Beyond kMostLinks, where the system gives up, whatever is left.
fs::path made_by(fs::path path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;  // the target alone where it is absolute
  }
  return path;
}

std::optional<Identity> identity_of(const std::string& path) {
  struct stat status = {};
  const int found = path == "-" ? ::fstat(STDOUT_FILENO, &status) : ::stat(path.c_str(), &status);
  if (found == 0) return Identity{status.st_dev, status.st_ino, "", S_ISREG(status.st_mode)};
  if (path == "-") return std::nullopt;
  const fs::path file = made_by(path);
  const std::string folder = file.parent_path().empty() ? "." : file.parent_path().string();
  if (::stat(folder.c_str(), &status) != 0) return std::nullopt;
  return Identity{status.st_dev, status.st_ino, file.filename().string(), true};
}

// Whether a built-in scene, whatever its numbers and suffixes, is made of packaged meshes.
bool needs_meshes(const std::string& name) {
  const BuiltinScene* const scene = find_builtin_scene(name);
  return scene != nullptr && scene->needs_meshes;
}

std::string shown(const NamedFile& file) { return file.path == "-" ? kStandardOutput : file.path; }

}  // namespace

std::vector<std::string> numbered_files(const std::string& path,
                                        const std::optional<FrameRange>& range) {
  if (!range || !is_numbered(path)) return {path};
  std::vector<std::string> out;
  for (long frame = range->first; frame <= range->last; ++frame)
    out.push_back(numbered(path, frame));
  return out;
}

std::vector<NamedFile> scene_files(const std::vector<std::string>& arguments,
                                   const std::optional<FrameRange>& range) {
  std::vector<NamedFile> out;
  const auto add = [&](const std::string& path) { out.push_back({"SCENE", path}); };
  const auto add_mesh = [&](const std::string& path) {
    for (const std::string& file : numbered_files(path, range)) add(file);
  };
  const auto add_packaged = [&] {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(mesh_folder(), error)) {
      if (has_mesh_extension(entry.path().string())) add(entry.path().string());
    }
  };
  if (arguments.empty()) add_packaged();
  for (const std::string& argument : arguments) {
    if (is_builtin_scene(argument)) {
      if (needs_meshes(argument)) add_packaged();
    } else if (is_scene_file(argument)) {
      add(argument);
      for (const std::string& mesh : meshes_of_scene_file(argument)) add_mesh(mesh);
    } else {
      add_mesh(argument);
    }
  }
  return out;
}

void require_not_read(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
  std::map<Identity::Key, const NamedFile*> written;  // the first output of each file
  for (const NamedFile& output : outputs) {
    const std::optional<Identity> identity = identity_of(output.path);
    if (identity && identity->regular && identity->name.empty())
      written.try_emplace(identity->key(), &output);
  }
  if (written.empty()) return;
  for (const NamedFile& input : inputs) {
    const std::optional<Identity> read = identity_of(input.path);
    if (!read) continue;
    const auto found = written.find(read->key());
    if (found == written.end()) continue;
    const NamedFile& output = *found->second;
    throw Error(output.by,
                shown(output) + " is " + input.path + ", which " + input.by +
                    " reads, and would be overwritten",
                "choose another place for " + output.by);
  }
}

void require_apart(const std::vector<NamedFile>& inputs, std::vector<NamedFile> outputs) {
  const bool named = std::any_of(outputs.begin(), outputs.end(),
                                 [](const NamedFile& file) { return file.path == "-"; });
  if (!named) outputs.insert(outputs.begin(), {kStandardOutput, "-"});
  std::map<Identity::Key, const NamedFile*> files;
  const NamedFile* standard_output = nullptr;
  for (const NamedFile& output : outputs) {
    const std::optional<Identity> identity = identity_of(output.path);
    const NamedFile* other = nullptr;
    if (identity && identity->regular) {
      const auto [place, is_new] = files.try_emplace(identity->key(), &output);
      if (!is_new) other = place->second;
    }
    if (output.path == "-") {
      if (standard_output != nullptr) other = standard_output;
      standard_output = &output;
    }
    if (other == nullptr) continue;
    throw Error(output.by,
                shown(output) + " is " + shown(*other) + ", where " + other->by + " goes as well",
                "give each output a place of its own");
  }
  require_not_read(inputs, outputs);
}

}  // namespace farcull
