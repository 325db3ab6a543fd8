// Built-in scenes, which need no file of the user. Some scenes are generated and are the same on
// every run. Other scenes are made of the packaged meshes. Some scenes move.
#pragma once

#include <functional>
#include <type_traits>

#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

/// The numbers in the name of a scene, as in crowd:3000:0.2. If the name lacks a number, the usual
/// value is used. If the scene does not take a number, its value is 0.
struct SceneParameters {
  std::uint64_t size = 0;
  double second = 0;
  std::optional<std::uint64_t> seed = {};  // N of @seedN; empty: the scene uses its own seed
};

/// The range of the first number, as in field:1000000.
struct SceneSize {
  std::string what;  // what the number counts, such as "triangles"
  std::uint64_t least = 0;
  std::uint64_t most = 0;
  std::uint64_t usual = 0;  // used if the name has no number
};

/// The range of the second number; both ends are included.
struct SceneSecond {
  std::string what;  // what the number measures, such as "stiffness in N/m"
  double least = 0;
  double most = 0;
  double usual = 0;
};

/// A moment of a motion. A simulation uses `frame`. A motion along a path uses `time`.
struct Instant {
  long frame = 0;
  double time = 0;  // 0 to 1
};

/// Numbers (such as energies) and a warning that a motion reports for a frame.
struct FrameNotes {
  std::vector<std::pair<std::string, double>> values;  // the same names in every frame
  std::string warning;                                 // empty: no warning
};

/// Moves the scene to an instant. The scene is BuiltScene::scene or the result of an earlier call.
/// If triangles and objects do not change, only Scene::vertices is written, in place. The result
/// does not depend on earlier calls. To go back to an earlier frame, a simulation recomputes all
/// frames from 0 on. Throws Error if the scene cannot be computed.
using Motion = std::function<void(const Instant&, Scene&, FrameNotes&)>;

struct BuiltScene {
  Scene scene;    // the scene if the user names no frames
  Motion motion;  // empty: nothing moves
};

struct BuiltinScene {
  std::string name;
  std::string description;                 // one line
  std::uint32_t objects = 0;               // number of objects at the usual size
  std::uint32_t triangles = 0;             // number of triangles at the usual size
  std::string motion = {};                 // one line; empty if nothing moves
  std::optional<SceneSize> size = {};      // empty: the scene has one size only
  std::optional<SceneSecond> second = {};  // empty: no second number
  bool costly = false;            // true: at its usual size, the scene is too large for tests
  bool topology_changes = false;  // triangles and objects differ between frames
  bool needs_meshes = false;      // made of the packaged meshes, see mesh_folder()
  std::optional<std::uint64_t> seed = {};  // the scene's own seed; empty: nothing is random
  std::function<BuiltScene(const SceneParameters&)> build =
      {};  // makes a scene with the name BuiltinScene::name

  SceneParameters usual() const;
  Scene make() const { return build(usual()).scene; }
};

/// The change that a suffix makes to a scene. Every vertex is multiplied by `scale` and moved by
/// `translate`, in double. Then, if `ground` is set, an object "ground" of two triangles with these
/// corners is added.
struct SceneChange {
  double scale = 1;
  Vec3 translate = Vec3::Zero();
  std::optional<std::array<Vec3, 4>> ground = {};
};
/// Applies the change. Throws Error naming the scene if a resulting coordinate is not finite.
void apply(const SceneChange& change, Scene& scene);

Scene transformed(Scene scene, double scale, const Vec3& translate);

/// A suffix for any built-in scene, as in two-spheres@far. Suffixes are applied from left to right.
struct SceneSuffix {
  std::string suffix;       // begins with @
  std::string description;  // one line
  /// Computes the change from the scene at rest. The same change applies to all frames.
  std::function<SceneChange(const Scene&)> change;
};
const std::vector<SceneSuffix>& scene_suffixes();

/// All built-in scenes. Generated scenes come first. The list is made once.
const std::vector<BuiltinScene>& builtin_scenes();

// These functions return the parts of builtin_scenes(). All paper_scenes() move. If the user names
// no frames, these scenes (except the cloth) are at the middle of their motion.
std::vector<BuiltinScene> generated_scenes();
std::vector<BuiltinScene> bench_scenes();
std::vector<BuiltinScene> contact_scenes();
std::vector<BuiltinScene> paper_scenes();
std::vector<BuiltinScene> extreme_scenes();
std::vector<BuiltinScene> packaged_scenes();

/// Returns the scene of this name, or null if there is no such scene. Only the part of the name
/// before the first ':' or '@' is used.
const BuiltinScene* find_builtin_scene(const std::string& name);
bool is_builtin_scene(const std::string& name);
/// Returns a remedy: "did you mean two-spheres? " if a built-in scene has a similar name, otherwise
/// "correct the name; ".
std::string likely_name(const std::string& name);

/// The parts of a name: NAME[:SIZE[:SECOND]][@SUFFIX...], as in crowd:3000:0.2@far. The suffix
/// @seedN replaces the scene's own seed by N.
struct SceneRequest {
  const BuiltinScene* entry = nullptr;
  SceneParameters parameters;
  std::vector<const SceneSuffix*> suffixes;
};
/// Throws Error naming `name` if the scene or a suffix is unknown, or if a number is malformed, out
/// of range, or not a parameter of the scene.
SceneRequest parse_scene_name(const std::string& name);

/// Returns a built-in scene. Throws Error as parse_scene_name() does. Throws Error if packaged
/// meshes of the scene are missing, or if suffixes move a vertex beyond the largest double.
Scene make_builtin_scene(const std::string& name);

