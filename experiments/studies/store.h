// The store of results: one SQLite file, a transaction for every row, so that a run that is ended
// (by a signal, a full disk, the power) loses at most the point that was being measured.
//
//   runs    one row for each start of the program: commit, device, driver, CPU, options, time
//   points  the declared grid of each study, all shards of it
//   rows    the result of a point, and its run
// PRAGMA user_version holds kStoreVersion, PRAGMA application_id kStoreId.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/studies/study.h"

namespace farcull {

/// Which program measured, on which machine, when.
struct Provenance {
  std::string started;  // UTC, ISO 8601
  std::string commit;   // of the program
  /// Names of the GL device. If the native canvas draws, gl_renderer is "native" with the
  /// instruction set, as in "native (AVX3)", and the other two are empty.
  std::string gl_vendor, gl_renderer, gl_version;
  std::string cpu;           // model
  std::string cpu_features;  // as /proc/cpuinfo lists them
  unsigned cores = 0;
  std::string options;  // of the command line, as JSON
  FARCULL_FIELDS(started, commit, gl_vendor, gl_renderer, gl_version, cpu, cpu_features, cores,
                 options)
};

/// Vendor and version of the driver for people; "none" on the native canvas.
std::string driver_text(const Provenance& provenance);

/// The provenance of this process, with the device that Session chooses. A GL device is opened to
/// ask for its names; throws Error where the one that was named does not answer.
Provenance provenance_now(const std::string& device, const std::string& options);

constexpr std::int32_t kStoreId = 0x46415243;  // "FARC"
constexpr std::int32_t kStoreVersion = 1;

/// The grid of a study in a store.
struct Declaration {
  std::string study;
  GridChoice choice;
  int shard = 1, of = 1;         // which part of the points this file answers for, 1 <= shard <= of
  std::vector<PointKey> points;  // of all shards
};

struct Row {
  std::size_t position = 0;  // in the grid
  PointKey point;
  Measurement measurement;
  std::int64_t run = 0;
  std::string measured;  // UTC, ISO 8601
};

struct StoredStudy {
  Declaration declaration;
  std::vector<Row> rows;  // by position
  /// Whether every point of the grid has a row, of whatever shard.
  bool complete() const { return rows.size() == declaration.points.size(); }
};

class Store {
 public:
  enum class Access { read, write };
  /// write: makes the file where it is not there, and keeps every other program out until it is
  /// closed. Throws Error naming the path for a file that is no store of ours, of another version,
  /// damaged, in use, or that cannot be opened.
  Store(const std::string& path, Access access);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  const std::string& path() const;

  /// The number of the run in this file.
  std::int64_t begin_run(const Provenance& provenance);
  std::vector<std::pair<std::int64_t, Provenance>> runs() const;

  std::vector<std::string> studies() const;
  /// Empty where the study was not declared here.
  std::optional<Declaration> declaration(const std::string& study) const;
  /// The same again changes nothing. Throws Error where the study was declared otherwise.
  void declare(const Declaration& declaration);
  /// Adds a row in one transaction, on the disk when it returns. A row that says why nothing was
  /// measured is replaced. Throws Error where the point has another row, is not in the grid, or
  /// the disk refuses; the file is then as before.
  void add(const std::string& study, std::int64_t run, std::size_t position,
           const Measurement& measurement);
  /// The same for a row of another store; row.run is the number here. `point` is not read.
  void add(const std::string& study, const Row& row);
  /// Runs `work` in one transaction: all that it adds is kept, or nothing where it throws.
  void together(const std::function<void()>& work);

  StoredStudy study(const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// DIR/results.sqlite, or DIR/results-K-of-N.sqlite for a shard.
std::string store_path(const std::string& folder, int shard = 1, int of = 1);

/// DIR/on-DEVICE: the folder of the results of a further device, a store of its own. Throws Error
/// naming --devices where a file cannot be called so.
std::string device_folder(const std::string& folder, const std::string& device);
/// The folders of further devices in DIR that hold a store, by name.
std::vector<std::string> device_folders(const std::string& folder);

}  // namespace farcull
