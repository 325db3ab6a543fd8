// Scenes as files: meshes with 17 significant digits, so that every double is read back unchanged,
// and the scene file that puts them together again.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "experiments/scenes/frames.h"

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

/// The same for frames, for `farcull run FOLDER/scene.json --frames`: NAME_%04d.off with the number
/// of the frame, or NAME.off for an object that stands still while others move. If objects come and
/// go (`objects_change`), all objects of a frame are groups of one OBJ instead, in their order.
/// `at` gives the frames of the range in order. Throws Error as write_scene(), and if objects come
/// and go but only some are tested against themselves, which no scene file can express.
WrittenScene write_frames(const std::function<const Scene&(long)>& at, FrameRange range,
                          bool objects_change, const std::string& folder,
                          const Progress& progress = {});

}  // namespace farcull
