// Scenes that need no file of the user: generated ones, the same on every run, and ones made of the
// packaged meshes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/scenes/builtin/built_scene.h"
#include "experiments/scenes/builtin/suffixes.h"

namespace farcull {

/// All built-in scenes, generated ones first. The list is made once.
const std::vector<BuiltinScene>& builtin_scenes();

/// The scene of this name up to its first ':' or '@'; null where there is none.
const BuiltinScene* find_builtin_scene(const std::string& name);
/// Whether the name up to its first ':' or '@' is that of a built-in scene.
bool is_builtin_scene(const std::string& name);

/// The parts of a name: NAME[:SIZE[:SECOND]][@SUFFIX...], as in crowd:3000:0.2@far. The suffix
/// @seedN draws a scene with the seed N in place of its own.
struct SceneRequest {
  const BuiltinScene* entry = nullptr;
  SceneParameters parameters;
  std::vector<const SceneSuffix*> suffixes;
};
/// Throws Error naming `name` if the scene or a suffix is unknown, or if a number is none, out of
/// range, or one that the scene does not take, as a seed where nothing in it is random.
SceneRequest parse_scene_name(const std::string& name);

/// A built-in scene by name. Throws Error as parse_scene_name(), if the packaged meshes it needs
/// are not there, and if suffixes move it beyond what a double can hold.
Scene make_builtin_scene(const std::string& name);

/// The seed of the built-in scene of this name, perhaps with numbers and suffixes: that of @seedN,
/// or its own. Empty where nothing in it is random, and for any other name.
std::optional<std::uint64_t> builtin_seed(const std::string& name);

}  // namespace farcull
