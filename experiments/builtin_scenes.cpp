#include "experiments/builtin_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "experiments/builtin_parts.h"
#include "experiments/mesh_text.h"
#include "experiments/scene_build.h"

namespace farcull {
namespace {

Scene moved_far(Scene scene) {
  const double step = 1e6 * diagonal(bounds(scene)) / std::sqrt(3.0);
  return transformed(std::move(scene), 1, Vec3::Constant(step));
}

// An entry whose scene is drawn with a seed, which it records.
BuiltinScene drawn(BuiltinScene entry, Scene (*make)(std::uint64_t), std::uint64_t seed) {
  entry.make = [make, seed] { return make(seed); };
  entry.seed = seed;
  return entry;
}

// The same for one whose size is given.
BuiltinScene drawn(BuiltinScene entry, Scene (*make)(std::uint64_t, std::uint64_t), SceneSize size,
                   std::uint64_t seed) {
  size.make = [make, seed](std::uint64_t n) { return make(n, seed); };
  entry.make = [make, seed, n = size.usual] { return make(n, seed); };
  entry.size = std::move(size);
  entry.seed = seed;
  return entry;
}

BuiltinScene costly(BuiltinScene entry) {
  entry.costly = true;
  return entry;
}

std::string base_of(const std::string& name) { return name.substr(0, name.find_first_of(":@")); }

// The size in NAME:SIZE@suffixes, or the usual one. Throws Error naming the scene.
std::uint64_t size_of(const BuiltinScene& entry, const std::string& name) {
  const std::string text = name.substr(0, name.find('@'));
  if (text == entry.name) return entry.size ? entry.size->usual : 0;
  if (!entry.size) {
    throw Error(name, entry.name + " comes in one size", "leave out what follows the colon");
  }
  const std::string number = text.substr(entry.name.size() + 1);
  std::uint64_t size = 0;
  const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), size);
  if (code != std::errc() || end != number.data() + number.size() || size < entry.size->least ||
      size > entry.size->most) {
    throw Error(name, quote_token(number) + " is no number of " + entry.size->what,
                fmt::format("give {} to {}, as in {}:{}", entry.size->least, entry.size->most,
                            entry.name, entry.size->usual));
  }
  return size;
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

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> scenes = {
      {"two-spheres", "two interpenetrating spheres", 2, 10240, false, make_two_spheres},
      {"two-tori", "two linked tori whose tubes cross", 2, 20000, false, make_two_tori},
      drawn({"random-soup", "random triangles with sizes over three decades, many crossing", 8,
             4000, false},
            make_random_soup, 1),
      drawn({"needles", "oblique slivers of aspect up to 2e6 that cross or pass each other closely",
             2, 800, false},
            make_needles, 2),
      {"degenerate",
       "points, segments, slivers and exact contacts of every kind, also missed by 2^-40", 2, 138,
       false, make_degenerate},
      drawn({"ground", "bumpy blobs on a ground of two triangles a thousand times larger", 6, 6402,
             false},
            make_ground, 3),
      drawn({"crowd", "tetrahedra and blobs in a box, some colliding", 400, 9200, false},
            make_crowd, 4),
      {"far-apart", "two spheres far from each other", 2, 2560, false, make_far_apart},
      costly(drawn({"needles-layers",
                    "two layers of oblique needles, 4700 x 0.002: 44,946,746 boxes "
                    "overlap, 1501 collide",
                    2, 32000, false},
                   make_needles_layers, 5)),
      costly(
          drawn({"needles-crossed",
                 "the same in two oblique directions at once: 2,856,139 boxes overlap, 625 collide",
                 2, 10000, false},
                make_needles_crossed, 6)),
      drawn({"field", "blobs spread evenly, some colliding with neighbours", 31, 9920, false},
            make_field, {"triangles", 1000, 1'000'000'000, 10'000}, 7),
      {"two-bunnies", "two interpenetrating Stanford bunnies", 2, 150816, true, make_two_bunnies},
      {"armadillo-elephant", "armadillo and elephant of one size in one place", 2, 140928, true,
       make_armadillo_elephant},
      {"dragon-bunny", "dragon and bunny of one size in one place", 2, 95402, true,
       make_dragon_bunny},
      {"near-copy", "armadillo and its copy moved by 1e-9 of its diagonal", 2, 104000, true,
       make_near_copy},
      {"bunnies-far-apart", "two bunnies ten diagonals from each other", 2, 150816, true,
       make_bunnies_far_apart},
      {"mannequin-devil", "a mannequin with horns: 1581 pairs of its triangles collide", 1, 25888,
       true, make_mannequin_devil},
      {"armadillo", "the armadillo against itself, where nothing collides", 1, 52000, true,
       make_armadillo},
      {"bunny", "the Stanford bunny against itself, where nothing collides", 1, 75408, true,
       make_bunny},
  };
  return scenes;
}

