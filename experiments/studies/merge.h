// Joins shards of studies, each measured into a file of its own.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/store.h"

namespace farcull {

/// The files of the shards in a folder, by name. Throws Error where there is none.
std::vector<std::string> shard_files(const std::string& folder);

struct MergeSummary {
  std::size_t files = 0, studies = 0, rows = 0;
  std::size_t machines = 0;  // that differ in device, driver, CPU or its features
};

/// Writes the store `out` with the rows of all files; it appears whole or not at all. Throws Error
/// naming the file where it is none of ours, where its studies, grids, seeds or commit are not
/// those of the first file, where two files hold the same shard or the same point, where a shard or
/// a point has no row in any of them, where rows are of two versions of one library (versions.h),
/// and where `out` or a journal of it is there already.
MergeSummary merge_stores(const std::vector<std::string>& files, const std::string& out);

}  // namespace farcull
