// Rows of a study as its chapters look at them: by scene and by what was measured.
#pragma once

#include <cstdint>
#include <optional>
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

/// Candidates that do not collide, over what collides; NaN where nothing does or the row has no
/// candidates.
double false_positives(const Row& row);

/// Whether the method promises to miss nothing, by its own word.
bool promises(const Row& row);

/// Whether the row is of the lemma experiment: it promises for points that may be violated, not
/// for pairs that may be missed.
bool is_lemma(const Row& row);
/// What the promise of the row is about: `violations` of a lemma, `missed` of others; empty where
/// the row does not say.
std::optional<double> failures_of(const Row& row);
/// Whether the row promises and did not keep it.
bool breaks(const Row& row);

/// What a reader must hear first, whatever else a chapter finds: a finding that begins with
/// kBroken for each row that promises and missed or violated something, or where none did, how
/// many pairs and points those were that could have been. Rows that promise and do not say what
/// they missed are counted apart.
void add_promises(const StoredStudy& stored, Chapter& chapter);
/// How many points have no row, and why points were left out.
void add_gaps(const StoredStudy& stored, Chapter& chapter);
/// Findings that begin with kBroken before all others, each kind in its order.
void put_broken_first(Chapter& chapter);

/// A chapter with the names and the command of its study.
Chapter begin_chapter(const StoredStudy& stored);

}  // namespace farcull
