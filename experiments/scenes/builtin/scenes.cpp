// Lists the built-in scenes, reads their names, and calls their motions.
#include "experiments/scenes/builtin/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

#include "core/base/text.h"
#include "core/view/view.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::uint64_t kDriftSeed = 8;

struct ObjectAtRest {
  Box box;
  std::vector<std::uint32_t> vertices;  // each vertex once
};

// The scene at rest. A motion computes the vertices at each instant from these vertices.
struct Rest {
  std::vector<Vec3> vertices;
  std::vector<ObjectAtRest> parts;
};

std::shared_ptr<const Rest> rest_of(const Scene& scene) {
  auto rest = std::make_shared<Rest>();
  rest->vertices = scene.vertices;
  std::vector<std::uint8_t> seen(scene.vertices.size(), 0);
  for (const Object& object : scene.objects) {
    ObjectAtRest& part = rest->parts.emplace_back();
    part.box = Box::empty();
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + t]) {
        if (seen[v] != 0) continue;
        seen[v] = 1;
        part.vertices.push_back(v);
        part.box.add(scene.vertices[v]);
      }
    }
  }
  return rest;
}

constexpr const char* kSeedSuffix = "@seed";

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
  // The comparisons are false for NaN, so NaN is refused.
  if (!value || !(*value >= range.least && *value <= range.most)) {
    throw Error(name, quote_token(word) + " is no " + range.what,
                fmt::format("give {:g} to {:g}, as in {}:{}:{:g}", range.least, range.most,
                            entry.name, entry.size->usual, range.usual));
  }
  return *value;
}

// Parses the numbers in NAME:SIZE:SECOND. Throws Error naming the scene.
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

// Parses the number N of @seedN. Throws Error naming the scene.
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

SceneChange moved_far(const Scene& scene) {
  const double step = 1e6 * diagonal(bounds(scene)) / std::sqrt(3.0);
  return {.scale = 1, .translate = Vec3::Constant(step), .ground = {}};
}

SceneChange on_ground(const Scene& scene) {
  const Box box = bounds(scene);
  assert(!box.is_empty());
  return {.ground = shapes::square(centre(box), 1000 * diagonal(box))};
}

BuiltScene built_for(const SceneRequest& request, const std::string& name) {
  if (request.entry->motion.empty())
    throw Error(name, "nothing in the scene moves", "name one of " + moving_names());
  BuiltScene built = request.entry->build(request.parameters);
  built.scene.name = name;
  return built;
}

}  // namespace

Scene two_objects(const std::string& name, const char* first, const Mesh& one, const char* second,
                  const Mesh& other, const Placement& placement) {
  SceneBuilder scene(name, name);
  scene.add(one, first);
  scene.add(other, second, Split::kNone, placement);
  return scene.finish();
}

BuiltScene halfway(BuiltScene built) {
  FrameNotes none;
  built.motion({.frame = 0, .time = 0.5}, built.scene, none);
  return built;
}

SceneMaker moved(Scene (*make)(), Motion (*motion)(const Scene&)) {
  return [make, motion](const SceneParameters&) {
    BuiltScene built{make(), {}};
    built.motion = motion(built.scene);
    return built;
  };
}

BuiltinScene entry(const char* name, std::uint64_t seed, const SceneMaker& make,
                   const char* description, std::uint32_t objects, std::uint32_t triangles,
                   const char* motion, const SceneSize& size, const SceneSecond& second,
                   bool costly, bool topology_changes) {
  BuiltinScene out{name, description, objects, triangles, motion};
  if (size.most > 0) out.size = size;
  if (!second.what.empty()) out.second = second;
  out.costly = costly;
  out.topology_changes = topology_changes;
  if (seed > 0) out.seed = seed;
  out.build = [make, seed](const SceneParameters& p) {
    return make.make(p, p.seed.value_or(seed));
  };
  return out;
}

Motion pass_through(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    const double width = rest->parts[0].box.hi.x() - rest->parts[0].box.lo.x();
    const double by = 2.2 * (0.5 - now.time) * width;
    for (const std::uint32_t v : rest->parts[1].vertices) {
      out.vertices[v] = rest->vertices[v];
      out.vertices[v].x() += by;
    }
  };
}

Motion pulse(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    for (std::size_t o = 0; o < rest->parts.size(); ++o) {
      const ObjectAtRest& part = rest->parts[o];
      const Vec3 middle = centre(part.box);
      const double radius = (part.box.hi.z() - part.box.lo.z()) / 2;
      const double phase = 0.25 * static_cast<double>(o);
      for (const std::uint32_t v : part.vertices) {
        const Vec3 from = rest->vertices[v] - middle;
        const double breath = 0.15 * std::sin(shapes::kTurn * (now.time + phase));
        const double wave =
            0.05 * std::sin(shapes::kTurn * (2 * now.time + 1.5 * from.z() / radius));
        out.vertices[v] = middle + (1 + breath + wave) * from;
      }
    }
  };
}

Motion drift(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    shapes::Random random(kDriftSeed);
    for (const ObjectAtRest& part : rest->parts) {
      const Vec3 way = random.direction();
      if (part.box.is_empty()) continue;
      const Vec3 by = std::sin(shapes::kTurn * now.time) * diagonal(part.box) * way;
      for (const std::uint32_t v : part.vertices) out.vertices[v] = rest->vertices[v] + by;
    }
  };
}

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

std::string likely_name(const std::string& name) {
  std::vector<std::string> known;
  for (const BuiltinScene& scene : builtin_scenes()) known.push_back(scene.name);
  const std::string best = likely_word(name, known);
  return best.empty() ? "correct the name; " : did_you_mean(best);
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
    throw Error(name, "no built-in scene has this name",
                likely_name(name) + "farcull scenes lists the built-in scenes");
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
    changed_ = plain_;  // copy assignment, which reuses the memory of the vectors
    for (const SceneChange& change : changes_) apply(change, changed_);
  }
  for (Object& object : shown->objects) object.self = object.self || self_;
  return *shown;
}

}  // namespace farcull
