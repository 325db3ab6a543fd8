// `--frames`: a scene that moves, frame after frame, by one method whose buffers stay.
//
// Mostly only vertices change from frame to frame; triangles and objects then stay in the same
// memory, so a backend can see what it has to send again. Where they change, nothing of the frame
// before is taken over.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/builtin_motion.h"
#include "experiments/growing_output.h"
#include "experiments/mesh_cache.h"
#include "experiments/run.h"

namespace farcull {

/// Frames first to last, both included; 0 <= first <= last.
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
  /// The arguments of load_scene(): a built-in scene that moves (builtin_motion.h), or meshes some
  /// of whose names hold %d or %04d, on the command line or in a scene file. self: every object is
  /// tested against itself. Throws Error where nothing moves, or as load_scene() does for the first
  /// frame.
  FrameSource(std::vector<std::string> arguments, FrameRange range, bool self);
  /// A scene that is not named, whose frames the range has to be.
  explicit FrameSource(MovingScene moving);

  /// The scene at a frame of the range; the same object each time, and the same memory of triangles
  /// where the topology is that of the call before. Throws Error naming the file where a mesh
  /// cannot be read, or as MovingScene does.
  const Scene& at(long frame);

  /// What at() will throw of the first frame of the range one of whose files does not exist now.
  std::optional<Error> missing() const;

  /// Whether the triangles, by their indices, the number of vertices or the objects were others in
  /// the call of at() before the last one. False after the first call.
  bool topology_changed() const { return changed_; }
  /// What a built-in motion says of the frame.
  FrameNotes notes() const;

 private:
  std::vector<std::string> arguments_;
  FrameRange range_;
  bool self_ = false;
  std::optional<MovingScene> built_in_;
  MeshCache meshes_;
  Scene scene_;  // of meshes, as it is now
  // Of the call before.
  std::size_t vertices_ = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Object> objects_;
  bool first_ = true;
  bool changed_ = false;
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
/// Frames per second at so many milliseconds each; empty where that is no positive number.
std::optional<double> per_second(double ms);
FrameTimes summary_of(std::vector<double> ms);

/// What a frame that is done adds.
struct FrameReport {
  const nlohmann::ordered_json& head;     // of all frames: the record without the next two
  const nlohmann::ordered_json& frame;    // an element of `frames`
  const nlohmann::ordered_json& summary;  // of the frames up to this one
  std::string rows;                       // for people; before the first frame's what was run
  std::string pairs_csv;  // as pairs_rows(), a column `frame` before; the header before the first
};
using FrameSink = std::function<void(const FrameReport&)>;

/// The record of docs/record.md, written frame by frame.
class FrameRecord {
 public:
  explicit FrameRecord(std::string path) : output_(std::move(path)) {}
  /// Throws Error as GrowingOutput.
  void add(const FrameReport& report);
  void finish() { output_.finish(); }

 private:
  GrowingOutput output_;
  bool begun_ = false;
};

struct FramesResult {
  nlohmann::ordered_json json;  // docs/record.md; of a run with a sink without `frames`
  std::string table;            // for people; of a run with a sink what follows the rows
  std::string pairs_csv;        // of a run without a sink
  std::string broken;           // the first guarantee that was broken; empty: none
};

/// Runs every frame of the scene; `sink` gets each one as soon as it is done. SIGINT, SIGTERM and
/// SIGHUP end the program at once, with a line on standard error that says how many frames were
/// done. Throws Error as FrameSource, run_scene() and the sink do: what the sink has got is all
/// that there is then.
FramesResult run_frames(const std::vector<std::string>& scene, const FramesQuestion& question,
                        const Progress& progress = {}, const FrameSink& sink = {});
/// The same of a source; question.self is not looked at.
FramesResult run_frames(FrameSource& source, const FramesQuestion& question,
                        const Progress& progress = {}, const FrameSink& sink = {});

}  // namespace farcull
