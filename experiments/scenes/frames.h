// A scene that moves, frame by frame; and scenes written as files.
//
// In most scenes only vertices change from frame to frame. Triangles and objects then stay in the
// same memory, so that a backend sees what it has to send again. Where the topology changes,
// nothing of the frame before is reused.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"

namespace farcull {

/// Frames first to last, both included; 0 <= first <= last. Of a built-in motion that is a path
/// they are the end of last + 1 frames, so that 30:59 is the second half of 60 frames.
struct FrameRange {
  long first = 0;
  long last = 0;
  long count() const { return last - first + 1; }
};
/// "N" (0 to N - 1) or "A:B", at most a million frames, numbers up to 1e9. Throws Error naming
/// --frames.
FrameRange parse_frames(const std::string& text);

/// A scene that depends on a number.
class FrameSource {
 public:
  /// The arguments of load_scene(): a built-in scene that moves (builtin/scenes.h), or meshes
  /// some of whose names hold %d or %04d, on the command line or in a scene file. self: every
  /// object is tested against itself. Throws Error where nothing moves, or as load_scene() does for
  /// the first frame.
  FrameSource(std::vector<std::string> arguments, FrameRange range, bool self);
  /// A scene that is not named, whose frames the range has to be.
  explicit FrameSource(MovingScene moving);

  /// The scene at a frame of the range; the same object each time, and the same memory of triangles
  /// where the topology is that of the call before. Throws Error naming the file where a mesh
  /// cannot be read, or as MovingScene does.
  const Scene& at(long frame);

  /// The error that at() will throw for the first frame of the range whose files do not all exist
  /// now.
  std::optional<Error> missing() const;

  /// Whether the triangles, by their indices, the number of vertices or the objects were others in
  /// the call of at() before the last one. False after the first call.
  bool topology_changed() const { return changed_; }
  /// The notes of a built-in motion on the frame.
  FrameNotes notes() const;

 private:
  // The error of at() where a mesh of the frame has no file now.
  std::optional<Error> missing_at(long frame) const;

  std::vector<std::string> arguments_;
  FrameRange range_;
  bool self_ = false;
  std::optional<MovingScene> built_in_;
  MeshCache meshes_;
  Scene scene_;  // of meshes, as it is now
  // The topology of the call before.
  std::size_t vertices_ = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Object> objects_;
  bool first_ = true;
  bool changed_ = false;
};

// Scenes as files: meshes whose doubles are read back as they were, and the scene file that puts
// them together again.

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
