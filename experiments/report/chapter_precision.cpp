// The chapter of the study "precision".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "core/canvas.h"
#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/studies/lemma_point.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool fixed(const Row& row) { return row.point.depth_mode == "fixed"; }

std::string mode_of(const Row& row) { return fixed(row) ? "fixed-function" : "fragment"; }
std::string bits_of(const Row& row) {
  return row.point.depth_format == "fixed24" ? "24 bits" : "32-bit float";
}
std::string radius_of(const Row& row) { return row.point.radius + " radius"; }

struct Sum {
  std::uint64_t points = 0, no_sample = 0, not_bounding = 0, rounded = 0;
  double steps = 0, px = 0, step_px = 0;  // the largest; infinite where a row's is not a number
  std::string worst;                      // the generator with the most steps
};
void add(const Row& row, Sum& sum) {
  sum.points += number_of(row, "points");
  sum.no_sample += number_of(row, "no_sample");
  sum.not_bounding += number_of(row, "not_bounding");
  sum.rounded += number_of(row, "rounded");
  const double steps = count_of(row, "largest_steps").value_or(HUGE_VAL);
  if (steps > sum.steps) {
    sum.steps = steps;
    sum.worst = parse_lemma_scene(row.point.scene).generator;
  }
  sum.px = std::max(sum.px, count_of(row, "largest_px").value_or(HUGE_VAL));
  sum.step_px = count_of(row, "step_px").value_or(kNaN);
}

// Over the generators: mode and radius, bits, side, depth.
using Key = std::tuple<std::string, std::string, int, double>;
using Cells = std::map<Key, Sum>;

std::string line_of(const Row& row) { return mode_of(row) + ", " + radius_of(row); }

// Where only pixels without a sample are violated there is no distance, and no point of a line: the
// line of zeros would say that all is well.
double drawn(const Sum& sum) { return sum.steps == 0 && sum.no_sample > 0 ? kNaN : sum.steps; }

