// Scenes that need no file of the user: generated ones, which are the same on every run, and scenes
// made of the packaged meshes. Some of them move.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

/// The numbers that a name may carry after colons, as in crowd:3000:0.2. An omitted number has its
/// usual value, or 0 if the scene takes no such number.
struct SceneParameters {
  std::uint64_t size = 0;
  double second = 0;
  std::optional<std::uint64_t> seed = {};  // of @seedN; empty: the scene's own
};

/// The range of the first number, as in field:1000000.
struct SceneSize {
  std::string what;  // the thing that it counts, such as "triangles"
  std::uint64_t least = 0;
  std::uint64_t most = 0;
  std::uint64_t usual = 0;  // used if the name has no number
};

/// The range of the second number, both ends included.
struct SceneSecond {
  std::string what;  // the thing that it measures, with its unit, such as "stiffness in N/m"
  double least = 0;
  double most = 0;
  double usual = 0;
};

/// A moment of a motion.
struct Instant {
  long frame = 0;   // for a simulation
  double time = 0;  // 0 to 1, for a path
};

/// The numbers and the warning that a motion gives for a frame.
struct FrameNotes {
  std::vector<std::pair<std::string, double>> values;  // in the same order in every frame
  std::string warning;                                 // empty: none
};

/// Moves the scene to an instant. The scene is the built one or the result of an earlier call. If
/// the topology stays, only Scene::vertices is written, in place. The result depends only on the
/// time of a path, or on the frame of a simulation, not on earlier calls; an earlier frame of a
/// simulation is computed from frame 0 on. Throws Error if the scene cannot be computed.
using Motion = std::function<void(const Instant&, Scene&, FrameNotes&)>;

struct BuiltScene {
  Scene scene;    // the scene "without frames": used if no frames are asked for
  Motion motion;  // empty: nothing moves
};

struct BuiltinScene {
  std::string name;
  std::string description;                 // one line
  std::uint32_t objects = 0;               // of the usual size
  std::uint32_t triangles = 0;             // of the usual size
  std::string motion = {};                 // one line; empty if nothing moves
  std::optional<SceneSize> size = {};      // empty: the scene has one size only
  std::optional<SceneSecond> second = {};  // empty: no second number
  bool costly = false;            // its usual size is meant for farcull bench, not for every test
  bool topology_changes = false;  // triangles and objects differ between frames
  bool needs_meshes = false;      // made of the packaged meshes, see mesh_folder()
  std::optional<std::uint64_t> seed = {};  // seed of the scene; empty: nothing in it is random
  std::function<BuiltScene(const SceneParameters&)> build = {};  // sets Scene::name to name

  SceneParameters usual() const;
  Scene make() const { return build(usual()).scene; }
};

/// The change of a scene by a suffix. Every vertex is multiplied by scale and moved by translate,
/// in double. Then, if `ground` is given, an object "ground" is added: two triangles with these
/// corners, counterclockwise seen from above.
struct SceneChange {
  double scale = 1;
  Vec3 translate = Vec3::Zero();
  std::optional<std::array<Vec3, 4>> ground = {};
};
/// Throws Error naming the scene if a coordinate is not finite afterwards.
void apply(const SceneChange& change, Scene& scene);

/// The scene with every vertex multiplied by scale, then moved by translate, in double. Throws
/// Error as apply().
Scene transformed(Scene scene, double scale, const Vec3& translate);

/// A suffix that any built-in scene takes, as in two-spheres@far; several apply from left to right.
struct SceneSuffix {
  std::string suffix;       // with its @
  std::string description;  // one line
  /// Returns the change, given the scene without frames. The same change applies to all frames.
  std::function<SceneChange(const Scene&)> change;
};
const std::vector<SceneSuffix>& scene_suffixes();

/// All built-in scenes, generated ones first. The list is made once.
const std::vector<BuiltinScene>& builtin_scenes();

