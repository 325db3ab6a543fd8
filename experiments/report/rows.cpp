#include "experiments/report/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
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

double false_positives(const Row& row) {
  const auto candidates = count_of(row, "candidates"), colliding = count_of(row, "colliding");
  if (!candidates || !colliding || *colliding == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double found = *colliding - static_cast<double>(number_of(row, "missed"));
  return (*candidates - found) / *colliding;
}

bool promises(const Row& row) {
  const auto it = row.measurement.counts.find("promises");
  return it != row.measurement.counts.end() && it->is_boolean() && it->get<bool>();
}

bool is_lemma(const Row& row) { return row.point.method.starts_with("lemma"); }

std::optional<double> failures_of(const Row& row) {
  return count_of(row, is_lemma(row) ? "violations" : "missed");
}

bool breaks(const Row& row) {
  return row.measurement.left_out.empty() && promises(row) && failures_of(row).value_or(0) > 0;
}

void add_promises(const StoredStudy& stored, Chapter& chapter) {
  // Of those that say what they missed.
  struct Kept {
    std::uint64_t rows = 0, of = 0;
    bool broken = false;
    std::vector<std::string> names;
  } pairs, points;
  std::uint64_t silent = 0;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty() || !promises(row)) continue;
    const std::optional<double> failed = failures_of(row);
    if (!failed) {
      ++silent;
      continue;
    }
    const bool lemma = is_lemma(row);
    Kept& kept = lemma ? points : pairs;
    const std::uint64_t of = number_of(row, lemma ? "points" : "colliding");
    ++kept.rows;
    kept.of += of;
    const std::string name = contestant(row.point);
    if (std::find(kept.names.begin(), kept.names.end(), name) == kept.names.end())
      kept.names.push_back(name);
    if (!breaks(row)) continue;
    kept.broken = true;
    const std::string part = of_all(static_cast<std::uint64_t>(*failed), of);
    chapter.findings.push_back(
        lemma ? fmt::format("{} {}: {} points are violated, and the lemmas promise none.", kBroken,
                            describe(row.point), part)
              : fmt::format("{} {} misses {} colliding pairs, and promises to miss none.", kBroken,
                            describe(row.point), part));
  }
  if (pairs.rows > 0 && !pairs.broken) {
    chapter.findings.push_back(
        fmt::format("What promises keeps its promise: {} miss 0 of {} colliding pairs in {} runs.",
                    listed(pairs.names), grouped(pairs.of), grouped(pairs.rows)));
  }
  if (points.rows > 0 && !points.broken) {
    chapter.findings.push_back(
        fmt::format("What the lemmas promise holds: 0 of {} points are violated in {} runs.",
                    grouped(points.of), grouped(points.rows)));
  }
  if (silent > 0) {
    chapter.findings.push_back(fmt::format(
        "{} of methods that promise {} not say what they missed.",
        silent == 1 ? "One row" : grouped(silent) + " rows", silent == 1 ? "does" : "do"));
  }
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

void put_broken_first(Chapter& chapter) {
  std::stable_partition(chapter.findings.begin(), chapter.findings.end(), is_broken);
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
