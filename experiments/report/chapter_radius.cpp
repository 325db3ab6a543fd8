// The chapter of the study "radius".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/studies/lemma_point.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool is_published(const Row& row) { return row.point.radius == "published"; }

// The factor on the budget radius; of the published one its part of it, where the row tells.
double factor_of(const Row& row) {
  if (is_published(row)) {
    const auto radius = count_of(row, "radius_px"), budget = count_of(row, "budget_px");
    return radius && budget ? *radius / *budget : kNaN;
  }
  return row.point.radius == "budget" || row.point.radius.empty() ? 1 : std::stod(row.point.radius);
}

// Where a lemma was looked at.
std::string surface_of(const Row& row) {
  if (row.point.method == "lemma-worst") return "worst canvas";
  return row.point.depth_mode == "fixed" ? "fixed-function depth" : "fragment depth";
}

std::string generator_of(const Row& row) { return parse_lemma_scene(row.point.scene).generator; }

struct Sum {
  std::uint64_t points = 0, violations = 0, no_sample = 0;
  double largest_px = 0;
};
void add(const Row& row, Sum& sum) {
  sum.points += number_of(row, "points");
  sum.violations += number_of(row, "violations");
  sum.no_sample += number_of(row, "no_sample");
  sum.largest_px = std::max(sum.largest_px, count_of(row, "largest_px").value_or(HUGE_VAL));
}
double rate(const Sum& sum) {
  return sum.points == 0
             ? kNaN
             : 100.0 * static_cast<double>(sum.violations) / static_cast<double>(sum.points);
}

// A line: by factor, and the published radius apart.
struct Line {
  std::map<double, Sum> at;
  Sum published;
  double published_factor = kNaN;
};
void add(const Row& row, Line& line) {
  if (is_published(row)) {
    add(row, line.published);
    line.published_factor = factor_of(row);
  } else {
    add(row, line.at[factor_of(row)]);
  }
}

using Lines = std::map<std::string, std::map<std::string, Line>>;  // surface, generator or "all"

constexpr const char* kAll = "all generators";

Lines lines_of(const std::vector<const Row*>& rows) {
  Lines out;
  for (const Row* row : rows) {
    add(*row, out[surface_of(*row)][generator_of(*row)]);
    add(*row, out[surface_of(*row)][kAll]);
  }
  return out;
}

Series series_of(const std::string& name, const Line& line) {
  Series out;
  out.name = name;
  out.style = Series::Style::lines;
  for (const auto& [factor, sum] : line.at) {
    out.x.push_back(factor);
    out.y.push_back(rate(sum));
  }
  return out;
}

// A share in per cent against the factor.
Panel panel_of(const std::string& title, const std::string& share) {
  Panel out;
  out.title = title;
  out.x.label = "radius / budget radius";
  out.x.from = 0;
  out.x.to = 1.1;
  out.y.label = share;
  out.y.logarithmic = true;
  out.y.shows_zero = true;
  out.y.to = 100;
  out.marks.push_back({.vertical = true, .at = 1, .name = "budget radius"});
  return out;
}

Series points_of(const std::string& name) {
  Series out;
  out.name = name;
  out.style = Series::Style::points;
  return out;
}

// From here to as much beyond 1 the second row of panels looks.
constexpr double kClose = 0.96;

Figure lemma_figure(const Lines& lines) {
  Figure out{.name = "radius",
             .title = "Points whose pixel lacks a sample or a bound, against the radius",
             .caption = {},
             .panels = {}};
  std::uint64_t points = 0;
  for (const auto& [surface, generators] : lines) {
    Panel panel = panel_of(surface, "violated points (%)");
    Series published = points_of("published radius, each generator");
    for (const auto& [generator, line] : generators) {
      if (generator == kAll) {
        for (const auto& [factor, sum] : line.at) points += sum.points;
        points += line.published.points;
        continue;
      }
      panel.series.push_back(series_of(generator, line));
      if (line.published.points > 0) {
        published.x.push_back(line.published_factor);
        published.y.push_back(rate(line.published));
      }
    }
    Series all = series_of(kAll, generators.at(kAll));
    all.emphasis = true;
    panel.series.push_back(std::move(all));
    if (!published.x.empty()) panel.series.push_back(std::move(published));
    out.panels.push_back(std::move(panel));
  }
  // Where the published radius stands, once more.
  const std::size_t surfaces = out.panels.size();
  for (std::size_t i = 0; i < surfaces; ++i) {
    Panel close = out.panels[i];
    close.title = "the same, close to 1";
    close.x.from = kClose;
    close.x.to = 2 - kClose;
    out.panels.push_back(std::move(close));
  }
  out.caption = fmt::format(
      "Lemmas 1 and 2 at {} points of triangles that aim at trouble. The line below the powers is "
      "0. On the worst canvas a pixel has a fragment only where every device that keeps the "
      "assumptions gives it one.",
      grouped(points));
  return out;
}

struct Misses {
  std::map<double, const Row*> at;
  const Row* published = nullptr;
};
using MissLines = std::map<std::string, std::map<std::string, Misses>>;  // depth, scene

