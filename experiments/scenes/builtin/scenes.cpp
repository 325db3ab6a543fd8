// Lists the scenes of all generators, reads names with their numbers and suffixes, and calls the
// motion of a scene for each frame.
#include "experiments/scenes/builtin/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/view/view.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr const char* kSeedSuffix = "@seed";

// The first number of a name, or the usual one.
std::uint64_t size_of(const BuiltinScene& entry, const std::string& name, const std::string& word) {
  const SceneSize& range = *entry.size;
  const std::optional<std::uint64_t> size = parse_number<std::uint64_t>(word);
  if (!size || *size < range.least || *size > range.most) {
    throw Error(name, quote_token(word) + " is no number of " + range.what,
                fmt::format("give {} to {}, as in {}:{}", range.least, range.most, entry.name,
                            range.usual));
  }
  return *size;
}

double second_of(const BuiltinScene& entry, const std::string& name, const std::string& word) {
  const SceneSecond& range = *entry.second;
  const std::optional<double> value = parse_number<double>(word);
  // Written so that NaN is refused.
  if (!value || !(*value >= range.least && *value <= range.most)) {
    throw Error(name, quote_token(word) + " is no " + range.what,
                fmt::format("give {:g} to {:g}, as in {}:{}:{:g}", range.least, range.most,
                            entry.name, entry.size->usual, range.usual));
  }
  return *value;
}

// The numbers in NAME:SIZE:SECOND. Throws Error naming the scene.
SceneParameters parameters_of(const BuiltinScene& entry, const std::string& name) {
  const std::vector<std::string> words = split_list(name.substr(0, name.find('@')), ':');
  SceneParameters out = entry.usual();
  if (words.size() > 1 && !entry.size)
    throw Error(name, entry.name + " comes in one size", "leave out what follows the colon");
  if (words.size() > 2 && !entry.second)
    throw Error(name, entry.name + " takes one number", "leave out what follows the second colon");
  if (words.size() > 3)
    throw Error(name, entry.name + " takes two numbers", "leave out what follows the third colon");
  if (words.size() > 1) out.size = size_of(entry, name, words[1]);
  if (words.size() > 2) out.second = second_of(entry, name, words[2]);
  return out;
}

std::string suffix_names() {
  std::string names;
  for (const SceneSuffix& suffix : scene_suffixes())
    names += (names.empty() ? "" : ", ") + suffix.suffix;
  return names + " or, for scenes that are drawn, " + kSeedSuffix + "N";
}

// The number of @seedN. Throws Error naming the scene.
std::uint64_t seed_of_suffix(const BuiltinScene& entry, const std::string& name,
                             const std::string& word) {
  if (!entry.seed) {
    throw Error(name, "nothing in " + entry.name + " is random",
                "leave " + quote_token(word) + " out");
  }
  const auto seed = parse_number<std::uint64_t>(word.substr(std::string_view(kSeedSuffix).size()));
  if (!seed || *seed == 0)
    throw Error(name, quote_token(word) + " has no seed", "give 1 or more, as in @seed7");
  return *seed;
}

}  // namespace

SceneParameters BuiltinScene::usual() const {
  return {.size = size ? size->usual : 0, .second = second ? second->usual : 0};
}

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> scenes = [] {
    std::vector<BuiltinScene> all;
    for (const auto group : {generated_scenes, bench_scenes, contact_scenes, paper_scenes,
                             extreme_scenes, packaged_scenes}) {
      for (BuiltinScene& scene : group()) all.push_back(std::move(scene));
    }
    return all;
  }();
  return scenes;
}

const BuiltinScene* find_builtin_scene(const std::string& name) {
  const std::string_view base = std::string_view(name).substr(0, name.find_first_of(":@"));
  const auto& scenes = builtin_scenes();
  const auto found = std::find_if(scenes.begin(), scenes.end(),
                                  [&](const BuiltinScene& scene) { return scene.name == base; });
  return found == scenes.end() ? nullptr : &*found;
}

bool is_builtin_scene(const std::string& name) { return find_builtin_scene(name) != nullptr; }

std::optional<std::uint64_t> builtin_seed(const std::string& name) {
  const BuiltinScene* const entry = find_builtin_scene(name);
  if (entry == nullptr) return {};
  const std::optional<std::uint64_t> given = parse_scene_name(name).parameters.seed;
  return given ? given : entry->seed;
}

