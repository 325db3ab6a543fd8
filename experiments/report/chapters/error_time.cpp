// The chapter of the study "error-time": errors and false positives against time, and the Pareto
// front of each scene.
#include <fmt/format.h>

#include <algorithm>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// Pairs that the answer lacks plus pairs in it that do not collide.
double error_of(const Row& row) {
  return static_cast<double>(number_of(row, "missed") + number_of(row, "wrong"));
}

double ms_of(const Row& row) { return time_or_none(row, "total"); }

Rows timed(Rows rows) {
  std::erase_if(rows, [](const Row* row) { return !time_of(*row, "total"); });
  return rows;
}

// Rows that no other beats: none is as fast with as little error, and better in one of them.
// Fastest first; of equals the first.
Rows front_of(const Rows& rows) {
  Rows sorted = timed(rows);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Row* a, const Row* b) {
    return std::pair(ms_of(*a), error_of(*a)) < std::pair(ms_of(*b), error_of(*b));
  });
  Rows front;
  for (const Row* row : sorted) {
    if (front.empty() || error_of(*row) < error_of(*front.back())) front.push_back(row);
  }
  return front;
}

// The time of a row over that of another in the same study: of the medians, and the least and the
// most that their fastest and slowest runs allow.
std::string times_as_long(const Row& row, const Row& other) {
  const auto of = [](const Row& r, const char* name) {
    return time_of(r, name).value_or(ms_of(r));
  };
  return fmt::format("{} ({} to {})", rounded(ms_of(row) / ms_of(other)),
                     rounded(of(row, "total_min") / of(other, "total_max")),
                     rounded(of(row, "total_max") / of(other, "total_min")));
}

// The peer that times are given against: CGAL's box join, which every build has.
const Row* yardstick(const NamedRows& scene) {
  for (const Row* row : scene.rows) {
    if (row->point.method == "cgal-boxes" && time_of(*row, "total")) return row;
  }
  return nullptr;
}

std::string in_words(const Row& row) {
  std::string out = contestant(row.point);
  if (row.point.resolution > 0) out += fmt::format(" at {} px", row.point.resolution);
  return out;
}

Panel panel_of(const NamedRows& scene, const std::string& label, const Value& value) {
  Panel panel{.title = scene.name, .x = logarithmic("time (ms)"), .y = logarithmic(label, true)};
  for (const NamedRows& method : rows_by_contestant(scene.rows)) {
    const Rows rows = timed(method.rows);
    if (rows.empty()) continue;
    Series series = series_of(method.name, rows, ms_of, value);
    // One point has no line, nor have several that follow no resolution.
    const bool line = rows.size() > 1 && std::all_of(rows.begin(), rows.end(), [](const Row* row) {
                        return row->point.resolution > 0;
                      });
    series.style = line ? Series::Style::lines_points : Series::Style::points;
    series.emphasis = method.name == "FAR (OBB)" || method.name == "FAR pairs";
    panel.series.push_back(std::move(series));
  }
  return panel;
}

// The front as a staircase from its fastest row to the slowest of the panel.
Series front_series(const NamedRows& scene) {
  Series out{.name = "Pareto front", .style = Series::Style::lines};
  double last = 0;
  for (const Row* row : timed(scene.rows)) last = std::max(last, ms_of(*row));
  for (const Row* row : front_of(scene.rows)) {
    if (!out.y.empty()) {
      out.x.push_back(ms_of(*row));
      out.y.push_back(out.y.back());
    }
    out.x.push_back(ms_of(*row));
    out.y.push_back(error_of(*row));
  }
  if (!out.x.empty()) {
    out.x.push_back(last);
    out.y.push_back(out.y.back());
  }
  return out;
}

std::vector<Figure> figures_of(const std::vector<NamedRows>& scenes) {
  Figure error{
      .name = "error-time",
      .title = "Wrong answers against run time",
      .caption =
          "Pairs that are missed plus pairs that are reported and do not collide, over "
          "the median time from triangles to pairs. Lines follow the resolution. The "
          "line below the powers is 0. The Pareto front joins what nothing beats in both."};
  Figure kept{.name = "error-time-false-positives",
              .title = "Candidates that do not collide against run time",
              .caption =
                  "Candidates that are handed to exact tests and do not collide, over colliding "
                  "pairs. FCL and ODE use their own tests of triangles instead of exact tests, so "
                  "what they hand on is their answer."};
  for (const NamedRows& scene : scenes) {
    error.panels.push_back(panel_of(scene, "missed + wrong pairs", error_of));
    error.panels.back().series.push_back(front_series(scene));
    kept.panels.push_back(panel_of(scene, "false positives / colliding", false_positives));
  }
  return {std::move(error), std::move(kept)};
}

