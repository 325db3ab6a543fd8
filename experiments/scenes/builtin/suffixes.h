// Suffixes of the names of built-in scenes, as in two-spheres@far.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// A change of a scene by a suffix: every vertex times scale, plus translate, in double; then one
/// more object "ground" of two triangles with these corners, counterclockwise seen from above.
struct SceneChange {
  double scale = 1;
  Vec3 translate = Vec3::Zero();
  std::optional<std::array<Vec3, 4>> ground = {};
};
/// Throws Error naming the scene if a coordinate is not finite then.
void apply(const SceneChange& change, Scene& scene);

/// Every vertex times scale, plus translate, in double. Throws Error as apply().
Scene transformed(Scene scene, double scale, const Vec3& translate);

/// A suffix that any built-in scene takes, as in two-spheres@far; several apply from left to right.
struct SceneSuffix {
  std::string suffix;       // with its @
  std::string description;  // one line
  /// The change for this scene. In frames, that of the scene as it is without them serves for all.
  std::function<SceneChange(const Scene&)> change;
};
const std::vector<SceneSuffix>& scene_suffixes();

}  // namespace farcull
