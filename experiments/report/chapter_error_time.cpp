#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

// Pairs that the answer lacks, and pairs in it that do not collide.
double error_of(const Row& row) {
  return static_cast<double>(number_of(row, "missed") + number_of(row, "wrong"));
}

double ms_of(const Row& row) {
  return time_of(row, "total").value_or(std::numeric_limits<double>::quiet_NaN());
}

// Rows that no other beats: none is as fast with as little error, and better in one of them.
// Fastest first; of equals the first.
std::vector<const Row*> front_of(const std::vector<const Row*>& rows) {
  std::vector<const Row*> sorted;
  for (const Row* row : rows) {
    if (time_of(*row, "total")) sorted.push_back(row);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const Row* a, const Row* b) {
    return std::pair(ms_of(*a), error_of(*a)) < std::pair(ms_of(*b), error_of(*b));
  });
  std::vector<const Row*> front;
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
const Row* yardstick(const SceneRows& scene) {
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

using Value = double (*)(const Row&);

Panel panel_of(const SceneRows& scene, const std::string& label, Value value) {
  Panel panel{.title = scene.scene,
              .x = {.label = "time (ms)", .logarithmic = true},
              .y = {.label = label, .logarithmic = true, .shows_zero = true},
              .series = {}};
  for (const std::string& method : contestants_in(scene.rows)) {
    Series series{.name = method, .x = {}, .y = {}};
    std::size_t drawn = 0;
    for (const Row* row : scene.rows) {
      if (contestant(row->point) != method || !time_of(*row, "total")) continue;
      series.x.push_back(ms_of(*row));
      series.y.push_back(value(*row));
      drawn += row->point.resolution > 0;
    }
    // What has one point, or several that follow no resolution, has no line.
    series.style =
        drawn == series.x.size() && drawn > 1 ? Series::Style::lines_points : Series::Style::points;
    series.emphasis = method == "FAR (OBB)" || method == "FAR pairs";
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  }
  return panel;
}

// The front as a staircase from its fastest row to the slowest of the panel.
Series front_series(const SceneRows& scene) {
  Series out{.name = "Pareto front", .x = {}, .y = {}};
  out.style = Series::Style::lines;
  double last = 0;
  for (const Row* row : scene.rows) {
    if (time_of(*row, "total")) last = std::max(last, ms_of(*row));
  }
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

std::vector<Figure> figures_of(const std::vector<SceneRows>& scenes) {
  Figure error{.name = "error-time",
               .title = "Wrong answers against run time",
               .caption =
                   "Pairs that are missed plus pairs that are reported and do not collide, over "
                   "the median time from triangles to pairs. Lines follow the resolution. The "
                   "line below the powers is 0. The Pareto front joins what nothing beats in both.",
               .panels = {}};
  Figure kept{.name = "error-time-false-positives",
              .title = "Candidates that do not collide against run time",
              .caption =
                  "Candidates that are handed to exact tests and do not collide, over colliding "
                  "pairs. FCL's own test of triangles comes instead of exact tests, so what it "
                  "hands on is its answer.",
              .panels = {}};
  for (const SceneRows& scene : scenes) {
    error.panels.push_back(panel_of(scene, "missed + wrong pairs", error_of));
    error.panels.back().series.push_back(front_series(scene));
    kept.panels.push_back(panel_of(scene, "false positives / colliding", false_positives));
  }
  return {std::move(error), std::move(kept)};
}

DataTable front_table(const std::vector<SceneRows>& scenes) {
  DataTable out{.name = "error-time-front",
                .caption =
                    "The Pareto fronts: nothing is as fast with as few errors. Times are "
                    "ratios of medians, with the least and the most that single runs allow",
                .columns = {"scene", "method", "time over that of cgal-boxes", "missed", "wrong",
                            "colliding"},
                .alignment = "llrrrr",
                .rows = {}};
  for (const SceneRows& scene : scenes) {
    const Row* const peer = yardstick(scene);
    for (const Row* row : front_of(scene.rows)) {
      out.rows.push_back({scene.scene, in_words(*row),
                          peer != nullptr ? times_as_long(*row, *peer) : "-",
                          count_cell(*row, "missed"), grouped(number_of(*row, "wrong")),
                          count_cell(*row, "colliding")});
    }
  }
  return out;
}

DataTable all_table(const std::vector<SceneRows>& scenes) {
  DataTable out{.name = "error-time-all",
                .caption = "All points; times are medians with the fastest and slowest run",
                .columns = {"scene", "method", "resolution", "ms", "fastest", "slowest", "missed",
                            "wrong", "candidates", "colliding", "false positives"},
                .alignment = "llrrrrrrrrr",
                .rows = {},
                .in_text = false};
  for (const SceneRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      out.rows.push_back({scene.scene, contestant(row->point),
                          row->point.resolution > 0 ? std::to_string(row->point.resolution) : "-",
                          time_cell(*row, "total"), time_cell(*row, "total_min"),
                          time_cell(*row, "total_max"), count_cell(*row, "missed"),
                          grouped(number_of(*row, "wrong")), count_cell(*row, "candidates"),
                          count_cell(*row, "colliding"), rounded(false_positives(*row))});
    }
  }
  return out;
}

void add_front_finding(const SceneRows& scene, Chapter& chapter) {
  const std::vector<const Row*> front = front_of(scene.rows);
  if (front.empty()) return;
  std::vector<std::string> words;
  for (const Row* row : front) {
    words.push_back(fmt::format("{} ({} wrong)", in_words(*row),
                                grouped(static_cast<std::uint64_t>(error_of(*row)))));
  }
  chapter.findings.push_back(fmt::format("On the front of {}: {}.", scene.scene, listed(words)));
  // The fastest without an error, whoever that is, and the fastest other one behind it.
  const Row* best = nullptr;
  const Row* next = nullptr;
  for (const Row* row : scene.rows) {
    if (!time_of(*row, "total") || error_of(*row) > 0) continue;
    if (best == nullptr || ms_of(*row) < ms_of(*best)) best = row;
  }
  if (best == nullptr) {
    chapter.findings.push_back("No method is right on " + scene.scene + ".");
    return;
  }
  for (const Row* row : scene.rows) {
    if (!time_of(*row, "total") || error_of(*row) > 0) continue;
    if (contestant(row->point) == contestant(best->point)) continue;
    if (next == nullptr || ms_of(*row) < ms_of(*next)) next = row;
  }
  if (next == nullptr) return;
  chapter.findings.push_back(fmt::format(
      "The fastest right answer on {} is that of {}; the next method, {}, takes {} times as long.",
      scene.scene, in_words(*best), in_words(*next), times_as_long(*next, *best)));
}

// What FCL's own test of triangles gets wrong, by its precision.
void add_fcl_findings(const std::vector<SceneRows>& scenes, Chapter& chapter) {
  for (const char* name : {"fcl-float", "fcl-double"}) {
    std::uint64_t rows = 0, missed = 0, wrong = 0, colliding = 0;
    for (const SceneRows& scene : scenes) {
      for (const Row* row : scene.rows) {
        if (row->point.method != name) continue;
        ++rows;
        missed += number_of(*row, "missed");
        wrong += number_of(*row, "wrong");
        colliding += number_of(*row, "colliding");
      }
    }
    if (rows == 0) continue;
    chapter.findings.push_back(
        fmt::format("{} misses {} colliding pairs and reports {} that do not collide, in {} "
                    "scenes.",
                    method_label({.scene = {},
                                  .method = name,
                                  .offset = {},
                                  .radius = {},
                                  .depth_format = {},
                                  .depth_mode = {},
                                  .views = {}}),
                    of_all(missed, colliding), grouped(wrong), grouped(rows)));
  }
}

}  // namespace

Chapter error_time_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const std::vector<SceneRows> scenes = rows_by_scene(stored);
  add_promises(stored, out);
  for (const SceneRows& scene : scenes) add_front_finding(scene, out);
  add_fcl_findings(scenes, out);
  out.limits = {
      "Times are one machine's. On a software device those of methods that draw say nothing about "
      "graphics hardware, and the front is another there.",
      "Every method may use all cores; FCL's traversal of two objects has one thread.",
      "Embree and CGAL give candidates; they are right because exact tests follow, whose time is "
      "in theirs. What FCL takes includes its own test of triangles.",
      "Contexts, shaders and Embree's device are made before; hierarchies and boxes belong to the "
      "run.",
      "On a scene tested against itself libraries leave pairs that share a vertex out, ours count "
      "those that collide beyond it."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = figures_of(scenes);
  out.tables = {front_table(scenes), all_table(scenes)};
  return out;
}

}  // namespace farcull
