// Selects and sums rows, and writes the findings that every chapter has.
#include "experiments/report/chapters/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/report/chapters/numbers.h"
#include "experiments/studies/point.h"
#include "experiments/system/text_table.h"

namespace farcull {

namespace {

template <class NameOf>
std::vector<NamedRows> named(const Rows& rows, const NameOf& name_of) {
  std::vector<NamedRows> out;
  for (const Row* row : rows) {
    const std::string name = name_of(row->point);
    auto at =
        std::find_if(out.begin(), out.end(), [&](const auto& one) { return one.name == name; });
    if (at == out.end()) at = out.insert(at, {name, {}});
    at->rows.push_back(row);
  }
  return out;
}

}  // namespace

Rows measured(const StoredStudy& stored) {
  Rows out;
  for (const Row& row : stored.rows) {
    if (row.measurement.left_out.empty()) out.push_back(&row);
  }
  return out;
}

std::vector<NamedRows> rows_by_scene(const StoredStudy& stored) {
  return named(measured(stored), [](const PointKey& point) { return point.scene; });
}

std::vector<NamedRows> rows_by_contestant(const Rows& rows) { return named(rows, contestant); }

const Row* at_resolution(const Rows& rows, int resolution) {
  const auto at = std::find_if(rows.begin(), rows.end(),
                               [&](const Row* row) { return row->point.resolution == resolution; });
  return at == rows.end() ? nullptr : *at;
}

const Row* find_row(const Rows& rows, const std::string& name, int resolution) {
  const auto at = std::find_if(rows.begin(), rows.end(), [&](const Row* row) {
    return row->point.resolution == resolution && contestant(row->point) == name;
  });
  return at == rows.end() ? nullptr : *at;
}

std::set<int> resolutions_in(const Rows& rows) {
  std::set<int> out;
  for (const Row* row : rows) {
    if (row->point.resolution > 0) out.insert(row->point.resolution);
  }
  return out;
}

std::vector<Column> columns(const std::vector<std::string>& texts,
                            const std::vector<std::string>& numbers,
                            const std::vector<std::string>& more_texts,
                            const std::vector<std::string>& more_numbers) {
  std::vector<Column> out;
  for (const auto* names : {&texts, &numbers, &more_texts, &more_numbers}) {
    const bool text = names == &texts || names == &more_texts;
    for (const std::string& name : *names) out.push_back(text ? text_column(name) : Column{name});
  }
  return out;
}

std::string contestant(const PointKey& point) {
  std::string out = method_label(point);
  if (point.radius && point.radius != RadiusRule{}) {
    out += point.radius->published ? ", published radius" : ", radius " + column_text(point.radius);
  }
  if (point.views == kBothDirections) out += ", both directions";
  return out;
}

std::uint64_t number_of(const Row& row, const std::string& name) {
  return static_cast<std::uint64_t>(count_of(row, name).value_or(0));
}

std::uint64_t total(const Rows& rows, const std::string& name) {
  std::uint64_t out = 0;
  for (const Row* row : rows) out += number_of(*row, name);
  return out;
}

double largest(const Rows& rows, const std::string& name, double missing) {
  double out = 0;
  for (const Row* row : rows) out = std::max(out, count_of(*row, name).value_or(missing));
  return out;
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

std::string of_all(const Rows& rows, const std::string& part, const std::string& all) {
  return of_all(total(rows, part), total(rows, all));
}

double share(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? kNone : 100 * static_cast<double>(part) / static_cast<double>(all);
}

RowColumn scene_column() {
  return {text_column("scene"), [](const Row& row) { return row.point.scene; }};
}

RowColumn contestant_column() {
  return {text_column("method"), [](const Row& row) { return contestant(row.point); }};
}

RowColumn resolution_column(const std::string& name, const std::string& none) {
  return {{name}, [none](const Row& row) {
            return row.point.resolution > 0 ? std::to_string(row.point.resolution) : none;
          }};
}

RowColumn count_column(const std::string& name, const std::string& count) {
  return {{name}, [count](const Row& row) { return count_cell(row, count); }};
}

RowColumn rounded_column(const std::string& name, const std::string& count, int digits) {
  return {{name},
          [=](const Row& row) { return rounded(count_of(row, count).value_or(kNone), digits); }};
}

RowColumn time_column(const std::string& name, const std::string& time) {
  return {{name}, [time](const Row& row) { return time_cell(row, time); }};
}

DataTable table_of_rows(const std::string& name, const std::string& caption, const Rows& rows,
                        const std::vector<RowColumn>& columns) {
  DataTable out{.name = name, .caption = caption, .columns = {}, .in_text = false};
  for (const RowColumn& column : columns) out.columns.push_back(column.column);
  for (const Row* row : rows) {
    std::vector<std::string>& cells = out.rows.emplace_back();
    for (const RowColumn& column : columns) cells.push_back(column.cell(*row));
  }
  return out;
}

Series series_of(const std::string& name, const Rows& rows, const Value& x, const Value& y) {
  Series out{.name = name};
  for (const Row* row : rows) {
    out.x.push_back(x(*row));
    out.y.push_back(y(*row));
  }
  return out;
}

Series times_of(const std::string& name, const Rows& rows, const Value& x) {
  Series out{.name = name};
  for (const Row* row : rows) {
    const Estimate ms = time_estimate(*row).value_or(Estimate{kNone, kNone, kNone, 0});
    const bool bar = ms.n > 1;
    out.x.push_back(x(*row));
    out.y.push_back(ms.value);
    out.y_low.push_back(bar ? ms.low : kNone);
    out.y_high.push_back(bar ? ms.high : kNone);
  }
  return out;
}

std::optional<Estimate> time_estimate(const Row& row) {
  if (const std::vector<double> runs = runs_of(row); !runs.empty()) return median_estimate(runs);
  const std::optional<double> one = time_of(row, "total");
  if (!one) return {};
  return Estimate{*one, *one, *one, 1};
}

std::string estimate_text(const Estimate& estimate, int digits) {
  if (estimate.n == 0) return "-";
  const std::string value = rounded(estimate.value, digits);
  if (estimate.n == 1) return value;
  return fmt::format("{} ({} to {})", value, rounded(estimate.low, digits),
                     rounded(estimate.high, digits));
}

RowColumn estimate_column(const std::string& name) {
  return {{name},
          [](const Row& row) { return estimate_text(time_estimate(row).value_or(Estimate{})); }};
}

std::string sample_text(const Rows& rows) {
  std::set<std::size_t> runs;
  for (const Row* row : rows) runs.insert(std::max<std::size_t>(runs_of(*row).size(), 1));
  std::string out = fmt::format("n = {}", counted(rows.size(), "point", "points"));
  if (runs.empty()) return out;
  if (*runs.rbegin() == 1) return out + ", each of 1 run";
  return out + fmt::format(", each the median of {} runs",
                           runs.size() == 1
                               ? std::to_string(*runs.begin())
                               : fmt::format("{} to {}", *runs.begin(), *runs.rbegin()));
}

std::string at_most(std::uint64_t n) {
  return "at most " + rounded(std::min(1.0, 3 / static_cast<double>(n)), 2);
}

std::string with_bound(std::uint64_t part, std::uint64_t all) {
  if (part > 0 || all == 0) return of_all(part, all);
  return fmt::format("{} (a rate of {})", of_all(part, all), at_most(all));
}

double false_positives(const Row& row) {
  const auto candidates = count_of(row, "candidates"), colliding = count_of(row, "colliding");
  if (!candidates || !colliding || *colliding == 0) {
    return kNone;
  }
  const double found = *colliding - static_cast<double>(number_of(row, "missed"));
  return (*candidates - found) / *colliding;
}

bool promises(const Row& row) { return flag_of(row, "promises"); }

bool is_lemma(const Row& row) { return row.point.method.starts_with("lemma"); }

std::optional<double> failures_of(const Row& row) {
  return count_of(row, is_lemma(row) ? "violations" : "missed");
}

bool breaks(const Row& row) {
  return row.measurement.left_out.empty() && promises(row) && failures_of(row).value_or(0) > 0;
}

void add_promises(const StoredStudy& stored, Chapter& chapter) {
  // Rows whose run verified every pair or point, so that the failures are known.
  Rows pairs, points;
  std::uint64_t silent = 0;
  for (const Row* at : measured(stored)) {
    const Row& row = *at;
    if (!promises(row)) continue;
    const std::optional<double> failed = failures_of(row);
    if (!failed) {
      ++silent;
      continue;
    }
    const bool lemma = is_lemma(row);
    (lemma ? points : pairs).push_back(at);
    if (!breaks(row)) continue;
    const std::string part =
        of_all(static_cast<std::uint64_t>(*failed), number_of(row, lemma ? "points" : "colliding"));
    chapter.find_broken(
        describe(row.point) +
        (lemma ? fmt::format(": {} points are violated, and the lemmas promise none.", part)
               : fmt::format(" misses {} colliding pairs, and promises to miss none.", part)));
  }
  const auto kept = [](const Rows& rows) {
    return !rows.empty() &&
           std::none_of(rows.begin(), rows.end(), [](const Row* row) { return breaks(*row); });
  };
  if (kept(pairs)) {
    std::vector<std::string> names;
    for (const Row* row : pairs) {
      PointKey point = row->point;
      // At a resolution chosen by the size of triangles it is the same.
      point.method = point.method.substr(0, point.method.find(" @"));
      const std::string name = contestant(point);
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    chapter.find(fmt::format("{} missed {} colliding pairs in {}.", listed(names),
                             rate_text(0, total(pairs, "colliding")),
                             counted(pairs.size(), "run", "runs")));
  }
  if (kept(points)) {
    chapter.find(fmt::format("The lemmas are violated at {} points in {}.",
                             rate_text(0, total(points, "points")),
                             counted(points.size(), "run", "runs")));
  }
  if (silent > 0) {
    chapter.find(fmt::format("{} of methods that promise {} not say what they missed.",
                             silent == 1 ? "One row" : grouped(silent) + " rows",
                             silent == 1 ? "does" : "do"));
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
