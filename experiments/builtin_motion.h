// The motion of built-in scenes that move.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// What moves, and how.
struct BuiltinMotion {
  std::string scene;        // name of the built-in scene
  std::string description;  // one line
};
const std::vector<BuiltinMotion>& builtin_motions();

/// Whether the built-in scene of this name, perhaps with a size and suffixes, moves.
bool has_motion(const std::string& name);

/// The vertices at `time` (0 to 1) of the scene that make_builtin_scene(name) gives, which is
/// `rest`; a ground stays. The same on every run. Precondition: has_motion(name).
std::vector<Vec3> moved(const std::string& name, const Scene& rest, double time);

}  // namespace farcull
