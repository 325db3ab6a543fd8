#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

constexpr const char* kBox = "FAR (OBB)";
constexpr const char* kExact = "FAR (exact)";
constexpr const char* kIntervals = "FAR pairs";

double or_gap(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

using Value = double (*)(const Row&);

struct Quantity {
  const char* name;  // of the figure
  const char* title;
  const char* label;
  Value value;
};

constexpr Quantity kQuantities[] = {
    {"offsets-kept", "Triangles that are left to exact tests", "kept triangles",
     [](const Row& row) { return or_gap(count_of(row, "kept_triangles")); }},
    {"offsets-false-positives", "Candidates that do not collide", "false positives / colliding",
     false_positives},
    {"offsets-fragments", "Fragments of one drawing of all triangles in every view", "fragments",
     [](const Row& row) { return or_gap(count_of(row, "fragments")); }},
    {"offsets-time", "Time from triangles to pairs", "time (ms)",
     [](const Row& row) { return or_gap(time_of(row, "total")); }},
};

Figure figure_of(const std::vector<SceneRows>& scenes, const Quantity& quantity) {
  Figure out{.name = quantity.name, .title = quantity.title, .caption = {}, .panels = {}};
  for (const SceneRows& scene : scenes) {
    Panel panel{.title = scene.scene,
                .x = {.label = "resolution (px)", .logarithmic = true},
                .y = {.label = quantity.label, .logarithmic = true, .shows_zero = true},
                .series = {}};
    for (const std::string& method : contestants_in(scene.rows)) {
      Series series{.name = method, .x = {}, .y = {}};
      for (const Row* row : scene.rows) {
        if (contestant(row->point) != method || row->point.resolution <= 0) continue;
        series.x.push_back(row->point.resolution);
        series.y.push_back(quantity.value(*row));
      }
      if (!series.x.empty()) panel.series.push_back(std::move(series));
    }
    out.panels.push_back(std::move(panel));
  }
  return out;
}

std::vector<Figure> figures_of(const std::vector<SceneRows>& scenes) {
  std::vector<Figure> out;
  for (const Quantity& quantity : kQuantities) out.push_back(figure_of(scenes, quantity));
  out[0].caption =
      "No method can keep fewer than collide. FAR keeps a set, whose triangles may each meet "
      "another one than they collide with; FAR pairs keeps those that are in a candidate pair.";
  out[1].caption = "Pairs handed to exact tests that do not collide, over pairs that do.";
  out[2].caption =
      "Of FAR: pixel centres in which the fattened triangle is stored or asked. Of FAR pairs: "
      "entries in the lists of pixels, one for each triangle and pixel that it may touch, in the "
      "views that it looked with.";
  out[3].caption =
      "The median of several runs, without contexts and shaders. FAR with exact "
      "offsets draws boxes first.";
  return out;
}

DataTable table_of(const std::vector<SceneRows>& scenes) {
  DataTable out{.name = "offsets",
                .caption = "Boxes, exact offsets and intervals",
                .columns = {"scene", "px", "method", "kept triangles", "candidates",
                            "false positives", "fragments", "ms"},
                .alignment = "lrlrrrrr",
                .rows = {}};
  for (const SceneRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      out.rows.push_back({scene.scene, std::to_string(row->point.resolution),
                          contestant(row->point), count_cell(*row, "kept_triangles"),
                          count_cell(*row, "candidates"), rounded(false_positives(*row)),
                          count_cell(*row, "fragments"), time_cell(*row, "total")});
    }
  }
  return out;
}

const Row* find(const SceneRows& scene, const std::string& method, int resolution) {
  for (const Row* row : scene.rows) {
    if (row->point.resolution == resolution && contestant(row->point) == method) return row;
  }
  return nullptr;
}

// Least, middle and most of value(a) / value(b) over the points that have both.
std::optional<std::string> ratios(const std::vector<SceneRows>& scenes, const char* a,
                                  const char* b, Value value) {
  std::vector<double> all;
  for (const SceneRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      if (contestant(row->point) != a) continue;
      const Row* other = find(scene, b, row->point.resolution);
      if (other == nullptr) continue;
      const double ratio = value(*row) / value(*other);
      if (ratio >= 0 && ratio <= std::numeric_limits<double>::max()) all.push_back(ratio);
    }
  }
  if (all.empty()) return {};
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  return fmt::format("{} times ({} to {})", rounded(median(all)), rounded(*least), rounded(*most));
}

void add_comparison(const std::vector<SceneRows>& scenes, const char* a, const char* b,
                    Chapter& chapter) {
  const auto kept = ratios(scenes, a, b, kQuantities[0].value);
  const auto candidates =
      ratios(scenes, a, b, [](const Row& row) { return or_gap(count_of(row, "candidates")); });
  const auto fragments = ratios(scenes, a, b, kQuantities[2].value);
  const auto time = ratios(scenes, a, b, kQuantities[3].value);
  if (!kept || !candidates || !fragments || !time) return;
  chapter.findings.push_back(
      fmt::format("{} against {}, median (least to most) over scenes and resolutions: {} the kept "
                  "triangles, {} the candidates, {} the fragments, {} the time.",
                  a, b, *kept, *candidates, *fragments, *time));
}

// A smaller solid inside the other one may never keep more.
void add_order_finding(const std::vector<SceneRows>& scenes, Chapter& chapter) {
  std::uint64_t points = 0, more = 0, fewer = 0;
  for (const SceneRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      if (contestant(row->point) != kExact) continue;
      const Row* box = find(scene, kBox, row->point.resolution);
      if (box == nullptr) continue;
      ++points;
      const std::uint64_t ours = number_of(*row, "kept_triangles"),
                          theirs = number_of(*box, "kept_triangles");
      fewer += ours < theirs;
      if (ours <= theirs) continue;
      ++more;
      chapter.findings.push_back(fmt::format(
          "BROKEN: {} keeps {} triangles where boxes keep {}, and starts from what these leave.",
          describe(row->point), grouped(ours), grouped(theirs)));
    }
  }
  if (points > 0 && more == 0) {
    chapter.findings.push_back(
        fmt::format("Exact offsets keep fewer triangles than boxes at {} points, and more at none.",
                    of_all(fewer, points)));
  }
}

}  // namespace

Chapter offsets_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const std::vector<SceneRows> scenes = rows_by_scene(stored);
  add_promises(stored, out);
  add_order_finding(scenes, out);
  put_broken_first(out);
  add_comparison(scenes, kExact, kBox, out);
  add_comparison(scenes, kIntervals, kBox, out);
  out.limits = {
      "Fragments of FAR are those of one drawing; a run draws what is left several times.",
      "FAR pairs compares pairs and chooses its directions, FAR culls sets along x, y and z: what "
      "differs is not the bound alone.",
      "FAR with exact offsets draws boxes first and exact offsets on what these leave; where boxes "
      "leave few triangles it draws no exact offset.",
      "On a software device times say nothing about graphics hardware; counts carry over."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = figures_of(scenes);
  out.tables = {table_of(scenes)};
  return out;
}

}  // namespace farcull