MissLines misses_of(const std::vector<const Row*>& rows) {
  MissLines out;
  for (const Row* row : rows) {
    Misses& line = out[surface_of(*row)][row->point.scene];
    if (is_published(*row)) {
      line.published = row;
    } else {
      line.at[factor_of(*row)] = row;
    }
  }
  return out;
}

double miss_rate(const Row& row) {
  const auto colliding = static_cast<double>(number_of(row, "colliding"));
  return colliding == 0 ? kNaN : 100 * static_cast<double>(number_of(row, "missed")) / colliding;
}

// The published radius as a part of the budget, as FAR's rows at both tell it.
double published_factor(const Misses& line) {
  const auto budget = line.at.find(1);
  if (line.published == nullptr || budget == line.at.end()) return kNaN;
  const auto one = count_of(*line.published, "radius_px"),
             other = count_of(*budget->second, "radius_px");
  return one && other && *other > 0 ? *one / *other : kNaN;
}

Figure miss_figure(const MissLines& depths) {
  Figure out{.name = "radius-missed",
             .title = "Missed pairs against the radius",
             .caption = {},
             .panels = {}};
  std::vector<std::string> scenes;
  for (const auto& [depth, lines] : depths) {
    Panel panel = panel_of(depth, "missed pairs (%)");
    Series published = points_of("published radius, each scene");
    for (const auto& [scene, line] : lines) {
      Series series;
      series.name = scene;
      for (const auto& [factor, row] : line.at) {
        series.x.push_back(factor);
        series.y.push_back(miss_rate(*row));
      }
      panel.series.push_back(std::move(series));
      if (line.published != nullptr) {
        published.x.push_back(published_factor(line));
        published.y.push_back(miss_rate(*line.published));
      }
      const std::string words = fmt::format(
          "{} in {}",
          grouped(number_of(line.published != nullptr ? *line.published : *line.at.begin()->second,
                            "colliding")),
          scene);
      if (std::find(scenes.begin(), scenes.end(), words) == scenes.end()) scenes.push_back(words);
    }
    if (!published.x.empty()) panel.series.push_back(std::move(published));
    out.panels.push_back(std::move(panel));
  }
  out.caption = fmt::format(
      "FAR with oriented boxes: colliding pairs that culling loses, of {}. The line below the "
      "powers is 0.",
      listed(scenes));
  return out;
}

// The least factor from which on no row of the line is violated.
std::string least_safe(const Line& line) {
  std::string out = "-";
  for (auto it = line.at.rbegin(); it != line.at.rend() && it->second.violations == 0; ++it)
    out = fmt::format("{:.4g}", it->first);
  return out;
}

// Of all generators together, or of each.
DataTable lemma_table(const Lines& lines, bool each) {
  DataTable out{.name = each ? "radius-generators" : "radius",
                .caption =
                    "Violated points at the published and at the budget radius, and the "
                    "least factor on the budget from which on none is",
                .columns = {"depth", "generator", "points", "published", "budget", "least factor",
                            "published: farthest outside (px)"},
                .alignment = "llrrrrr",
                .rows = {},
                .in_text = !each};
  if (each) out.caption += ", of every generator";
  for (const auto& [surface, generators] : lines) {
    for (const auto& [generator, line] : generators) {
      if ((generator == kAll) == each) continue;
      const auto budget = line.at.find(1);
      out.rows.push_back(
          {surface, generator, budget == line.at.end() ? "-" : grouped(budget->second.points),
           line.published.points == 0 ? "-" : grouped(line.published.violations),
           budget == line.at.end() ? "-" : grouped(budget->second.violations), least_safe(line),
           line.published.points == 0 ? "-" : rounded(line.published.largest_px)});
    }
  }
  return out;
}

DataTable all_table(const std::vector<const Row*>& rows) {
  DataTable out{.name = "radius-all",
                .caption = "All points of the lemmas",
                .columns = {"generator", "depth", "radius", "radius px", "points", "no sample",
                            "not bounding", "rounded", "farthest outside (px)"},
                .alignment = "lllrrrrrr",
                .rows = {},
                .in_text = false};
  for (const Row* row : rows) {
    out.rows.push_back({generator_of(*row), surface_of(*row), row->point.radius,
                        rounded(count_of(*row, "radius_px").value_or(kNaN), 6),
                        count_cell(*row, "points"), count_cell(*row, "no_sample"),
                        count_cell(*row, "not_bounding"), count_cell(*row, "rounded"),
                        rounded(count_of(*row, "largest_px").value_or(kNaN))});
  }
  return out;
}

DataTable miss_table(const std::vector<const Row*>& rows) {
  DataTable out{.name = "radius-missed",
                .caption = "Missed pairs of FAR at every radius",
                .columns = {"scene", "depth", "radius", "colliding", "missed", "kept triangles"},
                .alignment = "lllrrr",
                .rows = {},
                .in_text = false};
  for (const Row* row : rows) {
    out.rows.push_back({row->point.scene, surface_of(*row), row->point.radius,
                        count_cell(*row, "colliding"), count_cell(*row, "missed"),
                        count_cell(*row, "kept_triangles")});
  }
  return out;
}

