// Versions of libraries: the rows of one contestant must be of one version of its library. A store
// into which a study goes on after an upgrade, or shards of two machines, would else hold two, and
// a table would show them as one.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/store.h"
#include "experiments/studies/study.h"

namespace farcull {

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

}  // namespace farcull
