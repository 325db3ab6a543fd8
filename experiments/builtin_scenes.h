// Scenes that need no file of the user: generated ones, the same on every run, and ones made of the
// packaged meshes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// The numbers that a name may carry after colons, as in crowd:3000:0.2; those that it leaves out
/// are the usual ones, and 0 where the scene has none.
struct SceneParameters {
  std::uint64_t size = 0;
  double second = 0;
};

/// The range of the first number, as in field:1000000.
struct SceneSize {
  std::string what;  // of which it is the number, such as "triangles"
  std::uint64_t least = 0;
  std::uint64_t most = 0;
  std::uint64_t usual = 0;  // where the name has none
};

/// The range of the second one, both ends included.
struct SceneSecond {
  std::string what;  // with its unit, such as "stiffness in N/m"
  double least = 0;
  double most = 0;
  double usual = 0;
};

/// A moment of a motion that is watched in frames.
struct Instant {
  long frame = 0;   // for what goes on step by step
  double time = 0;  // 0 to 1, for a path
};

/// What a motion says of a frame besides its triangles.
struct FrameNotes {
  std::vector<std::pair<std::string, double>> values;  // in the same order in every frame
  std::string warning;                                 // empty: none
};

/// Brings the scene, which is the one that was built or what an earlier call left of it, to an
/// instant. Where the topology stays, only Scene::vertices is written, in place. A path gives the
/// same scene for a time whatever was asked for before; so does a simulation for a frame, but one
/// that lies back is reached from the start again. Throws Error where the scene cannot be had.
using Motion = std::function<void(const Instant&, Scene&, FrameNotes&)>;

struct BuiltScene {
  Scene scene;    // as it is without frames
  Motion motion;  // empty: nothing moves
};

struct BuiltinScene {
  std::string name;
  std::string description = {};            // one line
  std::uint32_t objects = 0;               // of the usual size
  std::uint32_t triangles = 0;             // of the usual size
  bool needs_meshes = false;               // made of the packaged meshes, see mesh_folder()
  std::optional<SceneSize> size = {};      // empty: of one size
  std::optional<SceneSecond> second = {};  // empty: no second number
  std::string motion = {};                 // one line; empty: nothing moves
  bool topology_changes = false;           // triangles and objects differ between frames
  std::optional<std::uint64_t> seed = {};  // what it was drawn with; empty: nothing in it is random
  bool costly = false;  // of its usual size it is for farcull bench, not every test
  std::function<BuiltScene(const SceneParameters&)> build = {};  // Scene::name is name

  SceneParameters usual() const;
  Scene make() const { return build(usual()).scene; }
};

/// All of them, generated ones first.
const std::vector<BuiltinScene>& builtin_scenes();

/// What a suffix does to a scene: every vertex times scale, plus translate, in double; then one
/// more object "ground" of two triangles with these corners.
struct SceneChange {
  double scale = 1;
  Vec3 translate = Vec3::Zero();
  std::optional<std::array<Vec3, 4>> ground = {};
};
/// Throws Error naming the scene if a coordinate is not finite then.
void apply(const SceneChange& change, Scene& scene);

/// A suffix that any built-in scene takes, as in two-spheres@far; several apply from left to right.
struct SceneSuffix {
  std::string suffix;       // with its @
  std::string description;  // one line
  /// The change for this scene. In frames, that of the scene as it is without them serves for all.
  std::function<SceneChange(const Scene&)> change;
};
const std::vector<SceneSuffix>& scene_suffixes();

/// Whether the name up to its first ':' or '@' is that of a built-in scene.
bool is_builtin_scene(const std::string& name);

/// What a name says: NAME[:SIZE[:SECOND]][@SUFFIX...], as in crowd:3000:0.2@far.
struct SceneRequest {
  const BuiltinScene* entry = nullptr;
  SceneParameters parameters;
  std::vector<const SceneSuffix*> suffixes;
};
/// Throws Error naming `name` if the scene or a suffix is unknown, or if a number is none, out of
/// range, or one that the scene does not take.
SceneRequest parse_scene_name(const std::string& name);

/// A built-in scene by name. Throws Error as parse_scene_name(), if the packaged meshes it needs
/// are not there, and if suffixes move it beyond what a double can hold.
Scene make_builtin_scene(const std::string& name);

/// The seed of the built-in scene of this name, perhaps with numbers and suffixes. Empty where
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
