// A built-in scene: its entry in the list, the numbers that its name may carry, and its motion.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

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

}  // namespace farcull
