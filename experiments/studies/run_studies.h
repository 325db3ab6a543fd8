// Measures the points of studies and stores every result at once. Also joins shards of studies.
//
// Timed points are measured in kRounds rounds. The first round measures all timed points of all
// studies. Then all other points are measured, and then the other rounds follow. So minutes pass
// between two rounds of a point. In a round, the points of one scene run in turn, so that a slow
// moment affects all methods alike.
#pragma once

#include "experiments/studies/store.h"
#include "experiments/system/machine.h"

namespace farcull {

// ---- shards, each measured into its own file, and their merge ----

// The rows of one contestant must have one version of its library. Otherwise a store that is
// resumed after an upgrade, or shards of two machines, would hold two versions, and a table would
// not tell them apart.

/// Throws Error if stored rows of a contestant or peer name another version of its library than the
/// present version. Checks only contestants and peers of the points to measure; `open` has the
/// positions of these points in the grid. Ignores contestants that are missing now, since they add
/// no rows. The error names the store at `path`, and each differing contestant's two versions.
void require_same_versions(const std::string& path, const StoredStudy& stored, const Study& study,
                           const std::vector<Point>& points, const std::vector<std::size_t>& open);

struct StudyOfFile {
  std::string path;
  const StoredStudy* stored = nullptr;
};
/// Throws Error if rows of one contestant or peer name two versions of its library, within a file
/// or in two files. The error names both files and both versions.
void require_one_version(const std::vector<StudyOfFile>& files);

/// Returns the files of the shards in a folder, sorted by name. Throws Error if there is no shard.
std::vector<std::string> shard_files(const std::string& folder);

struct MergeSummary {
  std::size_t files = 0, studies = 0, rows = 0;
  std::size_t machines = 0;  // machines that differ in device, driver, CPU or CPU features
};

/// Writes the store `out` with the rows of all files. The file `out` appears when it is complete.
/// Throws Error naming the file if
/// - a file is no store of farcull;
/// - the file's studies, grids, seeds or commit are not those of the first file;
/// - two files hold the same shard or the same point;
/// - a shard is in no file, or a point has no complete row;
/// - rows have two versions of one library (require_one_version());
/// - `out` or a journal of `out` exists already.
MergeSummary merge_stores(const std::vector<std::string>& files, const std::string& out);

struct Shard {
  int index = 1, of = 1;  // 1 <= index <= of

  /// True for one of every `of` positions, so that each shard gets both cheap and costly points.
  bool holds(std::size_t position) const {
    return position % static_cast<std::size_t>(of) == static_cast<std::size_t>(index - 1);
  }
};

/// Reads "K/N" with 1 <= K <= N <= 100000. Throws Error naming --shard for any other text.
Shard parse_shard(const std::string& text);

/// If other programs take a larger share of the processors than this, the round is measured again.
/// If three attempts fail, the round is marked void.
constexpr double kMostLoad = 0.1;

struct StudiesRequest {
  std::vector<Study> studies;
  std::string folder;  // created if it does not exist
  GridChoice choice;
  bool resume = false;  // true: a store that has rows of a study is continued
  Shard shard;
  std::string device;     // name of the device, as for --device
  Provenance provenance;  // program and machine of this run
  bool times = true;      // false: a timed point is run once, for its counts, and has no times
  double most_load = kMostLoad;
  std::string lock = TimingLock::kFile;  // tests use another file
};

struct StudiesProgress {
  std::string study;
  std::string point;                  // the current point, in words
  std::string stage;                  // the current stage of the point's run
  std::size_t done = 0, points = 0;   // finished and all points of this shard, in all studies
  std::optional<double> remaining_s;  // an estimate; empty until a point was measured
};

struct StudySummary {
  std::string study;
  std::size_t points = 0;       // the study's points in this shard
  std::size_t before = 0;       // points fully measured before this run
  std::size_t measured = 0;     // points finished in this run, including left-out points
  std::size_t left_out = 0;     // all rows that say why nothing was measured
  std::size_t void_rounds = 0;  // rounds with too much load, in all rows
  double seconds = 0;           // time that this run spent on the study
};

struct StudiesSummary {
  std::string store;  // path
  std::vector<StudySummary> studies;
  /// Points that could not be measured, in words, with the error. They have no row, and the next
  /// run tries them again.
  std::vector<std::string> failed;
  /// Rows of methods that broke their guarantee, in this run or in an earlier run.
  std::vector<std::string> broken;
};

/// Measures each point without a row in the store, and each point whose row has a reason in place
/// of a result, lacks rounds or has void rounds. If another study of the store has timed the same
/// point, copies the times. If both studies are `plain`, also copies the counts.
///
/// Holds the TimingLock while points are timed. If a point fails, its error is noted, and the next
/// point gets a new device. A signal ends the program, with a line that says how many points are
/// stored.
///
/// Throws Error if
/// - the folder cannot be created, or Store or Store::declare() refuses the store;
/// - another process measures times;
/// - the store has rows of a study, and `resume` is not set;
/// - the store has rows of another commit of farcull, another device, other CPU features, or
///   another version of a library.
StudiesSummary run_studies(const StudiesRequest& request,
                           const std::function<void(const StudiesProgress&)>& progress = {});

/// Returns the summary as a table for people.
std::string summary_table(const StudiesSummary& summary);

}  // namespace farcull
