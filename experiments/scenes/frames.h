// Provides a moving scene frame by frame.
//
// In most scenes only vertices change from frame to frame. Triangles and objects then stay in the
// same memory, so that a device needs only the new vertices.
#pragma once

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

/// Frames `first` to `last`, both included; 0 <= first <= last. A built-in motion along a path has
/// last + 1 frames in all, so 30:59 is the second half of a path with 60 frames.
struct FrameRange {
  long first = 0;
  long last = 0;
  long count() const { return last - first + 1; }
};
/// Reads "N", for frames 0 to N - 1, or "A:B". Throws Error naming --frames for other texts, for
/// more than a million frames, and for numbers above 1e9.
FrameRange parse_frames(const std::string& text);

/// A scene that depends on the frame number.
class FrameSource {
 public:
  /// arguments: as for load_scene(), either a built-in scene that moves, or meshes. A %d or %04d in
  /// the name of a mesh stands for the number of the frame. self: every object is also tested
  /// against itself. Throws Error if no object moves, or as load_scene() does for the first frame.
  FrameSource(SceneArguments arguments, FrameRange range, bool self);
  explicit FrameSource(MovingScene moving);

  /// Returns the scene at a frame of the range. Every call returns the same Scene object. The
  /// triangles stay in the same memory if topology_changed() is false. Throws Error naming the file
  /// if a mesh cannot be read, or as MovingScene does.
  const Scene& at(long frame);

  /// Returns the Error that at() would throw for the first frame of the range that lacks a file.
  /// Empty if no file is missing.
  std::optional<Error> missing() const;

  /// True if the last call of at() changed the indices of triangles, the number of vertices or the
  /// objects. False after the first call.
  bool topology_changed() const { return changed_; }
  FrameNotes notes() const;

 private:
  SceneArguments arguments_;
  FrameRange range_;
  bool self_ = false;
  std::optional<MovingScene> built_in_;
  MeshCache meshes_;
  Scene scene_;  // the current frame; unused by a built-in motion without --ignore
  std::size_t vertices_ = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Object> objects_;
  bool first_ = true;
  bool changed_ = false;
};

}  // namespace farcull
