// The chapter of the study "precision": how far the depths that a buffer holds are outside the
// bounds that they should keep, over the generators of the lemma experiment.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/canvas/canvas.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/studies/run_point.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// How the depth of a row comes about: "fragment, budget radius".
std::string line_of(const Row& row) {
  return std::string(row.point.depth_mode == DepthMode::fixed ? "fixed-function" : "fragment") +
         ", " + column_text(row.point.radius) + " radius";
}
std::string bits_of(const Row& row) {
  return row.point.depth_format == DepthFormat::fixed24 ? "24 bits" : "32-bit float";
}

// The largest distance in depth steps; infinite where that of a row is not a number.
double steps_of(const Rows& rows) { return largest(rows, "largest_steps", HUGE_VAL); }
double px_of(const Rows& rows) { return largest(rows, "largest_px", HUGE_VAL); }

// Rows of all generators with the same line, bits, side of the window and depth of the scene.
using Cells = std::map<std::tuple<std::string, std::string, int, double>, Rows>;

// Where only pixels without a sample are violated there is no distance, and no point of a line: the
// line of zeros would say that all is well.
double drawn(const Rows& rows) {
  const double steps = steps_of(rows);
  return steps == 0 && total(rows, "no_sample") > 0 ? kNone : steps;
}

// Sentences of the caption about violations that no line shows.
std::string not_drawn(const Cells& cells) {
  struct Part {
    Rows rows;
    std::set<double> depths, endless;
  };
  std::map<std::string, Part> parts;  // line and bits
  bool gaps = false;
  for (const auto& [key, rows] : cells) {
    const auto& [line, bits, side, depth] = key;
    Part& part = parts[line + ", " + bits];
    part.rows.insert(part.rows.end(), rows.begin(), rows.end());
    if (total(rows, "no_sample") > 0) part.depths.insert(depth);
    if (std::isinf(steps_of(rows))) part.endless.insert(depth);
    gaps = gaps || std::isnan(drawn(rows));
  }
  const auto at = [](const std::set<double>& depths) {
    std::vector<std::string> words;
    for (const double depth : depths) words.push_back(rounded(depth));
    return listed(words) + " px";
  };
  std::vector<std::string> samples, endless;
  for (const auto& [name, part] : parts) {
    if (!part.depths.empty()) {
      samples.push_back(fmt::format("{} {} (depth {})", name,
                                    of_all(part.rows, "no_sample", "points"), at(part.depths)));
    }
    if (!part.endless.empty())
      endless.push_back(fmt::format("{} (depth {})", name, at(part.endless)));
  }
  std::string out;
  if (!samples.empty()) {
    out += " Points whose pixel has no sample have no distance and are in no line: " +
           listed(samples) + ".";
    if (gaps) out += " Where there are no others the line has a gap.";
  }
  if (!endless.empty())
    out += " Farther outside than a number says, and in no line: " + listed(endless) + ".";
  return out;
}

Figure figure_of(const Cells& cells) {
  std::uint64_t points = 0;
  for (const auto& [key, rows] : cells) points += total(rows, "points");
  Figure out{
      .name = "precision",
      .title = "How far depth buffers are outside the bounds they should give",
      .caption = fmt::format("The largest violation over all generators, n = {} points of "
                             "triangles. At 0 no sample is outside. Up to the mark a monotone "
                             "rounding explains it, which the theorem allows.",
                             grouped(points)) +
                 not_drawn(cells)};
  std::map<std::pair<std::string, int>, std::map<std::string, Series>> panels;
  for (const auto& [key, rows] : cells) {
    const auto& [line, bits, side, depth] = key;
    Series& series = panels[{bits, side}][line];
    series.name = line;
    series.emphasis = line == "fragment, budget radius";
    series.x.push_back(depth);
    series.y.push_back(drawn(rows));
  }
  for (auto& [key, lines] : panels) {
    Panel panel{.title = fmt::format("{}, {} px", key.first, key.second),
                .x = logarithmic("depth of the scene (px)"),
                .y = logarithmic("outside (depth steps)", true),
                .marks = {{.vertical = false,
                           .at = depth_rounding(key.first == "24 bits" ? 24 : 32),
                           .name = "rounding of the map"}}};
    for (auto& [name, series] : lines) panel.series.push_back(std::move(series));
    out.panels.push_back(std::move(panel));
  }
  return out;
}

// Adds the cells that all tables end with.
void add_sums(const Rows& rows, std::vector<std::string>& cells) {
  for (const char* count : {"points", "no_sample", "not_bounding", "rounded"})
    cells.push_back(grouped(total(rows, count)));
  cells.push_back(rounded(steps_of(rows)));
  cells.push_back(rounded(px_of(rows)));
}

using RowsOfLine = std::map<std::pair<std::string, std::string>, Rows>;  // line and bits

// Of all generators, sides and depths together.
DataTable short_table(const RowsOfLine& lines) {
  DataTable out{
      .name = "precision",
      .caption =
          "Points over all generators, sides and depths: without a sample, not bounded, "
          "and outside by no more than rounding; how far outside at most",
      .columns = columns({"depth by", "buffer"}, {"points", "no sample", "not bounded", "rounded",
                                                  "most (steps)", "most (px)"})};
  for (const auto& [key, rows] : lines) {
    out.rows.push_back({key.first, key.second});
    add_sums(rows, out.rows.back());
  }
  return out;
}

