// Rows of a study as its chapters look at them: by scene and by what was measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/report/chapter.h"
#include "experiments/studies/store.h"

namespace farcull {

/// The rows that were measured, of one scene, in the order of the grid.
struct SceneRows {
  std::string scene;
  std::vector<const Row*> rows;  // point into the StoredStudy
};
std::vector<SceneRows> rows_by_scene(const StoredStudy& stored);

/// method_label(), with the radius where it is not the budget: "FAR (OBB), published radius".
std::string contestant(const Point& point);
/// All of these rows, each once, in the order of the first.
std::vector<std::string> contestants_in(const std::vector<const Row*>& rows);

/// A count that the study must have; 0 where it has not. (Rows of later versions may lack it.)
std::uint64_t number_of(const Row& row, const std::string& name);
/// A count for people, "-" where the row has none.
std::string count_cell(const Row& row, const std::string& name);
std::string time_cell(const Row& row, const std::string& name);
/// "4 of 3,857".
std::string of_all(std::uint64_t part, std::uint64_t all);

/// Whether the method promises to miss nothing, by its own word.
bool promises(const Row& row);

/// What a reader must hear first, whatever else a chapter finds: a finding that begins with BROKEN
/// for each row of a method that promises and missed, or one that says how many such rows there
/// are and that none did. Then how many points have no row, and why points were left out.
void add_promises(const StoredStudy& stored, Chapter& chapter);
void add_gaps(const StoredStudy& stored, Chapter& chapter);

/// A chapter with the names and the command of its study.
Chapter begin_chapter(const StoredStudy& stored);

}  // namespace farcull
