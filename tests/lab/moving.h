// What the tests of scenes in motion share: every moving scene small enough to run all its frames.
#pragma once

#include "experiments/scenes/builtin/scenes.h"
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

inline long first_frame(const std::string& name) { return name.starts_with("cloth") ? 30 : 0; }

}  // namespace farcull::lab
