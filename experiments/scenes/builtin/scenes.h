// Scenes that need no file of the user: generated ones, the same on every run, and ones made of the
// packaged meshes; as they are without frames, and in motion.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/scenes/mesh/mesh.h"

namespace farcull {

/// The numbers that a name may carry after colons, as in crowd:3000:0.2; those that it leaves out
/// are the usual ones, and 0 where the scene has none.
struct SceneParameters {
  std::uint64_t size = 0;
  double second = 0;
  std::optional<std::uint64_t> seed = {};  // of @seedN; empty: the scene's own
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

/// The notes of a motion on a frame.
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

/// All built-in scenes, generated ones first. The list is made once.
const std::vector<BuiltinScene>& builtin_scenes();

// Its parts, of a file each.
std::vector<BuiltinScene> generated_scenes();
/// For benchmarks; the counts are those of docs/results/bench.md.
std::vector<BuiltinScene> bench_scenes();
/// For benchmarks too, of kinds that people have: cloth, rope and parts in contact.
std::vector<BuiltinScene> contact_scenes();
/// Scenes that move, most of them of the papers (CULLIDE, Graphics Hardware 2003; FAR, VRST 2004).
/// Without frames they are as halfway through their motion, but for the cloth.
std::vector<BuiltinScene> paper_scenes();
/// Scenes whose second number goes to an extreme, for the study "stability".
std::vector<BuiltinScene> extreme_scenes();
/// Scenes made of the packaged meshes. Making one throws Error where a mesh cannot be read.
std::vector<BuiltinScene> packaged_scenes();

/// The scene of this name up to its first ':' or '@'; null if no scene has it.
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
/// Throws Error naming `name` if the scene or a suffix is unknown, or if a number is
/// malformed, out of range, or one that the scene does not take, as a seed where nothing in it is
/// random.
SceneRequest parse_scene_name(const std::string& name);

/// A built-in scene by name. Throws Error as parse_scene_name(), if the packaged meshes it needs
/// are not there, and if suffixes move it beyond what a double can hold.
Scene make_builtin_scene(const std::string& name);

/// The seed of the built-in scene of this name, perhaps with numbers and suffixes: that of @seedN,
/// or its own. Empty where nothing in it is random, and for any other name.
std::optional<std::uint64_t> builtin_seed(const std::string& name);

/// Whether the built-in scene of this name, perhaps with numbers and suffixes, moves.
bool has_motion(const std::string& name);

/// The names of those that do, for messages.
std::string moving_names();

/// A built-in scene that moves, as it is at a frame. Where the motion is a path, the frames go once
/// through it, from time 0 in frame 0 to time 1 in the last; where it is a simulation, a frame is a
/// time step. The same on every run.
class MovingScene {
 public:
  /// Frames 0 to frames - 1; frames >= 1. self: every object is tested against itself, besides
  /// those that are anyway. Throws Error as make_builtin_scene(), and where nothing moves.
  explicit MovingScene(const std::string& name, long frames, bool self = false);
  MovingScene(const std::string& name, long frames, long first) = delete;  // a number is no bool
  /// The same for a scene that is not built in. Precondition: it has a motion.
  explicit MovingScene(BuiltScene built, long frames, bool self = false);

  /// The scene at a frame of the range, validated: the same object each time, and the same memory
  /// of triangles and vertices where the topology is that of the call before. The changes of
  /// suffixes are computed once, from the scene without frames; a ground stays. Throws Error as
  /// Motion does.
  const Scene& at(long frame);

  /// The notes of the motion on the frame that at() gave last, such as energies; mostly none.
  const std::vector<std::pair<std::string, double>>& notes() const { return notes_.values; }
  const std::string& warning() const { return notes_.warning; }

 private:
  long frames_;
  bool self_;
  Motion motion_;
  std::vector<SceneChange> changes_;
  Scene plain_;    // before the suffixes
  Scene changed_;  // after them, where there are any
  FrameNotes notes_;
};

inline constexpr const char* kBunny = "bunny00.off";
inline constexpr const char* kDragon = "ChineseDragon-10kv.off";

/// The folder of the packaged meshes: the environment variable FARCULL_MESHES if it is set and not
/// empty, else the folder given when farcull was built.
std::string mesh_folder();

/// A file of mesh_folder(). Throws Error where it cannot be read.
Mesh packaged(const char* file);

/// Calls take() with one part of the scene "field" after the other, which has about parameters.size
/// triangles and is made object by object, so that the memory does not grow with it: some
/// consecutive objects, whole, as a scene called `name` that take() may change. Together they are
/// the scene, bit by bit.
void stream_field(const SceneParameters& parameters, std::uint64_t seed, const std::string& name,
                  const std::function<void(Scene& part)>& take);

}  // namespace farcull