// The lemmas at the budget radius and beyond: with fragment depth a proof stands behind them, also
// where the rows do not say that they promise. What breaks() is said already.
void add_lemma_findings(const std::vector<const Row*>& rows, Chapter& chapter) {
  std::map<std::string, Sum> safe;
  std::uint64_t broken = 0;
  for (const Row* row : rows) {
    if (is_published(*row) || factor_of(*row) < 1) continue;
    add(*row, safe[surface_of(*row)]);
    if (row->point.depth_mode == "fixed" || number_of(*row, "violations") == 0) continue;
    ++broken;
    if (breaks(*row)) continue;
    chapter.findings.push_back(fmt::format(
        "BROKEN: at {} of the budget radius, {}, {} points of the generator \"{}\" are violated; "
        "the lemmas say none.",
        factor_of(*row), surface_of(*row),
        of_all(number_of(*row, "violations"), number_of(*row, "points")), generator_of(*row)));
  }
  for (const auto& [surface, sum] : safe) {
    if (surface != "fixed-function depth" && broken > 0 && sum.violations > 0) continue;
    chapter.findings.push_back(
        fmt::format("At the budget radius and beyond, {}: {} points are violated{}.", surface,
                    of_all(sum.violations, sum.points),
                    surface == "fixed-function depth" ? " (it promises nothing)" : ""));
  }
}

void add_published(const Lines& lines, Chapter& chapter) {
  for (const auto& [surface, generators] : lines) {
    std::vector<std::string> failing;
    Sum sum;
    double least = HUGE_VAL, most = 0;
    for (const auto& [generator, line] : generators) {
      if (generator == kAll || line.published.points == 0) continue;
      sum.points += line.published.points;
      sum.violations += line.published.violations;
      sum.no_sample += line.published.no_sample;
      sum.largest_px = std::max(sum.largest_px, line.published.largest_px);
      least = std::min(least, line.published_factor);
      most = std::max(most, line.published_factor);
      if (line.published.violations > 0) {
        failing.push_back(fmt::format("{} ({})", generator,
                                      of_all(line.published.violations, line.published.points)));
      }
    }
    if (sum.points == 0) continue;
    const std::string radius =
        least == most ? fmt::format("{:.4f}", least) : fmt::format("{:.4f} to {:.4f}", least, most);
    if (failing.empty()) {
      chapter.findings.push_back(
          fmt::format("The published radius, {} of the budget, violates none of {} points, {}.",
                      radius, grouped(sum.points), surface));
      continue;
    }
    chapter.findings.push_back(fmt::format(
        "The published radius, {} of the budget, fails, {}: {} points, {} of them without a sample"
        "{}; on {}.",
        radius, surface, of_all(sum.violations, sum.points), grouped(sum.no_sample),
        sum.largest_px > 0
            ? fmt::format(", others up to {} px outside their bounds", rounded(sum.largest_px))
            : "",
        listed(failing)));
  }
}

void add_misses(const MissLines& depths, Chapter& chapter) {
  for (const auto& [depth, lines] : depths) {
    for (const auto& [scene, line] : lines) {
      double worst = -1;
      for (const auto& [factor, row] : line.at) {
        if (number_of(*row, "missed") > 0) worst = std::max(worst, factor);
      }
      std::string text = worst < 0 ? fmt::format("{}, {}: no factor misses a pair", scene, depth)
                                   : fmt::format("{}, {}: pairs are missed up to the factor {:.4g}",
                                                 scene, depth, worst);
      if (line.published != nullptr) {
        text += fmt::format(
            "; the published radius misses {}",
            of_all(number_of(*line.published, "missed"), number_of(*line.published, "colliding")));
      }
      chapter.findings.push_back(text + ".");
    }
  }
}

}  // namespace

Chapter radius_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  std::vector<const Row*> lemmas, runs;
  for (const Row& row : stored.rows) {
    if (row.measurement.left_out.empty()) (is_lemma(row) ? lemmas : runs).push_back(&row);
  }
  const Lines lines = lines_of(lemmas);
  const MissLines misses = misses_of(runs);
  add_promises(stored, out);
  add_lemma_findings(lemmas, out);
  put_broken_first(out);
  add_published(lines, out);
  add_misses(misses, out);
  out.limits = {
      "The points are drawn to find violations, so a share of violated points is no probability in "
      "a scene.",
      "Below the budget a radius that violates nothing here is not thereby safe: another device "
      "may "
      "use the slack that this one leaves.",
      "Fixed-function depth is read from the depth buffer, and what rounding of the depth map "
      "explains is no violation (core/canvas.h, depth_rounding); fragment depth is what the shader "
      "computes, and must bound exactly."};
  add_gaps(stored, out);
  if (!lines.empty()) {
    out.figures.push_back(lemma_figure(lines));
    out.tables.push_back(lemma_table(lines, false));
    out.tables.push_back(lemma_table(lines, true));
  }
  if (!misses.empty()) out.figures.push_back(miss_figure(misses));
  if (!lemmas.empty()) out.tables.push_back(all_table(lemmas));
  if (!runs.empty()) out.tables.push_back(miss_table(runs));
  return out;
}

}  // namespace farcull
