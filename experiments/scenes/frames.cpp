// Frames come from a built-in motion, or from meshes that are read again for each frame.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/scene.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"

namespace farcull {

namespace {

constexpr long kMostFrames = 1'000'000;
constexpr long kLastFrame = 1'000'000'000;

bool same_objects(const std::vector<Object>& a, const std::vector<Object>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Object& x, const Object& y) {
    return x.triangle_count == y.triangle_count && x.self == y.self;
  });
}

}  // namespace

FrameRange parse_frames(const std::string& text) {
  const Error bad(
      "--frames", "'" + text + "' is no range of frames",
      fmt::format("give a number from 1 to {}, or first:last, as in 1:100", kMostFrames));
  const auto number = [&](const std::string& part) {
    const std::optional<long> value = parse_number<long>(part);
    if (!value || *value < 0) throw bad;
    return *value;
  };
  FrameRange range;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    range.last = number(text) - 1;
  } else {
    range.first = number(text.substr(0, colon));
    range.last = number(text.substr(colon + 1));
  }
  if (range.last < range.first || range.last > kLastFrame ||
      range.last - range.first >= kMostFrames) {
    throw bad;
  }
  return range;
}

FrameSource::FrameSource(SceneArguments arguments, FrameRange range, bool self)
    : arguments_(std::move(arguments)), range_(range), self_(self), meshes_(range.first) {
  const std::vector<std::string>& names = arguments_.names;
  const bool built_in = names.size() == 1 && is_builtin_scene(names[0]);
  require_meshes(arguments_);
  if (built_in && has_motion(names[0])) {
    built_in_.emplace(names[0], range.last + 1, self);
    return;
  }
  if (!built_in) scene_ = load_scene(arguments_, meshes_);
  const std::vector<std::string> paths = meshes_.numbered_paths();
  if (paths.empty()) {
    throw Error("--frames", "nothing in the scene moves",
                "put %d or %04d in place of the number in the name of a mesh, or name one of " +
                    moving_names());
  }
}

FrameSource::FrameSource(MovingScene moving) : built_in_(std::move(moving)) {}

const Scene& FrameSource::at(long frame) {
  if (!built_in_) {
    meshes_.set_frame(frame);
    if (const std::optional<Error> error = missing_at(frame)) throw *error;
    Scene now = load_scene(arguments_, meshes_);
    if (now.triangles == scene_.triangles) now.triangles.swap(scene_.triangles);
    scene_ = std::move(now);
    for (Object& object : scene_.objects) object.self = object.self || self_;
  } else if (arguments_.ignore) {
    scene_ = built_in_->at(frame);  // the copies stay in the same memory
    ignore_more(scene_, arguments_, first_ ? Lacking::refused : Lacking::passed_over);
  }
  const Scene& scene = built_in_ && !arguments_.ignore ? built_in_->at(frame) : scene_;
  const bool same = vertices_ == scene.vertices.size() && triangles_ == scene.triangles &&
                    same_objects(objects_, scene.objects);
  changed_ = !same && !first_;
  first_ = false;
  if (!same) {
    vertices_ = scene.vertices.size();
    triangles_ = scene.triangles;
    objects_ = scene.objects;
  }
  return scene;
}

std::optional<Error> FrameSource::missing_at(long frame) const {
  for (const std::string& path : meshes_.numbered_paths()) {
    const std::string file = numbered(path, frame);
    std::error_code error;
    if (std::filesystem::exists(file, error)) continue;
    return Error(
        file, "the file does not exist",
        fmt::format("give the numbers that there are: --frames FIRST:LAST instead of {}:{}",
                    range_.first, range_.last));
  }
  return std::nullopt;
}

std::optional<Error> FrameSource::missing() const {
  if (meshes_.numbered_paths().empty()) return std::nullopt;
  for (long frame = range_.first; frame <= range_.last; ++frame) {
    if (std::optional<Error> error = missing_at(frame)) return error;
  }
  return std::nullopt;
}

FrameNotes FrameSource::notes() const {
  if (!built_in_) return {};
  return {.values = built_in_->notes(), .warning = built_in_->warning()};
}

// Finds by their names the objects that are not tested against each other. Writes scenes: a mesh
// for each object, and a scene file that names the meshes.

namespace {

// Names are looked up in each scene: the names of objects may differ from frame to frame.

constexpr const char* kRemedy =
    "give two names of objects with a colon between, as in a:b or link*:gripper; a name is that of "
    "the mesh file without its ending, or that in the scene file";

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Whether the name matches a pattern, in which a * stands for any characters. After a mismatch,
/// the last * takes one character more.
bool fits(std::string_view name, std::string_view pattern) {
  std::size_t n = 0, p = 0, star = std::string_view::npos, from = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++n, ++p;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++from;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::vector<std::uint32_t> objects_of(const Scene& scene, std::string_view pattern) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    if (fits(scene.objects[o].name, pattern)) out.push_back(o);
  }
  return out;
}

/// Whether the pattern is ambiguous: it is the name of an object and also matches others.
bool doubtful(const Scene& scene, std::string_view pattern,
              const std::vector<std::uint32_t>& objects) {
  return std::ranges::any_of(objects,
                             [&](std::uint32_t o) { return scene.objects[o].name == pattern; }) &&
         !std::ranges::all_of(objects,
                              [&](std::uint32_t o) { return scene.objects[o].name == pattern; });
}

constexpr const char* kDoubtful = "is the name of an object, and as a pattern fits others too";

