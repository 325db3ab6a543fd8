// Scenes that need no file of the user: generated ones, the same on every run, and ones made of the
// packaged meshes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// The number that a name may carry after a colon, as in field:1000000.
struct SceneSize {
  std::string what;  // of which it is the number, such as "triangles"
  std::uint64_t least = 0;
  std::uint64_t most = 0;
  std::uint64_t usual = 0;  // where the name has none
  std::function<Scene(std::uint64_t)> make = {};
};

struct BuiltinScene {
  std::string name;
  std::string description;                 // one line
  std::uint32_t objects = 0;               // of the usual size
  std::uint32_t triangles = 0;             // of the usual size
  bool needs_meshes = false;               // made of the packaged meshes, see mesh_folder()
  std::function<Scene()> make = {};        // Scene::name is name
  std::optional<std::uint64_t> seed = {};  // what it was drawn with; empty: nothing in it is random
  std::optional<SceneSize> size = {};      // empty: of one size
  bool costly = false;  // what joins boxes takes minutes: for farcull bench, not for every test
};

/// All of them, generated ones first.
const std::vector<BuiltinScene>& builtin_scenes();

/// A suffix that any built-in scene takes, as in two-spheres@far; several apply from left to right.
struct SceneSuffix {
  std::string suffix;       // with its @
  std::string description;  // one line
  std::function<Scene(Scene)> apply;
};
const std::vector<SceneSuffix>& scene_suffixes();

/// Whether the name up to its first ':' or '@' is that of a built-in scene.
bool is_builtin_scene(const std::string& name);

/// A built-in scene by name, perhaps with a size and suffixes, as in field:1000000@far. Throws
/// Error naming it if the name or a suffix is unknown, if the size is out of range or the scene has
/// none, if the packaged meshes it needs are not there, or if suffixes move it beyond what a double
/// can hold.
Scene make_builtin_scene(const std::string& name);

/// The seed of the built-in scene of this name, perhaps with a size and suffixes. Empty where
/// nothing in it is random, and for any other name.
std::optional<std::uint64_t> builtin_seed(const std::string& name);

/// Where the packaged meshes are: the environment variable FARCULL_MESHES if it is set and not
/// empty, else the folder given when farcull was built.
std::string mesh_folder();

/// Every vertex times scale, plus translate, in double. Throws Error naming the scene if a result
/// is not finite.
Scene transformed(Scene scene, double scale, const Vec3& translate);

/// The scene and one more object "ground": a square of two triangles in the plane z = middle of the
/// scene's box, centred there, its side 1000 times the diagonal of that box. Precondition: the
/// scene has a triangle.
Scene with_ground_plane(Scene scene);

}  // namespace farcull
