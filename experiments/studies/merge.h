// Joins shards of studies, each measured into a file of its own.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/store.h"
#include "experiments/studies/study.h"

namespace farcull {

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

}  // namespace farcull
