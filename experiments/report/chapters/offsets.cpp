// The chapter of the study "offsets": boxes, exact offsets and intervals beside each other.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr const char* kBox = "FAR (OBB)";
constexpr const char* kExact = "FAR (exact)";
constexpr const char* kIntervals = "FAR pairs";

struct Quantity {
  const char* name;  // of the figure
  const char* title;
  const char* label;
  double (*value)(const Row&);
};

double ms_of(const Row& row) {
  const std::optional<Estimate> ms = time_estimate(row);
  return ms ? ms->value : kNone;
}

constexpr Quantity kQuantities[] = {
    {"offsets-kept", "Triangles that are left to exact tests", "kept triangles",
     [](const Row& row) { return count_or_none(row, "kept_triangles"); }},
    {"offsets-false-positives", "Candidates that do not collide", "false positives / colliding",
     false_positives},
    {"offsets-fragments", "Fragments of one drawing of all triangles in every view", "fragments",
     [](const Row& row) { return count_or_none(row, "fragments"); }},
    {"offsets-time", "Time from triangles to pairs", "time (ms)", ms_of},
};

Figure figure_of(const std::vector<NamedRows>& scenes, const Quantity& quantity) {
  Figure out{.name = quantity.name, .title = quantity.title};
  for (const NamedRows& scene : scenes) {
    Panel panel{.title = scene.name,
                .x = logarithmic("resolution (px)"),
                .y = logarithmic(quantity.label, true)};
    for (NamedRows method : rows_by_contestant(scene.rows)) {
      std::erase_if(method.rows, [](const Row* row) { return row->point.resolution <= 0; });
      if (method.rows.empty()) continue;
      const Value x = [](const Row& row) { return row.point.resolution; };
      panel.series.push_back(quantity.value == ms_of
                                 ? times_of(method.name, method.rows, x)
                                 : series_of(method.name, method.rows, x, quantity.value));
    }
    out.panels.push_back(std::move(panel));
  }
  return out;
}

std::vector<Figure> figures_of(const std::vector<NamedRows>& scenes, const Rows& rows) {
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
      "Medians of the runs with their 95 % intervals as bars, without contexts and shaders. FAR "
      "with exact offsets draws boxes first.";
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].caption += i == 3 ? fmt::format(" {}.", sample_text(rows))
                             : fmt::format(" n = {}.", counted(rows.size(), "point", "points"));
  }
  return out;
}

DataTable table_of(const Rows& rows) {
  const RowColumn pixels = {{"resolution (px)"},
                            [](const Row& row) { return std::to_string(row.point.resolution); }};
  const RowColumn false_ones = {{"false positives"},
                                [](const Row& row) { return rounded(false_positives(row)); }};
  DataTable out = table_of_rows(
      "offsets",
      "Boxes, exact offsets and intervals; times are medians of the runs with their 95 % "
      "intervals. " +
          sample_text(rows),
      rows,
      {scene_column(), pixels, contestant_column(),
       count_column("kept triangles", "kept_triangles"), count_column("candidates", "candidates"),
       false_ones, count_column("fragments", "fragments"), estimate_column("time (ms)")});
  out.in_text = true;
  return out;
}

// The median of value(a) / value(b) over the points that have both, with its 95 % interval.
std::optional<std::string> ratios(const std::vector<NamedRows>& scenes, const char* a,
                                  const char* b, const Value& value) {
  std::vector<double> all;
  for (const NamedRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      if (contestant(row->point) != a) continue;
      const Row* other = find_row(scene.rows, b, row->point.resolution);
      if (other == nullptr) continue;
      const double ratio = value(*row) / value(*other);
      if (ratio >= 0 && ratio <= std::numeric_limits<double>::max()) all.push_back(ratio);
    }
  }
  if (all.empty()) return {};
  const Estimate median = median_estimate(all);
  return fmt::format("{} times ({} to {}, n = {})", rounded(median.value), rounded(median.low),
                     rounded(median.high), median.n);
}

void add_comparison(const std::vector<NamedRows>& scenes, const char* a, const char* b,
                    Chapter& chapter) {
  const auto kept = ratios(scenes, a, b, kQuantities[0].value);
  const auto candidates =
      ratios(scenes, a, b, [](const Row& row) { return count_or_none(row, "candidates"); });
  const auto fragments = ratios(scenes, a, b, kQuantities[2].value);
  const auto time = ratios(scenes, a, b, kQuantities[3].value);
  if (!kept || !candidates || !fragments || !time) return;
  chapter.find(fmt::format(
      "{} against {}, median over scenes and resolutions with its 95 % interval: {} the kept "
      "triangles, {} the candidates, {} the fragments, {} the time.",
      a, b, *kept, *candidates, *fragments, *time));
}

// A smaller solid inside the other one may never keep more.
void add_order_finding(const std::vector<NamedRows>& scenes, Chapter& chapter) {
  std::uint64_t points = 0, more = 0, fewer = 0;
  for (const NamedRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      if (contestant(row->point) != kExact) continue;
      const Row* box = find_row(scene.rows, kBox, row->point.resolution);
      if (box == nullptr) continue;
      ++points;
      const std::uint64_t ours = number_of(*row, "kept_triangles"),
                          theirs = number_of(*box, "kept_triangles");
      fewer += ours < theirs;
      if (ours <= theirs) continue;
      ++more;
      chapter.find_broken(fmt::format(
          "{} keeps {} triangles where boxes keep {}, and starts from what these leave.",
          describe(row->point), grouped(ours), grouped(theirs)));
    }
  }
  if (points > 0 && more == 0) {
    chapter.find(
        fmt::format("Exact offsets keep fewer triangles than boxes at {} points, and more at none.",
                    of_all(fewer, points)));
  }
}

}  // namespace

Chapter offsets_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const std::vector<NamedRows> scenes = rows_by_scene(stored);
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
  out.figures = figures_of(scenes, measured(stored));
  out.tables = {table_of(measured(stored))};
  return out;
}

}  // namespace farcull
