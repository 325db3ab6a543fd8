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

/// Calls `one` for each frame of the range. `named` puts `before` and text like "frame 3 of 10:"
/// before the name of a stage. SIGINT, SIGTERM and SIGHUP end the program at once. If `end` is not
/// null, the signal handler first prints the number of finished frames and `end`.
void for_each_frame(const FrameRange& range, const char* end, const Progress& progress,
                    const std::string& before,
                    const std::function<void(long frame, const Progress& named)>& one);

struct FramesQuestion {
  RunOptions options;
  FrameRange range;
  bool self = false;
  bool strict = false;       // true (farcull verify): a missed pair fails every method
  bool pairs = false;        // write the CSV of pairs
  PairColumns columns = {};  // additional columns of the CSV of pairs
  bool certificates = false;
  /// Returns the pairs of objects of a frame that are not tested. If the function is null,
  /// options.ignored is used.
  std::function<std::vector<ObjectPair>(const Scene&)> ignored = {};
};

/// Times of a frame in ms, for finding candidates and for exact tests together. Excludes the times
/// of reading and accounting.
struct FrameTimes {
  double median = 0, p95 = 0, max = 0;  // p95: 95th percentile by nearest rank
  FARCULL_FIELDS(median, p95, max)
};
/// Returns the frames per second if a frame takes `ms` milliseconds. Empty if the result is
/// infinite or not positive.
std::optional<double> per_second(double ms);
FrameTimes summary_of(std::vector<double> ms);

/// The results of a finished frame.
struct FrameReport {
  const nlohmann::ordered_json& head;     // entries of the record that hold for all frames
  const nlohmann::ordered_json& frame;    // an element of `frames` in the record
  const nlohmann::ordered_json& summary;  // totals of the frames up to this one
  std::string rows;                       // rows of a table for people
  std::string pairs_csv;                  // rows of CSV, with a column `frame`
  long number = 0;                        // number of the frame
  std::string certificate;                // empty if FramesQuestion::certificates is false
};
using FrameSink = std::function<void(const FrameReport&)>;

/// Writes a record {HEAD, "frames": [FRAME, ...], "summary": SUMMARY} frame by frame. The text is
/// formatted as by ordered_json::dump(2).
class FrameRecord {
 public:
  explicit FrameRecord(std::string path) : output_(std::move(path)) {}
  /// Adds a frame. head: an object, may be empty; used only in the first call. summary: totals of
  /// all frames so far. Throws Error as GrowingOutput does.
  void add(const nlohmann::ordered_json& head, const nlohmann::ordered_json& frame,
           const nlohmann::ordered_json& summary);
  void add(const FrameReport& report) { add(report.head, report.frame, report.summary); }
  void finish() { output_.finish(); }

 private:
  GrowingOutput output_;
  bool begun_ = false;
};

struct FramesResult {
  nlohmann::ordered_json json;  // docs/record.md; `frames` is left out if there is a sink
  std::string table;            // text for people; without rows of frames if there is a sink
  std::string pairs_csv;        // empty if there is a sink
  std::string broken;           // the first guarantee that was broken; empty: none
  Accounting sum;               // totals over all frames, without examples
  NothingToTest nothing;        // why no frame has a pair to test; empty if a frame has one
};

/// Runs every frame of the scene. `sink` gets each frame as soon as it is done. SIGINT, SIGTERM and
/// SIGHUP end the program at once, and a line on standard error says how many frames were done.
/// Throws Error as FrameSource, run() and the sink do.
FramesResult run_frames(const std::vector<std::string>& scene, const FramesQuestion& question,
                        const Progress& progress = {}, const FrameSink& sink = {});
/// Runs every frame of a source. Ignores question.self.
FramesResult run_frames(FrameSource& source, const FramesQuestion& question,
                        const Progress& progress = {}, const FrameSink& sink = {});

}  // namespace farcull
