#include "experiments/builtin_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "core/view.h"
#include "experiments/builtin_motion.h"
#include "experiments/builtin_parts.h"
#include "experiments/mesh_text.h"
#include "experiments/scene_build.h"

namespace farcull {
namespace {

SceneChange moved_far(const Scene& scene) {
  const double step = 1e6 * diagonal(bounds(scene)) / std::sqrt(3.0);
  return {.scale = 1, .translate = Vec3::Constant(step), .ground = {}};
}

SceneChange on_ground(const Scene& scene) {
  const Box box = bounds(scene);
  assert(!box.is_empty());
  const Vec3 centre = box.lo + (box.hi - box.lo) / 2;
  SceneChange change;
  change.ground = corners({centre, 1000 * diagonal(box)});
  return change;
}

std::string base_of(const std::string& name) { return name.substr(0, name.find_first_of(":@")); }

// An entry whose scene stands still, or moves as said from what it is without frames.
BuiltinScene made(BuiltinScene entry, Scene (*make)(), Motion (*moved)(const Scene&) = nullptr) {
  entry.build = [make, moved](const SceneParameters&) {
    BuiltScene built{make(), {}};
    if (moved != nullptr) built.motion = moved(built.scene);
    return built;
  };
  return entry;
}

// One that takes numbers, and of which nothing is drawn.
BuiltinScene taking(BuiltinScene entry, BuiltScene (*build)(const SceneParameters&)) {
  entry.build = build;
  return entry;
}

// The same for what is drawn with a seed, which the entry records.
template <class Make>
BuiltinScene drawn(BuiltinScene entry, std::uint64_t seed, Make make) {
  entry.build = [make, seed](const SceneParameters& p) { return make(p, seed); };
  entry.seed = seed;
  return entry;
}

BuiltinScene drawn(BuiltinScene entry, std::uint64_t seed, Scene (*make)(std::uint64_t)) {
  return drawn(std::move(entry), seed, [make](const SceneParameters&, std::uint64_t of) {
    return BuiltScene{make(of), {}};
  });
}

// The first number of a name, or the usual one.
std::uint64_t size_of(const BuiltinScene& entry, const std::string& name, const std::string& word) {
  const SceneSize& range = *entry.size;
  std::uint64_t size = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), size);
  if (code != std::errc() || end != word.data() + word.size() || size < range.least ||
      size > range.most) {
    throw Error(name, quote_token(word) + " is no number of " + range.what,
                fmt::format("give {} to {}, as in {}:{}", range.least, range.most, entry.name,
                            range.usual));
  }
  return size;
}

double second_of(const BuiltinScene& entry, const std::string& name, const std::string& word) {
  const SceneSecond& range = *entry.second;
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  // Written so that NaN is refused.
  if (code != std::errc() || end != word.data() + word.size() ||
      !(value >= range.least && value <= range.most)) {
    throw Error(name, quote_token(word) + " is no " + range.what,
                fmt::format("give {:g} to {:g}, as in {}:{}:{:g}", range.least, range.most,
                            entry.name, entry.size->usual, range.usual));
  }
  return value;
}

// The numbers in NAME:SIZE:SECOND. Throws Error naming the scene.
SceneParameters parameters_of(const BuiltinScene& entry, const std::string& name) {
  const std::vector<std::string> words = split_list(name.substr(0, name.find('@')), ':');
  SceneParameters out = entry.usual();
  if (words.size() > 1 && !entry.size) {
    throw Error(name, entry.name + " comes in one size", "leave out what follows the colon");
  }
  if (words.size() > 2 && !entry.second) {
    throw Error(name, entry.name + " takes one number", "leave out what follows the second colon");
  }
  if (words.size() > 3) {
    throw Error(name, entry.name + " takes two numbers", "leave out what follows the third colon");
  }
  if (words.size() > 1) out.size = size_of(entry, name, words[1]);
  if (words.size() > 2) out.second = second_of(entry, name, words[2]);
  return out;
}

const BuiltinScene* find_scene(const std::string& base) {
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.name == base) return &scene;
  }
  return nullptr;
}

std::string suffix_names() {
  std::string names;
  for (const SceneSuffix& suffix : scene_suffixes())
    names += (names.empty() ? "" : ", ") + suffix.suffix;
  return names;
}

}  // namespace