/// Returns the seed of a built-in scene: N of @seedN, or the scene's own seed. Empty if nothing in
/// the scene is random, or if no built-in scene has this name.
std::optional<std::uint64_t> builtin_seed(const std::string& name);

/// True if a built-in scene of this name moves. The name may have numbers and suffixes.
bool has_motion(const std::string& name);

std::string moving_names();

/// A built-in scene that moves. A motion along a path has time 0 in frame 0 and time 1 in the last
/// frame. In a simulation, a frame is a time step.
class MovingScene {
 public:
  /// frames: number of frames, >= 1. self: every object is also tested against itself. Throws Error
  /// as make_builtin_scene() does. Throws Error if nothing in the scene moves.
  explicit MovingScene(const std::string& name, long frames, bool self = false);
  /// Makes frames of a scene that is not built in. Precondition: built.motion is not empty.
  explicit MovingScene(BuiltScene built, long frames, bool self = false);

  /// Returns the scene at a frame, validated. Every call returns the same Scene object. If
  /// triangles and objects did not change since the previous call, triangles and vertices stay in
  /// the same memory. A ground added by a suffix does not move. Throws Error as Motion does.
  const Scene& at(long frame);

  /// Returns the motion's notes on the frame of the last call of at(), such as energies. Most
  /// motions have no notes.
  const std::vector<std::pair<std::string, double>>& notes() const { return notes_.values; }
  const std::string& warning() const { return notes_.warning; }

 private:
  long frames_;
  bool self_;
  Motion motion_;
  std::vector<SceneChange> changes_;
  Scene plain_;    // the scene without the changes of suffixes
  Scene changed_;  // the scene with the changes of suffixes, if there are any
  FrameNotes notes_;
};

inline constexpr const char* kBunny = "bunny00.off";
inline constexpr const char* kDragon = "ChineseDragon-10kv.off";

/// Returns the folder of the packaged meshes: the value of the environment variable FARCULL_MESHES.
/// If this variable is empty or not set, returns the folder that was set when farcull was built.
std::string mesh_folder();

/// Reads a file of mesh_folder(). Throws Error if the file cannot be read.
Mesh packaged(const char* file);

/// Calls take() with one part of the scene "field" after the other, so that memory does not grow
/// with the scene. A part is a scene with the given name and some consecutive objects. take() may
/// change the part. All parts together equal the scene, bit for bit.
void stream_field(const SceneParameters& parameters, std::uint64_t seed, const std::string& name,
                  const std::function<void(Scene& part)>& take);

/// The distance between neighbouring sheets in the stack of the scene "shells".
inline constexpr double kShellGap = 0x1p-34;

/// These functions make the scenes slivers, stack, mixed, gap and so on. The tables in
/// extreme_scenes() and contact_scenes() explain the numbers. Every fourth sheet of the stack
/// crosses its neighbours. The pairs of `gap` collide if the rounded second number is 0 or less.
BuiltScene make_slivers(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_stack(const SceneParameters& parameters);
/// Returns the power of two nearest to the wanted gap of the stack, so that all heights are exact.
double stack_gap(double wanted);
BuiltScene make_mixed(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_gap(const SceneParameters& parameters);
BuiltScene make_crumpled(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_spheres(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_cad_cut(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_funnel(const SceneParameters& parameters, std::uint64_t seed);

Scene two_objects(const std::string& name, const char* first, const Mesh& one, const char* second,
                  const Mesh& other, const Placement& placement = {});
/// Returns the scene, moved to the middle of its motion.
BuiltScene halfway(BuiltScene built);

/// Wraps a function that makes a scene. The function may take nothing or a seed, and returns a
/// Scene. Or the function takes parameters, or parameters and a seed, and returns a BuiltScene.
struct SceneMaker {
  template <class Make>
  SceneMaker(Make function) {
    make = [function](const SceneParameters& p, std::uint64_t seed) -> BuiltScene {
      if constexpr (std::is_invocable_v<Make>)
        return {function(), {}};
      else if constexpr (std::is_invocable_v<Make, std::uint64_t>)
        return {function(seed), {}};
      else if constexpr (std::is_invocable_v<Make, const SceneParameters&>)
        return function(p);
      else
        return function(p, seed);
    };
  }
  std::function<BuiltScene(const SceneParameters&, std::uint64_t)> make;
};
/// Combines a function that makes a scene with a function that makes the scene's motion.
SceneMaker moved(Scene (*make)(), Motion (*motion)(const Scene&));

inline constexpr bool kCostly = true, kChanges = true;
/// Returns a row of the table of built-in scenes. The arguments are members of BuiltinScene. seed:
/// used if the name contains no seed; 0 if nothing in the scene is random.
BuiltinScene entry(const char* name, std::uint64_t seed, const SceneMaker& make,
                   const char* description, std::uint32_t objects, std::uint32_t triangles,
                   const char* motion = "", const SceneSize& size = {},
                   const SceneSecond& second = {}, bool costly = false,
                   bool topology_changes = false);

/// In this motion, the second object approaches from the side, passes through the first object, and
/// leaves on the other side. rest: the scene at rest; its objects share no vertex.
Motion pass_through(const Scene& rest);
/// In this motion, all objects swell and shrink, out of phase, and waves run along their surfaces.
Motion pulse(const Scene& rest);
/// In this motion, each object moves away by up to the diagonal of its box, and returns.
Motion drift(const Scene& rest);

}  // namespace farcull
