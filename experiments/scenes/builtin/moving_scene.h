// Built-in scenes in motion, frame after frame.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/scenes/builtin/built_scene.h"
#include "experiments/scenes/builtin/suffixes.h"

namespace farcull {

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

}  // namespace farcull
