// Computes from a scene the change that a suffix stands for, and applies it.
#include "experiments/scenes/builtin/suffixes.h"

#include <cassert>
#include <cmath>

#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {
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

}  // namespace farcull