// What the lines cannot show.
std::string not_drawn(const Cells& cells) {
  struct Part {
    std::uint64_t no_sample = 0, points = 0;
    std::set<double> depths, gaps, endless;
  };
  std::map<std::string, Part> parts;  // line and bits
  for (const auto& [key, sum] : cells) {
    const auto& [line, bits, side, depth] = key;
    Part& part = parts[line + ", " + bits];
    part.points += sum.points;
    part.no_sample += sum.no_sample;
    if (sum.no_sample > 0) part.depths.insert(depth);
    if (std::isnan(drawn(sum))) part.gaps.insert(depth);
    if (std::isinf(sum.steps)) part.endless.insert(depth);
  }
  const auto at = [](const std::set<double>& depths) {
    std::vector<std::string> words;
    for (const double depth : depths) words.push_back(rounded(depth));
    return listed(words) + " px";
  };
  std::vector<std::string> samples, endless;
  bool gaps = false;
  for (const auto& [name, part] : parts) {
    gaps = gaps || !part.gaps.empty();
    if (part.no_sample > 0) {
      samples.push_back(fmt::format("{} {} (depth {})", name, of_all(part.no_sample, part.points),
                                    at(part.depths)));
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
  Figure out{.name = "precision",
             .title = "How far depth buffers are outside the bounds they should give",
             .caption =
                 "The largest violation over all generators. On the line below the powers "
                 "no sample is outside; below the mark a monotone rounding explains it, which "
                 "the theorem allows." +
                 not_drawn(cells),
             .panels = {}};
  std::map<std::pair<std::string, int>, std::map<std::string, Series>> panels;
  for (const auto& [key, sum] : cells) {
    const auto& [line, bits, side, depth] = key;
    Series& series = panels[{bits, side}][line];
    series.name = line;
    series.emphasis = line == "fragment, budget radius";
    series.x.push_back(depth);
    series.y.push_back(drawn(sum));
  }
  for (auto& [key, lines] : panels) {
    Panel panel{.title = fmt::format("{}, {} px", key.first, key.second),
                .x = {.label = "depth of the scene (px)", .logarithmic = true},
                .y = {.label = "outside (depth steps)", .logarithmic = true, .shows_zero = true},
                .series = {},
                .marks = {{.vertical = false,
                           .at = depth_rounding(key.first == "24 bits" ? 24 : 32),
                           .name = "rounding of the map"}}};
    for (auto& [name, series] : lines) panel.series.push_back(std::move(series));
    out.panels.push_back(std::move(panel));
  }
  return out;
}

// Of all generators, sides and depths together.
DataTable short_table(const std::vector<const Row*>& rows) {
  std::map<std::pair<std::string, std::string>, Sum> sums;
  for (const Row* row : rows) add(*row, sums[{line_of(*row), bits_of(*row)}]);
  DataTable out{.name = "precision",
                .caption =
                    "Points over all generators, sides and depths: without a sample, not bounded, "
                    "and outside by no more than rounding; how far outside at most",
                .columns = {"depth by", "buffer", "points", "no sample", "not bounded", "rounded",
                            "most (steps)", "most (px)"},
                .alignment = "llrrrrrr",
                .rows = {}};
  for (const auto& [key, sum] : sums) {
    out.rows.push_back({key.first, key.second, grouped(sum.points), grouped(sum.no_sample),
                        grouped(sum.not_bounding), grouped(sum.rounded), rounded(sum.steps),
                        rounded(sum.px)});
  }
  return out;
}

DataTable table_of(const Cells& cells) {
  DataTable out{.name = "precision-depths",
                .caption =
                    "Points over all generators, at every side and depth: without a sample, not "
                    "bounded, and outside by no more than rounding",
                .columns = {"depth by", "buffer", "side (px)", "depth (px)", "step (px)", "points",
                            "no sample", "not bounded", "rounded", "most (steps)", "most (px)"},
                .alignment = "llrrrrrrrrr",
                .rows = {},
                .in_text = false};
  for (const auto& [key, sum] : cells) {
    const auto& [line, bits, side, depth] = key;
    out.rows.push_back({line, bits, grouped(static_cast<std::uint64_t>(side)),
                        grouped(static_cast<std::uint64_t>(depth)), rounded(sum.step_px),
                        grouped(sum.points), grouped(sum.no_sample), grouped(sum.not_bounding),
                        grouped(sum.rounded), rounded(sum.steps), rounded(sum.px)});
  }
  return out;
}

DataTable all_of(const std::vector<const Row*>& rows) {
  DataTable out{.name = "precision-all",
                .caption = "All points",
                .columns = {"generator", "depth (px)", "depth by", "buffer", "side (px)", "points",
                            "no sample", "not bounded", "rounded", "most (steps)", "most (px)"},
                .alignment = "lrllrrrrrrr",
                .rows = {},
                .in_text = false};
  for (const Row* row : rows) {
    const LemmaScene scene = parse_lemma_scene(row->point.scene);
    out.rows.push_back({scene.generator, grouped(static_cast<std::uint64_t>(scene.depth)),
                        line_of(*row), bits_of(*row), std::to_string(row->point.resolution),
                        count_cell(*row, "points"), count_cell(*row, "no_sample"),
                        count_cell(*row, "not_bounding"), count_cell(*row, "rounded"),
                        rounded(count_of(*row, "largest_steps").value_or(kNaN)),
                        rounded(count_of(*row, "largest_px").value_or(kNaN))});
  }
  return out;
}

void add_findings(const std::vector<const Row*>& rows, Chapter& chapter) {
  std::map<std::pair<std::string, std::string>, Sum> sums;  // mode and radius, bits
  bool broken = false;
  for (const Row* row : rows) {
    add(*row, sums[{line_of(*row), bits_of(*row)}]);
    const std::uint64_t violations = number_of(*row, "no_sample") + number_of(*row, "not_bounding");
    if (fixed(*row) || row->point.radius != "budget" || violations == 0) continue;
    broken = true;
    if (breaks(*row)) continue;  // said already
    const LemmaScene scene = parse_lemma_scene(row->point.scene);
    chapter.findings.push_back(fmt::format(
        "BROKEN: fragment depth at the budget radius, {}, {} px, scene {} px deep: {} points of "
        "the generator \"{}\" have no sample or are not bounded, by up to {} steps.",
        bits_of(*row), row->point.resolution, scene.depth,
        of_all(violations, number_of(*row, "points")), scene.generator,
        rounded(count_of(*row, "largest_steps").value_or(kNaN))));
  }
  for (const auto& [key, sum] : sums) {
    const auto& [line, bits] = key;
    if (broken && line == "fragment, budget radius") continue;
    std::string text = fmt::format("{}, {}: ", line, bits);
    if (sum.no_sample + sum.not_bounding == 0) {
      text += fmt::format("all {} points have samples that bound them", grouped(sum.points));
      text += sum.rounded == 0 ? ", none even by rounding outside."
                               : fmt::format(", {} of them after rounding of up to {} steps.",
                                             grouped(sum.rounded), rounded(sum.steps));
    } else {
      text += fmt::format("{} points have no sample, {} are not bounded",
                          of_all(sum.no_sample, sum.points), grouped(sum.not_bounding));
      text += sum.not_bounding > 0 ? fmt::format(", the worst by {} steps, {} px ({}).",
                                                 rounded(sum.steps), rounded(sum.px), sum.worst)
                                   : ".";
    }
    chapter.findings.push_back(text);
  }
}

}  // namespace

Chapter precision_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  std::vector<const Row*> rows;
  Cells cells;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty()) continue;
    rows.push_back(&row);
    const double depth = parse_lemma_scene(row.point.scene).depth;
    add(row, cells[{line_of(row), bits_of(row), row.point.resolution, depth}]);
  }
  add_promises(stored, out);
  add_findings(rows, out);
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
  out.tables = {short_table(rows), table_of(cells), all_of(rows)};
  return out;
}

}  // namespace farcull
