// What the tests of scenes in motion share: every moving scene small enough to run all its frames,
// and a scene whose triangles change while nothing else does.
#pragma once

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "tests/lab/test.h"

namespace farcull::lab {

constexpr long kFrames = 8;

/// Names of all built-in scenes that move, at sizes for tests.
inline std::vector<std::string> moving_scenes(bool of_packaged_meshes) {
  const std::vector<std::pair<std::string, std::string>> sizes = {
      {"needles", ":48"},         {"crowd", ":150:0.3"},
      {"field", ":5000"},         {"cylinders", ":12"},
      {"torii", ":400"},          {"tree-leaves", ":40"},
      {"shells", ":4"},           {"cloth", ":200:1e3"},
      {"bunny-dragon", ":19994"}, {"breaking-dragon", ":19994"}};
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.motion.empty() || scene.needs_meshes != of_packaged_meshes) continue;
    const auto size =
        std::ranges::find_if(sizes, [&](const auto& known) { return known.first == scene.name; });
    names.push_back(scene.name + (size == sizes.end() ? "" : size->second));
  }
  return names;
}

/// The first of kFrames frames in which something collides.
inline long first_frame(const std::string& name) { return name.starts_with("cloth") ? 30 : 0; }

/// Two objects of 60 triangles each on 50 vertices each, in a cube, whose indices are drawn again
/// for each frame: the numbers of everything, the vertices and the objects stay.
class Reconnected {
 public:
  Reconnected() {
    shapes::Random random(21);
    for (std::uint32_t v = 0; v < 2 * kVertices; ++v) scene_.vertices.push_back(random.in_cube(1));
    scene_.name = "reconnected";
    scene_.objects = {{"first", 0, kTriangles}, {"second", kTriangles, kTriangles}};
    scene_.triangles.resize(2 * kTriangles);
    scene_.source_face.resize(2 * kTriangles);
  }
  const Scene& at(long frame) {
    shapes::Random random(100 + static_cast<std::uint64_t>(frame));
    for (std::uint32_t t = 0; t < 2 * kTriangles; ++t) {
      const std::uint32_t first = t < kTriangles ? 0 : kVertices;
      for (std::uint32_t& corner : scene_.triangles[t]) corner = first + random.below(kVertices);
    }
    return scene_;
  }

 private:
  static constexpr std::uint32_t kVertices = 50, kTriangles = 60;
  Scene scene_;
};

}  // namespace farcull::lab
