// Rows of a study as its chapters look at them: those that were measured, by scene, by method and
// by any other key, with sums of their counts and tables of them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "experiments/measure/harness.h"
#include "experiments/report/chapters/chapter.h"
#include "experiments/studies/store.h"

namespace farcull {

using Rows = std::vector<const Row*>;  // point into a StoredStudy

/// The rows that were measured, in the order of the grid.
Rows measured(const StoredStudy& stored);

/// The rows with the same name, in their order.
struct NamedRows {
  std::string name;
  Rows rows;
};
/// The rows that were measured by scene, in the order of the first of each.
std::vector<NamedRows> rows_by_scene(const StoredStudy& stored);
/// The same by contestant().
std::vector<NamedRows> rows_by_contestant(const Rows& rows);
/// The rows by key(row), keys ascending.
template <class KeyOf>
auto rows_by(const Rows& rows, const KeyOf& key) {
  std::map<std::decay_t<decltype(key(*rows.front()))>, Rows> out;
  for (const Row* row : rows) out[key(*row)].push_back(row);
  return out;
}

/// The first of the rows at that resolution; null where there is none.
const Row* at_resolution(const Rows& rows, int resolution);
/// The same of the rows of one contestant.
const Row* find_row(const Rows& rows, const std::string& name, int resolution);
/// Every resolution above 0, that is: declared in pixels.
std::set<int> resolutions_in(const Rows& rows);

/// method_label(), with the radius where it is not the budget ("FAR (OBB), published radius"), and
/// with views in both directions of each axis ("CULLIDE, one round, both directions").
std::string contestant(const PointKey& point);

/// A count that the study must have; 0 where it has not. (Rows of later versions may lack it.)
std::uint64_t number_of(const Row& row, const std::string& name);
/// The sum of that count over the rows.
std::uint64_t total(const Rows& rows, const std::string& name);
/// The largest, at least 0; a row without the count gives `missing`.
double largest(const Rows& rows, const std::string& name, double missing);
/// A count for people, "-" where the row has none.
std::string count_cell(const Row& row, const std::string& name);
std::string time_cell(const Row& row, const std::string& name);
/// "4 of 3,857".
std::string of_all(std::uint64_t part, std::uint64_t all);
/// The sums of two counts: "4 of 3,857".
std::string of_all(const Rows& rows, const std::string& part, const std::string& all);
/// Per cent; NaN of nothing.
double share(std::uint64_t part, std::uint64_t all);

/// Columns of text, of numbers, of text again and of numbers again.
std::vector<Column> columns(const std::vector<std::string>& texts,
                            const std::vector<std::string>& numbers,
                            const std::vector<std::string>& more_texts = {},
                            const std::vector<std::string>& more_numbers = {});

/// A column of a table of rows.
struct RowColumn {
  Column column;
  std::function<std::string(const Row&)> cell;
};
RowColumn scene_column();
RowColumn contestant_column();
/// The resolution, or `none` where the point has none.
RowColumn resolution_column(const std::string& name, const std::string& none);
RowColumn count_column(const std::string& name, const std::string& count);
/// The count as rounded() writes it, "-" where the row has none.
RowColumn rounded_column(const std::string& name, const std::string& count, int digits = 3);
RowColumn time_column(const std::string& name, const std::string& time);
DataTable table_of_rows(const std::string& name, const std::string& caption, const Rows& rows,
                        const std::vector<RowColumn>& columns);

/// The points x(row), y(row) of the rows in their order.
using Value = std::function<double(const Row&)>;
Series series_of(const std::string& name, const Rows& rows, const Value& x, const Value& y);
/// The same over the time from triangles to pairs, in ms, with its intervals.
Series times_of(const std::string& name, const Rows& rows, const Value& x);

/// The median of the row's runs with its 95 % interval (measure/harness.h); of a row with one
/// run, that run without an interval. Empty where the row has no time.
std::optional<Estimate> time_estimate(const Row& row);
/// "3.88 (3.70 to 4.10)"; without an interval where n is below 2, "-" where it is 0.
std::string estimate_text(const Estimate& estimate, int digits = 3);
/// A column of time_estimate() as text.
RowColumn estimate_column(const std::string& name);
/// "n = 24 points, each the median of 9 runs": how much the rows rest on.
std::string sample_text(const Rows& rows);
/// The upper bound of a rate of which none of n independent cases showed one, at 95 %: 3/n (Hanley
/// and Lippman-Hand, 1983). "at most 2.6e-05".
std::string at_most(std::uint64_t n);
/// "4 of 3,857", or "0 of 3,857 (a rate of at most 0.00078)".
std::string with_bound(std::uint64_t part, std::uint64_t all);

/// Candidates that do not collide, over what collides; NaN where nothing does or the row has no
/// candidates.
double false_positives(const Row& row);

/// Whether the method promises to miss nothing, as the row says.
bool promises(const Row& row);

/// Whether the row is of the lemma experiment: it promises for points that may be violated, not
/// for pairs that may be missed.
bool is_lemma(const Row& row);
/// The count that the promise of the row is about: `violations` of a lemma, `missed` of others;
/// empty where the row has none.
std::optional<double> failures_of(const Row& row);
/// Whether the row promises and did not keep it.
bool breaks(const Row& row);

/// Adds a broken promise for each row that promises and missed or violated something, or where none
/// did, how many pairs and points those were that could have been. Rows that promise and lack that
/// count are counted apart.
void add_promises(const StoredStudy& stored, Chapter& chapter);
/// Adds how many points have no row, and why points were left out.
void add_gaps(const StoredStudy& stored, Chapter& chapter);
/// Moves broken promises before all other findings, each kind in its order.
void put_broken_first(Chapter& chapter);

/// A chapter with the names and the command of its study.
Chapter begin_chapter(const StoredStudy& stored);

}  // namespace farcull
