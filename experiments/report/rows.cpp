#include "experiments/report/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/report/numbers.h"
#include "experiments/tables.h"

namespace farcull {

std::vector<SceneRows> rows_by_scene(const StoredStudy& stored) {
  std::vector<SceneRows> out;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty()) continue;
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const SceneRows& rows) { return rows.scene == row.point.scene; });
    if (at == out.end()) {
      out.push_back({row.point.scene, {}});
      at = out.end() - 1;
    }
    at->rows.push_back(&row);
  }
  return out;
}

std::string contestant(const Point& point) {
  std::string out = method_label(point);
  if (!point.radius.empty() && point.radius != "budget") {
    out += point.radius == "published" ? ", published radius" : ", radius " + point.radius;
  }
  return out;
}

std::vector<std::string> contestants_in(const std::vector<const Row*>& rows) {
  std::vector<std::string> out;
  for (const Row* row : rows) {
    const std::string name = contestant(row->point);
    if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  }
  return out;
}

std::uint64_t number_of(const Row& row, const std::string& name) {
  return static_cast<std::uint64_t>(count_of(row, name).value_or(0));
}

std::string count_cell(const Row& row, const std::string& name) {
  const auto value = count_of(row, name);
  return value ? grouped(static_cast<std::uint64_t>(*value)) : "-";
}

std::string time_cell(const Row& row, const std::string& name) {
  const auto value = time_of(row, name);
  return value ? rounded(*value) : "-";
}

std::string of_all(std::uint64_t part, std::uint64_t all) {
  return grouped(part) + " of " + grouped(all);
}

bool promises(const Row& row) {
  const auto it = row.measurement.counts.find("promises");
  return it != row.measurement.counts.end() && it->is_boolean() && it->get<bool>();
}

void add_promises(const StoredStudy& stored, Chapter& chapter) {
  std::uint64_t rows = 0, colliding = 0, broken = 0;
  std::vector<std::string> names;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty() || !promises(row)) continue;
    ++rows;
    colliding += number_of(row, "colliding");
    const std::string name = contestant(row.point);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    const std::uint64_t missed = number_of(row, "missed");
    if (missed == 0) continue;
    ++broken;
    chapter.findings.push_back(
        fmt::format("BROKEN: {} misses {} colliding pairs, and promises to miss none.",
                    describe(row.point), of_all(missed, number_of(row, "colliding"))));
  }
  if (rows == 0 || broken > 0) return;
  chapter.findings.push_back(
      fmt::format("What promises keeps its promise: {} miss 0 of {} colliding pairs in {} runs.",
                  listed(names), grouped(colliding), grouped(rows)));
}

void add_gaps(const StoredStudy& stored, Chapter& chapter) {
  std::map<std::string, std::uint64_t> reasons;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty()) ++reasons[row.measurement.left_out];
  }
  for (const auto& [reason, count] : reasons) {
    chapter.limits.push_back(fmt::format("Left out at {} points: {}.",
                                         of_all(count, stored.declaration.points.size()), reason));
  }
  if (!stored.complete()) {
    chapter.limits.push_back(
        fmt::format("Not finished: {} points are measured.",
                    of_all(stored.rows.size(), stored.declaration.points.size())));
  }
}

Chapter begin_chapter(const StoredStudy& stored) {
  Chapter out;
  out.study = stored.declaration.study;
  const Study& study = study_named(out.study);
  out.title = study.title;
  out.question = study.question;
  out.command = command_of(stored.declaration);
  return out;
}

}  // namespace farcull