// The parts of the list, one per file.
std::vector<BuiltinScene> generated_scenes();
/// Scenes for benchmarks (docs/results/bench.md).
std::vector<BuiltinScene> bench_scenes();
/// Also for benchmarks: scenes of common kinds, with cloth, balls and parts in contact.
std::vector<BuiltinScene> contact_scenes();
/// Scenes that move, most of them from the papers (CULLIDE, Graphics Hardware 2003; FAR, VRST
/// 2004). Without frames they are halfway through their motion, except the cloth.
std::vector<BuiltinScene> paper_scenes();
/// Scenes whose second number goes to an extreme, for the study "stability".
std::vector<BuiltinScene> extreme_scenes();
/// Scenes made of the packaged meshes. Building one throws Error if a mesh cannot be read.
std::vector<BuiltinScene> packaged_scenes();

/// The scene with this name, which is read up to its first ':' or '@'; null if there is none.
const BuiltinScene* find_builtin_scene(const std::string& name);
/// Whether the name up to its first ':' or '@' is that of a built-in scene.
bool is_builtin_scene(const std::string& name);
/// A remedy: "did you mean two-spheres? " if the name differs little from that of a built-in scene;
/// else "correct the name; ".
std::string likely_name(const std::string& name);

/// The parts of a name: NAME[:SIZE[:SECOND]][@SUFFIX...], as in crowd:3000:0.2@far. The suffix
/// @seedN draws a scene with the seed N in place of its own.
struct SceneRequest {
  const BuiltinScene* entry = nullptr;
  SceneParameters parameters;
  std::vector<const SceneSuffix*> suffixes;
};
/// Throws Error naming `name` if the scene or a suffix is unknown, or if a number is malformed, out
/// of range, or not accepted by the scene, such as a seed for a scene without randomness.
SceneRequest parse_scene_name(const std::string& name);

/// A built-in scene by name. Throws Error as parse_scene_name(), if the packaged meshes it needs
/// are not there, and if suffixes move it beyond what a double can hold.
Scene make_builtin_scene(const std::string& name);

/// The seed of the built-in scene of this name, with or without numbers and suffixes: that of
/// @seedN, or its own. Empty if nothing in the scene is random, and for any other name.
std::optional<std::uint64_t> builtin_seed(const std::string& name);

/// Whether the built-in scene of this name, with or without numbers and suffixes, moves.
bool has_motion(const std::string& name);

/// The names of the scenes that move, for messages.
std::string moving_names();

/// A built-in scene that moves, frame by frame. The frames of a path go through it once, from time
/// 0 in frame 0 to time 1 in the last frame; a frame of a simulation is a time step. The same on
/// every run.
class MovingScene {
 public:
  /// Frames 0 to frames - 1; frames >= 1. self: every object is tested against itself. Throws Error
  /// as make_builtin_scene(), and if nothing moves.
  explicit MovingScene(const std::string& name, long frames, bool self = false);
  MovingScene(const std::string& name, long frames, long first) = delete;  // a number is no bool
  /// The same for a scene that is not built in. Precondition: it has a motion.
  explicit MovingScene(BuiltScene built, long frames, bool self = false);

  /// The scene at a frame of the range, validated. Returns the same Scene object each time. Its
  /// triangles and vertices stay in the same memory if the topology did not change since the
  /// previous call. The changes of suffixes are computed once, from the scene without frames; a
  /// ground does not move. Throws Error as Motion does.
  const Scene& at(long frame);

  /// The notes of the motion on the last frame from at(), such as energies; most motions have none.
  const std::vector<std::pair<std::string, double>>& notes() const { return notes_.values; }
  const std::string& warning() const { return notes_.warning; }

 private:
  long frames_;
  bool self_;
  Motion motion_;
  std::vector<SceneChange> changes_;
  Scene plain_;    // before the suffixes
  Scene changed_;  // after them, if there are any
  FrameNotes notes_;
};

inline constexpr const char* kBunny = "bunny00.off";
inline constexpr const char* kDragon = "ChineseDragon-10kv.off";

/// The folder of the packaged meshes: the environment variable FARCULL_MESHES if it is set and not
/// empty, else the folder given when farcull was built.
std::string mesh_folder();