DataTable front_table(const std::vector<NamedRows>& scenes) {
  DataTable out{.name = "error-time-front",
                .caption =
                    "The Pareto fronts: nothing is as fast with as few errors. Times are "
                    "ratios of medians, with the least and the most that single runs allow",
                .columns = columns({"scene", "method"}, {"time over that of cgal-boxes", "missed",
                                                         "wrong", "colliding"})};
  for (const NamedRows& scene : scenes) {
    const Row* const peer = yardstick(scene);
    for (const Row* row : front_of(scene.rows)) {
      out.rows.push_back({scene.name, in_words(*row),
                          peer != nullptr ? times_as_long(*row, *peer) : "-",
                          count_cell(*row, "missed"), grouped(number_of(*row, "wrong")),
                          count_cell(*row, "colliding")});
    }
  }
  return out;
}

DataTable all_table(const Rows& rows) {
  const RowColumn wrong = {{"wrong"},
                           [](const Row& row) { return grouped(number_of(row, "wrong")); }};
  const RowColumn false_ones = {{"false positives"},
                                [](const Row& row) { return rounded(false_positives(row)); }};
  return table_of_rows("error-time-all",
                       "All points; times are medians with the fastest and slowest run", rows,
                       {scene_column(), contestant_column(), resolution_column("resolution", "-"),
                        time_column("ms", "total"), time_column("fastest", "total_min"),
                        time_column("slowest", "total_max"), count_column("missed", "missed"),
                        wrong, count_column("candidates", "candidates"),
                        count_column("colliding", "colliding"), false_ones});
}

void add_front_finding(const NamedRows& scene, Chapter& chapter) {
  const Rows front = front_of(scene.rows);
  if (front.empty()) return;
  std::vector<std::string> words;
  for (const Row* row : front) {
    words.push_back(fmt::format("{} ({} wrong)", in_words(*row),
                                grouped(static_cast<std::uint64_t>(error_of(*row)))));
  }
  chapter.find(fmt::format("On the front of {}: {}.", scene.name, listed(words)));
  // The fastest without an error, and the fastest other method behind it.
  Rows right = timed(scene.rows);
  std::erase_if(right, [](const Row* row) { return error_of(*row) > 0; });
  if (right.empty()) {
    chapter.find("No method is right on " + scene.name + ".");
    return;
  }
  const auto fastest = [](const Rows& rows) -> const Row* {
    const auto at = std::min_element(
        rows.begin(), rows.end(), [](const Row* a, const Row* b) { return ms_of(*a) < ms_of(*b); });
    return at == rows.end() ? nullptr : *at;
  };
  const Row* const best = fastest(right);
  std::erase_if(right,
                [&](const Row* row) { return contestant(row->point) == contestant(best->point); });
  const Row* const next = fastest(right);
  if (next == nullptr) return;
  chapter.find(fmt::format(
      "The fastest right answer on {} is that of {}; the next method, {}, takes {} times as long.",
      scene.name, in_words(*best), in_words(*next), times_as_long(*next, *best)));
}

// Adds the errors of libraries with a test of triangles of their own.
void add_narrow_findings(const Rows& rows, Chapter& chapter) {
  for (const char* name : {"fcl-float", "fcl-double", "ode-trimesh"}) {
    Rows of = rows;
    std::erase_if(of, [&](const Row* row) { return row->point.method != name; });
    if (of.empty()) continue;
    chapter.find(fmt::format(
        "{} misses {} colliding pairs and reports {} that do not collide, in {} scenes.",
        method_label(of.front()->point), of_all(of, "missed", "colliding"),
        grouped(total(of, "wrong")), grouped(of.size())));
  }
}

}  // namespace

Chapter error_time_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows rows = measured(stored);
  const std::vector<NamedRows> scenes = rows_by_scene(stored);
  add_promises(stored, out);
  for (const NamedRows& scene : scenes) add_front_finding(scene, out);
  add_narrow_findings(rows, out);
  out.limits = {
      "Times are one machine's. On a software device those of methods that draw say nothing about "
      "graphics hardware, and the front is another there.",
      "Every method may use all cores; FCL's traversal of two objects has one thread, and so has "
      "ODE.",
      "Embree and CGAL give candidates; they are right because exact tests follow, whose time is "
      "in theirs. What FCL and ODE take includes their own test of triangles.",
      "Contexts, shaders and Embree's device are made before; hierarchies and boxes belong to the "
      "run.",
      "On a scene tested against itself libraries leave pairs that share a vertex out, ours count "
      "those that collide beyond it. So on such a scene our times include the exact tests of all "
      "neighbours, which those of libraries do not. farcull bench leaves neighbours out for all."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = figures_of(scenes);
  out.tables = {front_table(scenes), all_table(rows)};
  return out;
}

}  // namespace farcull