SceneParameters BuiltinScene::usual() const {
  return {.size = size ? size->usual : 0, .second = second ? second->usual : 0};
}

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> scenes = {
      made({.name = "two-spheres",
            .description = "two interpenetrating spheres",
            .objects = 2,
            .triangles = 10240,
            .motion = "both breathe while waves run along them"},
           make_two_spheres, pulse),
      made({.name = "two-tori",
            .description = "two linked tori whose tubes cross",
            .objects = 2,
            .triangles = 20000},
           make_two_tori),
      drawn({.name = "random-soup",
             .description = "random triangles with sizes over three decades, many crossing",
             .objects = 8,
             .triangles = 4000},
            1, make_random_soup),
      drawn(
          {.name = "needles",
           .description =
               "slivers of aspect up to 2e6 that cross or pass each other closely, oblique in two "
               "objects and along the axes in two",
           .objects = 4,
           .triangles = 1100,
           .size = SceneSize{"slivers in each oblique object", 8, 1'000'000, 400},
           .motion = "one oblique object turns, one along the axes slides along them"},
          2, make_needles),
      made({.name = "degenerate",
            .description =
                "points, segments, slivers and exact contacts of every kind, also missed by 2^-40",
            .objects = 2,
            .triangles = 138},
           make_degenerate),
      drawn({.name = "ground",
             .description = "bumpy blobs on a ground of two triangles a thousand times larger",
             .objects = 6,
             .triangles = 6402},
            3, make_ground),
      drawn({.name = "crowd",
             .description = "tetrahedra and blobs in a box, some colliding",
             .objects = 400,
             .triangles = 9200,
             .size = SceneSize{"objects", 2, 1'000'000, 400},
             .second =
                 SceneSecond{"density in objects per unit of volume", 1e-3, 10, kUsualCrowdDensity},
             .motion = "each object drifts by up to its diagonal and back"},
            4, make_crowd),
      made({.name = "far-apart",
            .description = "two spheres far from each other",
            .objects = 2,
            .triangles = 2560},
           make_far_apart),
      drawn({.name = "needles-layers",
             .description = "two layers of oblique needles, 4700 x 0.002: 44,946,746 boxes "
                            "overlap, 1501 collide",
             .objects = 2,
             .triangles = 32000,
             .costly = true},
            5, make_needles_layers),
      drawn({.name = "needles-crossed",
             .description = "the same in two oblique directions at once: 2,856,139 boxes overlap, "
                            "625 collide",
             .objects = 2,
             .triangles = 10000,
             .costly = true},
            6, make_needles_crossed),
      drawn({.name = "field",
             .description = "blobs spread evenly, some colliding with neighbours",
             .objects = 31,
             .triangles = 9920,
             .size = SceneSize{"triangles", 1000, 1'000'000'000, 10'000},
             .motion = "each object drifts by up to its diagonal and back"},
            7,
            [](const SceneParameters& p, std::uint64_t seed) {
              BuiltScene built{make_field(p.size, seed), {}};
              built.motion = drift(built.scene);
              return built;
            }),
      drawn({.name = "cylinders",
             .description = "open cylinders of 200 triangles in a room (CULLIDE)",
             .objects = 100,
             .triangles = 20000,
             .size = SceneSize{"cylinders", 2, 100'000, 100},
             .motion = "each goes its own way, turns, bends and breathes"},
            9, make_cylinders),
      drawn({.name = "torii",
             .description = "six torii in a room (CULLIDE)",
             .objects = 6,
             .triangles = 120'000,
             .size = SceneSize{"triangles of each torus", 72, 2'000'000, 20'000},
             .motion = "each goes its own way and turns while waves run around it",
             .costly = true},
            10, make_torii),
      drawn({.name = "tree-leaves",
             .description = "a tree of 4,000 triangles and leaves of 200 (FAR)",
             .objects = 201,
             .triangles = 44'000,
             .size = SceneSize{"leaves", 1, 100'000, 200},
             .motion = "the leaves fall and turn through the branches",
             .costly = true},
            11, make_tree_leaves),
      drawn({.name = "shells",
             .description = "open non-manifold sheets, three in four of them stacked at gaps of "
                            "2^-34 of their width, the others through them at angles as small",
             .objects = 16,
             .triangles = 11'136,
             .size = SceneSize{"sheets", 4, 10'000, 16},
             .motion = "waves run through the stack while the others tilt"},
            12, make_shells),
      taking({.name = "cloth",
              .description = "a cloth above a sphere, against itself as well (FAR)",
              .objects = 2,
              .triangles = 25'120,
              .size = SceneSize{"triangles of the cloth", 8, 200'000, 20'000},
              .second = SceneSecond{"stiffness in N/m", 1e2, 1e8, 1e4},
              .motion = "it falls on the sphere and folds over itself; a frame is a time step",
              .costly = true},
             make_cloth),
      drawn({.name = "slivers",
             .description = "slivers of one aspect, most crossing another one",
             .objects = 2,
             .triangles = 400,
             .size = SceneSize{"slivers in each object", 1, 100'000, 200},
             .second = SceneSecond{"aspect, longest side over height", 2, 1e12, 1e6}},
            14, make_slivers),
      taking({.name = "stack",
              .description = "parallel sheets closely above each other, every fourth crossing its "
                             "neighbours at an angle as small",
              .objects = 16,
              .triangles = 2048,
              .size = SceneSize{"sheets", 2, 1000, 16},
              .second = SceneSecond{"distance of neighbours in their widths", 1e-14, 0.1, 1e-9}},
             make_stack),
      drawn({.name = "mixed",
             .description = "large triangles, each with small ones that pierce it or do not",
             .objects = 2,
             .triangles = 450,
             .size = SceneSize{"large triangles", 1, 10'000, 50},
             .second = SceneSecond{"ratio of their sides", 1, 1e12, 1e6}},
            15, make_mixed),
      taking({.name = "gap",
              .description = "vertices above faces and edges above edges by a number of ulps",
              .objects = 2,
              .triangles = 432,
              .size = SceneSize{"pairs", 1, 4096, 216},
              .second =
                  SceneSecond{"number of ulps; 0: they touch, below: they cross", -1e13, 1e13, 1}},
             make_gap),
      made({.name = "two-bunnies",
            .description = "two interpenetrating Stanford bunnies",
            .objects = 2,
            .triangles = 150816,
            .needs_meshes = true,
            .motion = "one passes through the other"},
           make_two_bunnies, pass_through),
      made({.name = "armadillo-elephant",
            .description = "armadillo and elephant of one size in one place",
            .objects = 2,
            .triangles = 140928,
            .needs_meshes = true},
           make_armadillo_elephant),
      made({.name = "dragon-bunny",
            .description = "dragon and bunny of one size in one place",
            .objects = 2,
            .triangles = 95402,
            .needs_meshes = true},
           make_dragon_bunny),
      made({.name = "near-copy",
            .description = "armadillo and its copy moved by 1e-9 of its diagonal",
            .objects = 2,
            .triangles = 104000,
            .needs_meshes = true},
           make_near_copy),
      made({.name = "bunnies-far-apart",
            .description = "two bunnies ten diagonals from each other",
            .objects = 2,
            .triangles = 150816,
            .needs_meshes = true},
           make_bunnies_far_apart),
      made({.name = "mannequin-devil",
            .description = "a mannequin with horns: 1581 pairs of its triangles collide",
            .objects = 1,
            .triangles = 25888,
            .needs_meshes = true},
           make_mannequin_devil),
      made({.name = "armadillo",
            .description = "the armadillo against itself, where nothing collides",
            .objects = 1,
            .triangles = 52000,
            .needs_meshes = true},
           make_armadillo),
      made({.name = "bunny",
            .description = "the Stanford bunny against itself, where nothing collides",
            .objects = 1,
            .triangles = 75408,
            .needs_meshes = true},
           make_bunny),
      taking({.name = "bunny-dragon",
              .description = "bunny and dragon, its triangles divided (CULLIDE, FAR)",
              .objects = 2,
              .triangles = 325'408,
              .needs_meshes = true,
              .size = SceneSize{"triangles of the dragon", kPackagedDragon, 100'000'000, 250'000},
              .motion = "the bunny falls through the dragon"},
             make_bunny_dragon),
      drawn({.name = "breaking-dragon",
             .description = "a dragon that breaks into 200 pieces (CULLIDE)",
             .objects = 121,
             .triangles = 250'000,
             .needs_meshes = true,
             .size = SceneSize{"triangles", kPackagedDragon, 100'000'000, 250'000},
             .motion = "pieces come off, become objects, fly apart, turn and fall",
             .topology_changes = true},
            13, make_breaking_dragon),
  };
  return scenes;
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

bool is_builtin_scene(const std::string& name) { return find_scene(base_of(name)) != nullptr; }

std::optional<std::uint64_t> builtin_seed(const std::string& name) {
  const BuiltinScene* const entry = find_scene(base_of(name));
  return entry == nullptr ? std::nullopt : entry->seed;
}

SceneRequest parse_scene_name(const std::string& name) {
  SceneRequest out{.entry = find_scene(base_of(name)), .parameters = {}, .suffixes = {}};
  if (out.entry == nullptr)
    throw Error(name, "no built-in scene has this name", "see farcull scenes for the names");
  out.parameters = parameters_of(*out.entry, name);
  for (std::size_t at = std::min(name.find('@'), name.size()); at < name.size();) {
    const std::size_t end = std::min(name.find('@', at + 1), name.size());
    const std::string word = name.substr(at, end - at);
    const auto& known = scene_suffixes();
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const SceneSuffix& s) { return s.suffix == word; });
    if (found == known.end()) {
      throw Error(name, quote_token(word) + " is no suffix of scenes", "use " + suffix_names());
    }
    out.suffixes.push_back(&*found);
    at = end;
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

std::string mesh_folder() {
  const char* const folder = std::getenv("FARCULL_MESHES");
  return folder != nullptr && *folder != '\0' ? folder : FARCULL_MESH_DIR;
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

Scene with_ground_plane(Scene scene) {
  apply(on_ground(scene), scene);
  return scene;
}

}  // namespace farcull
