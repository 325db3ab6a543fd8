// `--frames`: a scene that moves, frame after frame, by one method whose buffers stay.
//
// Only vertices change from frame to frame: the triangles and objects are those of the first frame,
// in the same memory, so a backend can see what it has to send again.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/mesh_cache.h"
#include "experiments/run.h"

namespace farcull {

/// Frames first to last, both included; 0 <= first <= last.
struct FrameRange {
  long first = 0;
  long last = 0;
  long count() const { return last - first + 1; }
};
/// "N" (0 to N - 1) or "A:B", at most a million frames. Throws Error naming --frames.
FrameRange parse_frames(const std::string& text);

/// A scene whose vertices depend on a number.
class FrameSource {
 public:
  /// The arguments of load_scene(): a built-in scene with motion (builtin_motion.h), which goes
  /// once through it over the range, or meshes some of whose names hold %d or %04d, on the command
  /// line or in a scene file. self: every object is tested against itself. Throws Error where
  /// nothing moves, where a file of some frame does not exist, or as load_scene() does.
  FrameSource(std::vector<std::string> arguments, FrameRange range, bool self);

  /// The scene at a frame of the range; the same object each time. Throws Error naming the file
  /// where a mesh cannot be read or has another topology than in the first frame.
  const Scene& at(long frame);

 private:
  std::vector<std::string> arguments_;
  FrameRange range_;
  bool builtin_;
  MeshCache meshes_;
  Scene rest_;   // of a built-in scene
  Scene scene_;  // as it is now
};

struct FramesQuestion {
  RunOptions options;
  FrameRange range;
  bool self = false;
  bool strict = false;  // farcull verify: ask the guarantee of every method
  bool pairs = false;   // the CSV is wanted
};

/// Milliseconds of frames: candidates and exact tests, without reading and accounting.
struct FrameTimes {
  double median = 0, p95 = 0, max = 0;  // p95: by nearest rank
};
FrameTimes summary_of(std::vector<double> ms);

struct FramesResult {
  nlohmann::ordered_json json;  // docs/record.md
  std::string table;            // for people
  std::string pairs_csv;        // as pairs_csv(), a column `frame` before
  std::string broken;           // the first guarantee that was broken; empty: none
};

/// Runs every frame of the scene. SIGINT, SIGTERM and SIGHUP end the program at once, with a line
/// on standard error that says how many frames were done; nothing is written before the last frame.
/// Throws Error as FrameSource and run_scene() do.
FramesResult run_frames(const std::vector<std::string>& scene, const FramesQuestion& question,
                        const Progress& progress = {});

}  // namespace farcull
