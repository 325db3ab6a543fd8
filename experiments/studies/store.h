// The store of results: one SQLite file. Each row is written in one transaction. A run that ends
// early (a signal, a full disk, a power failure) loses at most the point that was being measured.
// The tables are `studies`, with one row for each declared grid, and
//   runs    one row for each start of the program: commit, device, driver, CPU, options, time
//   points  all points of the declared grid of each study, for all shards
//   rows    one row for each measured point: its result, and the number of its run
// PRAGMA user_version holds kStoreVersion, and PRAGMA application_id holds kStoreId.
#pragma once

#include <memory>

#include "experiments/studies/study.h"

namespace farcull {

/// The program, the machine and the time of a measurement.
struct Provenance {
  std::string started;  // start of the program; UTC, ISO 8601
  std::string commit;   // Git commit of the program
  /// Names of the GL device. If the native canvas draws, gl_renderer is "native" with the
  /// instruction set, as in "native (AVX3)", and the other two are empty.
  std::string gl_vendor = {}, gl_renderer = {}, gl_version = {};
  std::string cpu;           // model of the processor
  std::string cpu_features;  // as /proc/cpuinfo lists them
  unsigned cores = 0;
  std::string options;  // options of the command line, as JSON
  FARCULL_FIELDS(started, commit, gl_vendor, gl_renderer, gl_version, cpu, cpu_features, cores,
                 options)
};

/// Returns the provenance of this process, with the device that Session chooses. Opens a GL device
/// to read its names. Throws Error if the named device does not answer.
Provenance provenance_now(const std::string& device, const std::string& options);

constexpr std::int32_t kStoreId = 0x46415243;  // "FARC"
constexpr std::int32_t kStoreVersion = 1;

/// The grid of a study in a store.
struct Declaration {
  std::string study;
  GridChoice choice;
  int shard = 1, of = 1;         // the shard in this file, 1 <= shard <= of
  std::vector<PointKey> points;  // the points of all shards
};

struct Row {
  std::size_t position = 0;  // position of the point in the grid
  PointKey point;
  Measurement measurement;
  std::int64_t run = 0;
  std::string measured;  // time of the measurement; UTC, ISO 8601
};

struct StoredStudy {
  Declaration declaration;
  std::vector<Row> rows;  // sorted by position
  /// True if every point of the grid has a row, and is_whole() is true for each row.
  bool complete() const;
};

// The times of a timed point (is_timed()), in its row:
//   total     the median over the runs of all rounds that are not void
//   rounds    one object per round so far: the times of its runs in ms ("ms"), the share of the
//             processors that other programs took meanwhile ("load"; null if unknown), and
//             whether this load was too high ("void")
//   no_times  true if the point was measured without times (--no-times)
/// Returns the number of rounds in the row; empty if the row's point is not timed.
std::optional<int> rounds_in(const Measurement& row);
/// True if nothing in the row remains to be measured.
bool is_whole(const Measurement& row);

class Store {
 public:
  /// write_at_once: keeps no journal beside the file. This is for a file that is renamed when the
  /// file is complete.
  enum class Access { read, write, write_at_once };
  /// write: creates the file if it does not exist, and locks out every other program until this
  /// object is destroyed. Throws Error naming the path if the file is no store of farcull, has
  /// another version, is damaged or in use, or cannot be opened.
  Store(const std::string& path, Access access);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  const std::string& path() const;

  /// Adds a run, and returns its number in this file.
  std::int64_t begin_run(const Provenance& provenance);
  std::vector<std::pair<std::int64_t, Provenance>> runs() const;

  std::vector<std::string> studies() const;
  /// Returns the declaration of the study; empty if this store has none.
  std::optional<Declaration> declaration(const std::string& study) const;
  /// Declares a study. Does nothing if the study has the same declaration already. Throws Error if
  /// the study has another declaration.
  void declare(const Declaration& declaration);
  /// Adds a row in one transaction. The row is on the disk when the function returns. Replaces an
  /// old row only if the old row says why nothing was measured, lacks rounds or has void rounds.
  /// Throws Error, with the file unchanged, if the point has any other row, if the point is not in
  /// the grid, or if writing fails.
  void add(const std::string& study, std::int64_t run, std::size_t position,
           const Measurement& measurement);
  /// Adds a row of another store. row.run: number of a run in this store. Ignores row.point.
  void add(const std::string& study, const Row& row);
  /// Runs `work` in one transaction. If `work` throws, nothing that it added is kept.
  void together(const std::function<void()>& work);

  StoredStudy study(const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns FOLDER/results.sqlite, or FOLDER/results-K-of-N.sqlite for shard K of N.
std::string store_path(const std::string& folder, int shard = 1, int of = 1);

/// Returns FOLDER/on-DEVICE, the folder for the store of results on this device. Throws Error
/// naming --devices if on-DEVICE is no valid file name.
std::string device_folder(const std::string& folder, const std::string& device);

}  // namespace farcull
