// Runs one method on every frame of a scene that moves, and records each frame.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"

namespace farcull {

/// The loop over frames of every command. Calls `one` with each frame of the range and a progress
/// that puts `before` and "frame 3 of 10: " before its stages. SIGINT, SIGTERM and SIGHUP end the
/// program at once, with a line on standard error: the number of finished frames, and `end`. end:
/// null for no line.
void for_each_frame(const FrameRange& range, const char* end, const Progress& progress,
                    const std::string& before,
                    const std::function<void(long frame, const Progress& named)>& one);

struct FramesQuestion {
  RunOptions options;
  FrameRange range;
  bool self = false;
  bool strict = false;       // farcull verify: require the guarantee of every method
  bool pairs = false;        // write the CSV of pairs
  PairColumns columns = {};  // of the CSV, besides those that every list has
  bool certificates = false;
  /// The objects of a frame's scene that are not tested against each other; empty: options.ignored.
  std::function<std::vector<ObjectPair>(const Scene&)> ignored = {};
};

/// Milliseconds of frames: candidates and exact tests, without reading and accounting.
struct FrameTimes {
  double median = 0, p95 = 0, max = 0;  // p95: by nearest rank
  FARCULL_FIELDS(median, p95, max)
};
/// Frames per second if each takes `ms` milliseconds; empty if that is not a positive number.
std::optional<double> per_second(double ms);
FrameTimes summary_of(std::vector<double> ms);

/// The results of a frame that is done.
struct FrameReport {
  const nlohmann::ordered_json& head;     // what holds for all frames: the record without the next
                                          // two members
  const nlohmann::ordered_json& frame;    // an element of `frames`
  const nlohmann::ordered_json& summary;  // of the frames up to this one
  std::string rows;                       // for people; the first frame's rows have a heading
  std::string pairs_csv;  // pairs_rows() after a column `frame`; the first frame's with the header
  long number = 0;        // of the frame
  std::string certificate;  // its text, if certificates are wanted
};
using FrameSink = std::function<void(const FrameReport&)>;

/// A record {HEAD, "frames": [FRAME, ...], "summary": SUMMARY} that is written frame by frame; its
/// text is that of ordered_json::dump(2).
class FrameRecord {
 public:
  explicit FrameRecord(std::string path) : output_(std::move(path)) {}
  /// head: an object, may be empty; only that of the first frame is written. summary: of all frames
  /// up to this one. Throws Error as GrowingOutput does.
  void add(const nlohmann::ordered_json& head, const nlohmann::ordered_json& frame,
           const nlohmann::ordered_json& summary);
  void add(const FrameReport& report) { add(report.head, report.frame, report.summary); }
  void finish() { output_.finish(); }

 private:
  GrowingOutput output_;
  bool begun_ = false;
};

struct FramesResult {
  nlohmann::ordered_json json;  // docs/record.md; with a sink, without `frames`
  std::string table;            // for people; with a sink, only what follows the rows
  std::string pairs_csv;        // of a run without a sink
  std::string broken;           // the first guarantee that was broken; empty: none
  Accounting sum;               // of all frames, without examples; 0 without an accounting
  NothingToTest nothing;        // why no frame has a pair to test; empty if one has
};

/// Runs every frame of the scene; `sink` gets each one as soon as it is done. SIGINT, SIGTERM and
/// SIGHUP end the program at once, with a line on standard error that says how many frames were
/// done. Throws Error as FrameSource, run() and the sink do; the frames that the sink has got are
/// then the only result.
FramesResult run_frames(const std::vector<std::string>& scene, const FramesQuestion& question,
                        const Progress& progress = {}, const FrameSink& sink = {});
/// The same for the frames of a source. Ignores question.self.
FramesResult run_frames(FrameSource& source, const FramesQuestion& question,
                        const Progress& progress = {}, const FrameSink& sink = {});

}  // namespace farcull