std::string some_names(const Scene& scene) {
  constexpr std::size_t kShown = 5;
  std::string out;
  for (std::size_t o = 0; o < std::min(kShown, scene.objects.size()); ++o)
    out += (o > 0 ? ", " : "") + scene.objects[o].name;
  return out + (scene.objects.size() > kShown ? ", ..." : "");
}

/// All pairs of an object of `first` and a different object of `second`.
std::vector<ObjectPair> pairs_of(const std::vector<std::uint32_t>& first,
                                 const std::vector<std::uint32_t>& second) {
  std::vector<ObjectPair> out;
  for (const std::uint32_t a : first) {
    for (const std::uint32_t b : second) {
      if (a != b) out.push_back({a, b});
    }
  }
  return in_order(std::move(out));
}

constexpr const char* kOneObject = "names one object; only --self tests an object against itself";

/// Appends the pairs of objects that names.text stands for.
void append(const Scene& scene, const IgnoredNames& names, Lacking lacking,
            std::vector<ObjectPair>& out) {
  const std::string_view text = names.text;
  const auto fail = [&](const std::string& reason) {
    throw Error(names.where, fmt::format("'{}' {}", names.text, reason),
                fmt::format("{}; the scene has {}", kRemedy, some_names(scene)), names.line);
  };
  std::vector<std::uint32_t> first, second;
  std::string unknown;
  int places = 0;
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos;
       colon = text.find(':', colon + 1)) {
    const std::string_view left = text.substr(0, colon), right = text.substr(colon + 1);
    const std::vector<std::uint32_t> a = objects_of(scene, left), b = objects_of(scene, right);
    if (a.empty() || b.empty()) {
      if (unknown.empty()) unknown = a.empty() ? left : right;
      continue;
    }
    ++places;
    first = a;
    second = b;
    for (const auto& [name, objects] : {std::pair(left, a), std::pair(right, b)}) {
      if (doubtful(scene, name, objects))
        fail(fmt::format("names '{}', which {}", name, kDoubtful));
    }
  }
  if (text.find(':') == std::string_view::npos) fail("has no colon");
  if (lacking == Lacking::passed_over && (places == 0 || (first.size() == 1 && first == second)))
    return;
  if (places == 0) fail(fmt::format("names '{}', and no object is called so", unknown));
  if (places > 1) fail("can be divided at more than one colon");
  if (first.size() == 1 && first == second) fail(kOneObject);
  const std::vector<ObjectPair> pairs = pairs_of(first, second);
  out.insert(out.end(), pairs.begin(), pairs.end());
}

}  // namespace

std::vector<ObjectPair> pairs_between(const Scene& scene, const std::string& first,
                                      const std::string& second, const std::string& where,
                                      const std::string& what, long line, Lacking lacking) {
  const auto objects = [&](const std::string& pattern) {
    std::vector<std::uint32_t> out = objects_of(scene, pattern);
    if (doubtful(scene, pattern, out)) {
      throw Error(where, fmt::format("{} names '{}', which {}", what, pattern, kDoubtful),
                  "call the object something without a *", line);
    }
    if (!out.empty() || lacking == Lacking::passed_over) return out;
    throw Error(where, fmt::format("{} names '{}', and no object is called so", what, pattern),
                "give names of objects, in which * stands for any characters; the scene has " +
                    some_names(scene),
                line);
  };
  const std::vector<std::uint32_t> a = objects(first), b = objects(second);
  if (a.size() == 1 && a == b && lacking == Lacking::refused) {
    throw Error(where, fmt::format("{} names '{}' alone", what, scene.objects[a[0]].name),
                "give two different objects; whether an object is tested against itself is said "
                "by self",
                line);
  }
  return pairs_of(a, b);
}

std::vector<IgnoredNames> parse_ignored(const std::string& list) {
  std::vector<IgnoredNames> out;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    out.push_back({list.substr(begin, end - begin), "--ignore"});
    if (out.back().text.empty()) throw Error("--ignore", "a pair of names is empty", kRemedy);
    begin = end + 1;
  }
  return out;
}

std::vector<IgnoredNames> read_ignored(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path, "cannot be read", "name a text file with a pair of names a line");
  std::vector<IgnoredNames> out;
  long line = 0;
  for (std::string text; std::getline(file, text);) {
    ++line;
    if (line == 1 && text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    if (text.ends_with('\r')) text.pop_back();
    if (!text.empty() && !text.starts_with('#')) out.push_back({text, path, line});
  }
  if (!file.eof()) throw Error(path, "cannot be read to its end", "name a text file", line);
  if (out.empty()) throw Error(path, "names no pair of objects", kRemedy);
  return out;
}

std::vector<IgnoredNames> ignored_names(const std::optional<std::string>& list,
                                        const std::optional<std::string>& file) {
  std::vector<IgnoredNames> out;
  if (list) out = parse_ignored(*list);
  if (!file) return out;
  for (IgnoredNames& names : read_ignored(*file)) out.push_back(std::move(names));
  return out;
}

std::vector<ObjectPair> ignored_objects(const Scene& scene, const std::vector<IgnoredNames>& names,
                                        Lacking lacking) {
  std::vector<ObjectPair> out;
  for (const IgnoredNames& one : names) append(scene, one, lacking, out);
  return in_order(std::move(out));
}

void ignore_more(Scene& scene, const SceneArguments& arguments, Lacking lacking) {
  for (const ObjectPair& pair :
       ignored_objects(scene, ignored_names(arguments.ignore, {}), lacking))
    scene.ignored.push_back(pair);
  scene.ignored = in_order(std::move(scene.ignored));
}

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

// A unique name for each object, valid for a file.
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

}  // namespace farcull