SceneRequest parse_scene_name(const std::string& name) {
  SceneRequest out{.entry = find_builtin_scene(name), .parameters = {}, .suffixes = {}};
  if (out.entry == nullptr)
    throw Error(name, "no built-in scene has this name", "see farcull scenes for the names");
  out.parameters = parameters_of(*out.entry, name);
  for (std::size_t at = std::min(name.find('@'), name.size()); at < name.size();) {
    const std::size_t end = std::min(name.find('@', at + 1), name.size());
    const std::string word = name.substr(at, end - at);
    at = end;
    if (word.starts_with(kSeedSuffix)) {
      if (out.parameters.seed) throw Error(name, "has two seeds", "give @seedN once");
      out.parameters.seed = seed_of_suffix(*out.entry, name, word);
      continue;
    }
    const auto& known = scene_suffixes();
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const SceneSuffix& s) { return s.suffix == word; });
    if (found == known.end())
      throw Error(name, quote_token(word) + " is no suffix of scenes", "use " + suffix_names());
    out.suffixes.push_back(&*found);
  }
  return out;
}

Scene make_builtin_scene(const std::string& name) {
  const SceneRequest request = parse_scene_name(name);
  Scene scene = request.entry->build(request.parameters).scene;
  scene.name = name;
  for (const SceneSuffix* suffix : request.suffixes) apply(suffix->change(scene), scene);
  return scene;
}

namespace {

SceneChange moved_far(const Scene& scene) {
  const double step = 1e6 * diagonal(bounds(scene)) / std::sqrt(3.0);
  return {.scale = 1, .translate = Vec3::Constant(step), .ground = {}};
}

SceneChange on_ground(const Scene& scene) {
  const Box box = bounds(scene);
  assert(!box.is_empty());
  return {.ground = shapes::square(centre(box), 1000 * diagonal(box))};
}

}  // namespace

const std::vector<SceneSuffix>& scene_suffixes() {
  static const std::vector<SceneSuffix> suffixes = {
      {"@far", "moved by 1e6 of its diagonals along (1, 1, 1)", moved_far},
      {"@tiny", "scaled by 1e-6", [](const Scene&) { return SceneChange{.scale = 1e-6}; }},
      {"@huge", "scaled by 1e6", [](const Scene&) { return SceneChange{.scale = 1e6}; }},
      {"@ground", "with a ground of two triangles a thousand times larger", on_ground},
  };
  return suffixes;
}

void apply(const SceneChange& change, Scene& scene) {
  if (change.scale != 1 || !change.translate.isZero(0)) {
    for (Vec3& p : scene.vertices) p = change.scale * p + change.translate;
  }
  if (change.ground) {
    const auto vertex = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.insert(scene.vertices.end(), change.ground->begin(), change.ground->end());
    scene.objects.push_back({"ground", static_cast<std::uint32_t>(scene.triangles.size()), 2});
    scene.triangles.push_back({vertex, vertex + 1, vertex + 2});
    scene.triangles.push_back({vertex, vertex + 2, vertex + 3});
    scene.source_face.insert(scene.source_face.end(), {0, 1});
  }
  validate(scene, scene.name);
}

Scene transformed(Scene scene, double scale, const Vec3& translate) {
  apply({.scale = scale, .translate = translate, .ground = {}}, scene);
  return scene;
}

namespace {

BuiltScene built_for(const SceneRequest& request, const std::string& name) {
  if (request.entry->motion.empty())
    throw Error(name, "nothing in the scene moves", "name one of " + moving_names());
  BuiltScene built = request.entry->build(request.parameters);
  built.scene.name = name;
  return built;
}

}  // namespace

bool has_motion(const std::string& name) {
  const BuiltinScene* const entry = find_builtin_scene(name);
  return entry != nullptr && !entry->motion.empty();
}

std::string moving_names() {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (!scene.motion.empty()) names += (names.empty() ? "" : ", ") + scene.name;
  }
  return names;
}

MovingScene::MovingScene(BuiltScene built, long frames, bool self)
    : frames_(frames),
      self_(self),
      motion_(std::move(built.motion)),
      plain_(std::move(built.scene)) {
  assert(frames >= 1 && motion_);
}

MovingScene::MovingScene(const std::string& name, long frames, bool self)
    : MovingScene(built_for(parse_scene_name(name), name), frames, self) {
  const SceneRequest request = parse_scene_name(name);
  if (request.suffixes.empty()) return;
  changed_ = plain_;
  for (const SceneSuffix* suffix : request.suffixes) {
    changes_.push_back(suffix->change(changed_));
    apply(changes_.back(), changed_);
  }
}

const Scene& MovingScene::at(long frame) {
  assert(0 <= frame && frame < frames_);
  const auto last = static_cast<double>(std::max(1L, frames_ - 1));
  notes_ = {};
  motion_({frame, static_cast<double>(frame) / last}, plain_, notes_);
  Scene* shown = &plain_;
  if (changes_.empty()) {
    validate(plain_, plain_.name);
  } else {
    shown = &changed_;
    changed_ = plain_;  // assigned, so that the vectors keep their memory
    for (const SceneChange& change : changes_) apply(change, changed_);
  }
  for (Object& object : shown->objects) object.self = object.self || self_;
  return *shown;
}

}  // namespace farcull
