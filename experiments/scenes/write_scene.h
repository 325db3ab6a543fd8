// Scenes as files: meshes with 17 significant digits, so that every double is read back unchanged,
// and the scene file that puts them together again.
#pragma once

#include <cstdint>
#include <string>

#include "core/scene/scene.h"

namespace farcull {

/// The files that one call has written.
struct WrittenScene {
  std::string scene_file;  // FOLDER/scene.json
  std::uint64_t files = 0;
  std::uint64_t bytes = 0;
};

/// Writes each object as OFF, NAME.off, with the vertices that it uses and 17 significant digits,
/// and scene.json, whose scene has the same scene_hash(). NAME is the object's name with everything
/// but letters, digits, '.' and '-' replaced, and with a number if two would be the same. Creates
/// the last part of `folder` if it does not exist; replaces existing files, as other outputs do;
/// writes scene.json last. Throws Error naming a path that the system refuses, and then removes the
/// files that are new. Precondition: every object has a triangle.
WrittenScene write_scene(const Scene& scene, const std::string& folder);

}  // namespace farcull
