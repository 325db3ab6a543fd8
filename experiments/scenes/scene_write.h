// Scenes as files: meshes whose doubles are read back as they were, and the scene file that puts
// them together again.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/cull/cull.h"
#include "core/scene/scene.h"
#include "experiments/scenes/frames.h"

namespace farcull {

/// The files of one call.
struct WrittenScene {
  std::string scene_file;  // FOLDER/scene.json
  std::uint64_t files = 0;
  std::uint64_t bytes = 0;
};

/// Writes each object as OFF, NAME.off, with the vertices that it uses and 17 significant digits,
/// and scene.json, whose scene has the same scene_hash(). NAME is that of the object with what is
/// not a letter, a digit, '.' or '-' replaced, and a number where two would be the same. The
/// last part of `folder` is made where it does not exist; files that do are replaced, as by other
/// outputs; scene.json comes last. Throws Error naming a path that the system refuses; files that
/// were not there before are taken away again then. Precondition: every object has a triangle.
WrittenScene write_scene(const Scene& scene, const std::string& folder);

/// The same for frames, for `farcull run FOLDER/scene.json --frames`: NAME_%04d.off with the number
/// of the frame; NAME.off for an object that stands still while others move. Where objects come and
/// go (`objects_change`), all of a frame are groups of one OBJ instead, in their order. `at` gives
/// the frames of the range in order. Throws Error as write_scene(), and where objects come and go
/// but only some are tested against themselves, which no scene file can say.
WrittenScene write_frames(const std::function<const Scene&(long)>& at, FrameRange range,
                          bool objects_change, const std::string& folder,
                          const Progress& progress = {});

}  // namespace farcull
