// Measures the points of studies one after the other and keeps every answer at once.
//
// And joins shards of studies.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/studies/store.h"
#include "experiments/studies/study.h"

namespace farcull {

// ---- shards, each measured into a file of its own, and their join ----

// Versions of libraries: the rows of one contestant must be of one version of its library. A store
// into which a study goes on after an upgrade, or shards of two machines, would else hold two, and
// a table would show them as one.

/// Refuses to measure the points at the positions `open` of the grid where rows of the same
/// contestant, or peer, name another version of its library than the one that would answer now. A
/// contestant that is not here now adds no rows of another version, so its rows stay. Throws Error
/// naming the store at `path`, each such contestant with both versions, and the command that
/// deletes the old rows.
void require_same_versions(const std::string& path, const StoredStudy& stored, const Study& study,
                           const std::vector<Point>& points, const std::vector<std::size_t>& open);

/// A study as one file holds it.
struct StudyOfFile {
  std::string path;
  const StoredStudy* stored = nullptr;
};
/// Refuses rows of one contestant, or peer, that name two versions of its library, within a file or
/// in two of them. Throws Error naming both files and both versions.
void require_one_version(const std::vector<StudyOfFile>& files);

/// The files of the shards in a folder, by name. Throws Error where no file is there.
std::vector<std::string> shard_files(const std::string& folder);

struct MergeSummary {
  std::size_t files = 0, studies = 0, rows = 0;
  std::size_t machines = 0;  // that differ in device, driver, CPU or its features
};

/// Writes the store `out` with the rows of all files; it appears whole or not at all. Throws Error
/// naming the file where it is no store of ours, where its studies, grids, seeds or commit are not
/// those of the first file, where two files hold the same shard or the same point, where a shard or
/// a point has no row in any of them, where rows are of two versions of one library, as
/// require_one_version() says, and where `out` or a journal of it is there already.
MergeSummary merge_stores(const std::vector<std::string>& files, const std::string& out);

// ---- runs ----

struct Shard {
  int index = 1, of = 1;  // 1 <= index <= of
  std::string from;       // where it was read, for people; empty: nothing was divided

  /// Every of-th point, so that each shard has its share of the cheap and the costly ones.
  bool holds(std::size_t position) const {
    return position % static_cast<std::size_t>(of) == static_cast<std::size_t>(index - 1);
  }
};

/// "K/N" with 1 <= K <= N <= 100000. Throws Error naming --shard.
Shard parse_shard(const std::string& text);

/// The shard of this process of an array job of Slurm (SLURM_ARRAY_TASK_ID, _MIN, _MAX, _COUNT;
/// steps of one from 0 or 1) or of Open MPI (OMPI_COMM_WORLD_RANK, _SIZE); the whole study where
/// neither is set. `variable` gives an environment variable or null. Throws Error naming the
/// variable where it is no number, the array has gaps, or both are set.
Shard shard_from_environment(const std::function<const char*(const char*)>& variable);

struct StudiesRequest {
  std::vector<Study> studies;
  std::string folder;  // made where it is not there
  GridChoice choice;
  bool resume = false;  // go on where the store has rows of a study already
  Shard shard;
  std::string device;     // as --device
  Provenance provenance;  // of this run
};

/// How far it is.
struct StudiesProgress {
  std::string study;
  std::string point;                  // in words
  std::string stage;                  // of its run
  std::size_t done = 0, points = 0;   // of this shard, in all studies, those of earlier runs among
                                      // them
  std::optional<double> remaining_s;  // as the points before took; empty until one was measured
};

struct StudySummary {
  std::string study;
  std::size_t points = 0;    // of this shard
  std::size_t before = 0;    // had a row already
  std::size_t measured = 0;  // in this run, those left out among them
  std::size_t left_out = 0;  // of all rows: nothing could be measured, and the row says why
  double seconds = 0;        // of this run
};

struct StudiesSummary {
  std::string store;  // path
  std::vector<StudySummary> studies;
  /// Points whose measuring failed, in words, with the error. They have no row and are tried again
  /// by the next run.
  std::vector<std::string> failed;
  /// Rows, of this run or an earlier one, of methods that broke their promise. Empty, or the worst
  /// has happened.
  std::vector<std::string> broken;
};

/// Measures what has no row yet, or one that says why nothing was measured. An Error at a point is
/// noted and the next point gets a new device; one of the store ends the run. Signals end the
/// program, with a line that says how many points are kept. Throws Error for a folder that cannot
/// be made, a store as Store and Store::declare() refuse it, one that has rows of a study where
/// `resume` is not set, or rows by another commit of farcull, another device, other CPU features,
/// or another version of a library.
StudiesSummary run_studies(const StudiesRequest& request,
                           const std::function<void(const StudiesProgress&)>& progress = {});

/// For people.
std::string summary_table(const StudiesSummary& summary);

}  // namespace farcull