const std::vector<SceneSuffix>& scene_suffixes() {
  static const std::vector<SceneSuffix> suffixes = {
      {"@far", "moved by 1e6 of its diagonals along (1, 1, 1)", moved_far},
      {"@tiny", "scaled by 1e-6",
       [](Scene scene) { return transformed(std::move(scene), 1e-6, Vec3::Zero()); }},
      {"@huge", "scaled by 1e6",
       [](Scene scene) { return transformed(std::move(scene), 1e6, Vec3::Zero()); }},
      {"@ground", "with a ground of two triangles a thousand times larger", with_ground_plane},
  };
  return suffixes;
}

bool is_builtin_scene(const std::string& name) { return find_scene(base_of(name)) != nullptr; }

std::optional<std::uint64_t> builtin_seed(const std::string& name) {
  const BuiltinScene* const entry = find_scene(base_of(name));
  return entry == nullptr ? std::nullopt : entry->seed;
}

Scene make_builtin_scene(const std::string& name) {
  const std::string base = base_of(name);
  const BuiltinScene* const entry = find_scene(base);
  if (entry == nullptr) {
    throw Error(name, "no built-in scene has this name", "see farcull scenes for the names");
  }
  const std::uint64_t size = size_of(*entry, name);
  // All suffixes before the scene is made, which may take a while.
  std::vector<const SceneSuffix*> chosen;
  for (std::size_t at = std::min(name.find('@'), name.size()); at < name.size();) {
    const std::size_t end = std::min(name.find('@', at + 1), name.size());
    const std::string word = name.substr(at, end - at);
    const auto& known = scene_suffixes();
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const SceneSuffix& s) { return s.suffix == word; });
    if (found == known.end()) {
      throw Error(name, quote_token(word) + " is no suffix of scenes", "use " + suffix_names());
    }
    chosen.push_back(&*found);
    at = end;
  }
  Scene scene = entry->size ? entry->size->make(size) : entry->make();
  scene.name = name;
  for (const SceneSuffix* suffix : chosen) scene = suffix->apply(std::move(scene));
  return scene;
}

std::string mesh_folder() {
  const char* const folder = std::getenv("FARCULL_MESHES");
  return folder != nullptr && *folder != '\0' ? folder : FARCULL_MESH_DIR;
}

Scene transformed(Scene scene, double scale, const Vec3& translate) {
  for (Vec3& p : scene.vertices) p = scale * p + translate;
  validate(scene, scene.name);
  return scene;
}

Scene with_ground_plane(Scene scene) {
  const Box box = bounds(scene);
  assert(!box.is_empty());
  const Vec3 centre = box.lo + (box.hi - box.lo) / 2;
  const auto vertex = static_cast<std::uint32_t>(scene.vertices.size());
  for (const Vec3& p : corners({centre, 1000 * diagonal(box)})) scene.vertices.push_back(p);
  scene.objects.push_back({"ground", static_cast<std::uint32_t>(scene.triangles.size()), 2});
  scene.triangles.push_back({vertex, vertex + 1, vertex + 2});
  scene.triangles.push_back({vertex, vertex + 2, vertex + 3});
  scene.source_face.insert(scene.source_face.end(), {0, 1});
  validate(scene, scene.name);
  return scene;
}

}  // namespace farcull