DataTable table_of(const Cells& cells) {
  DataTable out{.name = "precision-depths",
                .caption =
                    "Points over all generators, at every side and depth: without a sample, not "
                    "bounded, and outside by no more than rounding",
                .columns = columns({"depth by", "buffer"},
                                   {"side (px)", "depth (px)", "step (px)", "points", "no sample",
                                    "not bounded", "rounded", "most (steps)", "most (px)"}),
                .in_text = false};
  for (const auto& [key, rows] : cells) {
    const auto& [line, bits, side, depth] = key;
    out.rows.push_back({line, bits, grouped(static_cast<std::uint64_t>(side)),
                        grouped(static_cast<std::uint64_t>(depth)),
                        rounded(count_or_none(*rows.back(), "step_px"))});
    add_sums(rows, out.rows.back());
  }
  return out;
}

DataTable all_of(const Rows& rows) {
  const RowColumn generator = {text_column("generator"), [](const Row& row) {
                                 return parse_lemma_scene(row.point.scene).generator;
                               }};
  const RowColumn depth = {
      {"depth (px)"}, [](const Row& row) {
        return grouped(static_cast<std::uint64_t>(parse_lemma_scene(row.point.scene).depth));
      }};
  const RowColumn side = {{"side (px)"},
                          [](const Row& row) { return std::to_string(row.point.resolution); }};
  return table_of_rows("precision-all", "All points", rows,
                       {generator,
                        depth,
                        {text_column("depth by"), line_of},
                        {text_column("buffer"), bits_of},
                        side,
                        count_column("points", "points"),
                        count_column("no sample", "no_sample"),
                        count_column("not bounded", "not_bounding"),
                        count_column("rounded", "rounded"),
                        rounded_column("most (steps)", "largest_steps"),
                        rounded_column("most (px)", "largest_px")});
}

// The generator of the row with the most steps.
std::string worst_of(const Rows& rows) {
  const Row* const worst = *std::max_element(
      rows.begin(), rows.end(), [](auto* a, auto* b) { return steps_of({a}) < steps_of({b}); });
  return parse_lemma_scene(worst->point.scene).generator;
}

// Adds each violation of fragment depth at the budget radius. Returns whether there is one.
bool add_violations(const Rows& rows, Chapter& chapter) {
  bool broken = false;
  for (const Row* row : rows) {
    const std::uint64_t violations = number_of(*row, "no_sample") + number_of(*row, "not_bounding");
    if (line_of(*row) != "fragment, budget radius" || violations == 0) continue;
    broken = true;
    if (breaks(*row)) continue;  // said already
    const LemmaScene scene = parse_lemma_scene(row->point.scene);
    chapter.find_broken(fmt::format(
        "fragment depth at the budget radius, {}, {} px, scene {} px deep: {} points of the "
        "generator \"{}\" have no sample or are not bounded, by up to {} steps.",
        bits_of(*row), row->point.resolution, scene.depth,
        of_all(violations, number_of(*row, "points")), scene.generator,
        rounded(count_or_none(*row, "largest_steps"))));
  }
  return broken;
}

void add_findings(const Rows& all, const RowsOfLine& lines, Chapter& chapter) {
  const bool broken = add_violations(all, chapter);
  for (const auto& [key, rows] : lines) {
    const auto& [line, bits] = key;
    if (broken && line == "fragment, budget radius") continue;
    const std::uint64_t no_sample = total(rows, "no_sample"), points = total(rows, "points"),
                        not_bounding = total(rows, "not_bounding");
    std::string text = fmt::format("{}, {}: ", line, bits);
    if (no_sample + not_bounding == 0) {
      const std::uint64_t after_rounding = total(rows, "rounded");
      text += fmt::format("all {} points have samples that bound them", grouped(points));
      text += after_rounding == 0 ? ", none even by rounding outside."
                                  : fmt::format(", {} of them after rounding of up to {} steps.",
                                                grouped(after_rounding), rounded(steps_of(rows)));
    } else {
      text += fmt::format("{} points have no sample, {} are not bounded", of_all(no_sample, points),
                          grouped(not_bounding));
      text += not_bounding > 0
                  ? fmt::format(", the worst by {} steps, {} px ({}).", rounded(steps_of(rows)),
                                rounded(px_of(rows)), worst_of(rows))
                  : ".";
    }
    chapter.find(text);
  }
}

}  // namespace

Chapter precision_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows rows = measured(stored);
  const Cells cells = rows_by(rows, [](const Row& row) {
    return std::tuple(line_of(row), bits_of(row), row.point.resolution,
                      parse_lemma_scene(row.point.scene).depth);
  });
  const RowsOfLine lines =
      rows_by(rows, [](const Row& row) { return std::pair(line_of(row), bits_of(row)); });
  add_promises(stored, out);
  add_findings(rows, lines, out);
  put_broken_first(out);
  out.limits = {
      "A violation is decided on what the buffer holds against the exact depth of the point under "
      "the exact depth map. What a monotone rounding explains is counted apart, because asked and "
      "stored depths are rounded alike.",
      "Fixed-function depth promises nothing: that its surface bounds every point here at the "
      "budget radius is this device's interpolation, for which GL gives no bound.",
      "The published radius grows with the depth step, so in deep scenes it is larger than the "
      "budget's."};
  add_gaps(stored, out);
  if (rows.empty()) return out;
  out.figures = {figure_of(cells)};
  out.tables = {short_table(lines), table_of(cells), all_of(rows)};
  return out;
}

}  // namespace farcull