/// Reads a file of mesh_folder(). Throws Error if that fails.
Mesh packaged(const char* file);

/// Calls take() with the parts of the scene "field" one after the other. The scene has about
/// parameters.size triangles and is made object by object, so that memory does not grow with the
/// scene. A part is some consecutive whole objects, as a scene called `name`, which take() may
/// change. Together the parts are the scene, bit for bit.
void stream_field(const SceneParameters& parameters, std::uint64_t seed, const std::string& name,
                  const std::function<void(Scene& part)>& take);

// The generators of built-in scenes: each file gives the entries of its scenes. Generated scenes
// are drawn with core/base/random.h and fixed seeds, so that every platform makes the same doubles.

/// The distance between neighbouring sheets in the stack of "shells", everywhere on them.
inline constexpr double kShellGap = 0x1p-34;

/// size: slivers of each object; second: aspect, the longest side over the height above it.
BuiltScene make_slivers(const SceneParameters& parameters, std::uint64_t seed);
/// size: sheets; second: distance between neighbours, in units of their width, see stack_gap().
/// Every fourth sheet leans and crosses both neighbours.
BuiltScene make_stack(const SceneParameters& parameters);
/// 2^round(log2(wanted)): a power of two, so that no height of the stack is rounded.
double stack_gap(double wanted);
/// size: large triangles, with eight small ones at each; second: ratio of their sides.
BuiltScene make_mixed(const SceneParameters& parameters, std::uint64_t seed);
/// size: pairs; second: height of a vertex above a face, or of an edge above an edge, in ulps of
/// their coordinates, rounded to a whole number. The pairs collide if it is 0 or less.
BuiltScene make_gap(const SceneParameters& parameters);

/// The scenes of the same names in contact_scenes(). size: number of triangles.
BuiltScene make_crumpled(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_spheres(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_cad_cut(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_funnel(const SceneParameters& parameters, std::uint64_t seed);

/// A scene of two objects, the second one placed.
Scene two_objects(const std::string& name, const char* first, const Mesh& one, const char* second,
                  const Mesh& other, const Placement& placement = {});
/// Moves the scene to the middle of its motion.
BuiltScene halfway(BuiltScene built);

/// Makes a scene from a function that takes nothing, the seed, the parameters, or both, and returns
/// a Scene or a BuiltScene.
class SceneMaker {
 public:
  template <class Make>
  SceneMaker(Make make) {
    make_ = [make](const SceneParameters& p, std::uint64_t seed) -> BuiltScene {
      if constexpr (std::is_invocable_v<Make>)
        return {make(), {}};
      else if constexpr (std::is_invocable_v<Make, std::uint64_t>)
        return {make(seed), {}};
      else if constexpr (std::is_invocable_v<Make, const SceneParameters&>)
        return make(p);
      else
        return make(p, seed);
    };
  }
  BuiltScene operator()(const SceneParameters& p, std::uint64_t seed) const {
    return make_(p, seed);
  }

 private:
  std::function<BuiltScene(const SceneParameters&, std::uint64_t)> make_;
};
/// The scene that `make` returns, with the motion that `motion` makes from it.
SceneMaker moved(Scene (*make)(), Motion (*motion)(const Scene&));

inline constexpr bool kCostly = true, kChanges = true;
/// A row of the table of scenes, with the members of BuiltinScene. seed: used if the name gives
/// none; 0 if nothing in the scene is random.
BuiltinScene entry(const char* name, std::uint64_t seed, const SceneMaker& make,
                   const char* description, std::uint32_t objects, std::uint32_t triangles,
                   const char* motion = "", const SceneSize& size = {},
                   const SceneSecond& second = {}, bool costly = false,
                   bool topology_changes = false);

/// `rest` is the scene without frames; its objects share no vertex. The second object approaches
/// from the side, passes through the first and leaves on the other side.
Motion pass_through(const Scene& rest);
/// All objects swell and shrink, out of phase, while waves run along them.
Motion pulse(const Scene& rest);
/// Each object moves along its own path, by up to its diagonal, and returns.
Motion drift(const Scene& rest);

}  // namespace farcull
