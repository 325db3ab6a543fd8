// Sums of the counts of rows.
#include "experiments/report/chapters/library_rows.h"

#include "experiments/report/chapters/numbers.h"
#include "experiments/system/text_table.h"

namespace farcull {

std::string family_of(const Row& row) {
  return row.point.scene.substr(row.point.scene.find('/') + 1);
}

bool is_ours(const Row& row) { return text_of(row, "library") == "farcull"; }

Rows rows_about(const Rows& rows, bool pairs) {
  Rows out;
  for (const Row* row : rows) {
    if (family_of(*row).starts_with("pairs/") == pairs) out.push_back(row);
  }
  return out;
}

std::uint64_t deaths(const Rows& rows) {
  return total(rows, "crashed") + total(rows, "hung") + total(rows, "no_memory");
}

std::uint64_t without_answer(const Rows& rows) {
  return total(rows, "refused") + total(rows, "unanswered") + total(rows, "not_asked") +
         deaths(rows);
}

std::string differing(const Rows& rows) {
  const std::uint64_t otherwise = total(rows, "differing");
  return otherwise == 0 ? "0" : of_all(otherwise, total(rows, "twice"));
}

MeshAnswers mesh_answers(const Rows& rows, bool own) {
  MeshAnswers out{.colliding = total(rows, own ? "own_asked" : "answered"),
                  .missed = total(rows, own ? "own_missed" : "missed"),
                  .false_alarms = total(rows, own ? "own_wrong" : "wrong")};
  out.reported = out.colliding - out.missed + out.false_alarms;
  return out;
}

double wrong_part(const MeshAnswers& answers) {
  const std::uint64_t all = answers.colliding + answers.false_alarms;
  if (all == 0) return 0;
  return static_cast<double>(answers.missed + answers.false_alarms) / static_cast<double>(all);
}

}  // namespace farcull
