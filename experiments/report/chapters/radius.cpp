// The chapter of the study "radius": how often the published radius misses something where nothing
// was constructed against it; then violated points of the lemmas and missed pairs of FAR against
// the radius, with the published radius beside the budget.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string_view>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/studies/run_point.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

bool is_published(const Row& row) { return row.point.radius == kPublishedRadius; }

// The radius over the budget radius; NaN where the row of a published radius lacks one of the two.
double factor_of(const Row& row) {
  if (is_published(row)) {
    const auto radius = count_of(row, "radius_px"), budget = count_of(row, "budget_px");
    return radius && budget ? *radius / *budget : kNone;
  }
  return row.point.radius.value_or(kBudgetRadius).factor;
}

// The canvas and the depth that a lemma was tested with.
std::string surface_of(const Row& row) {
  if (row.point.method == "lemma-worst") return "worst canvas";
  return row.point.depth_mode == DepthMode::fixed ? "fixed-function depth" : "fragment depth";
}

std::string generator_of(const Row& row) { return parse_lemma_scene(row.point.scene).generator; }

double violated(const Rows& rows) {
  return share(total(rows, "violations"), total(rows, "points"));
}
double missed(const Rows& rows) { return share(total(rows, "missed"), total(rows, "colliding")); }

// The rows of a line by factor, and those of the published radius apart.
struct Line {
  std::map<double, Rows> at;
  Rows published;
};
using Lines = std::map<std::string, std::map<std::string, Line>>;  // by surface and name

template <class NameOf>
Lines lines_of(const Rows& rows, const NameOf& name_of) {
  Lines out;
  for (const Row* row : rows) {
    Line& line = out[surface_of(*row)][name_of(*row)];
    (is_published(*row) ? line.published : line.at[factor_of(*row)]).push_back(row);
  }
  return out;
}

// The published radius over the budget, as the rows of FAR at both say; NaN where one is missing.
double published_factor(const Line& line) {
  const auto budget = line.at.find(1);
  if (line.published.empty() || budget == line.at.end()) return kNone;
  const auto one = count_of(*line.published.back(), "radius_px"),
             other = count_of(*budget->second.back(), "radius_px");
  return one && other && *other > 0 ? *one / *other : kNone;
}

Series line_series(const std::string& name, const Line& line, double (*value)(const Rows&),
                   Series::Style style) {
  Series out{.name = name, .style = style};
  for (const auto& [factor, rows] : line.at) {
    out.x.push_back(factor);
    out.y.push_back(value(rows));
  }
  return out;
}

// A share in per cent against the factor.
Panel panel_of(const std::string& title, const std::string& share) {
  Panel out{.title = title,
            .x = {.label = "radius / budget radius", .from = 0, .to = 1.1},
            .y = logarithmic(share, true),
            .marks = {{.vertical = true, .at = 1, .name = "budget radius"}}};
  out.y.to = 100;
  return out;
}

// The second row of panels shows kClose to 2 - kClose.
constexpr double kClose = 0.96;
constexpr const char* kAll = "all generators";
constexpr std::size_t kNamed = 3;  // generators with a line of their own

// The generators whose points are violated at the largest factors, on any surface; of equals those
// with the larger share there.
std::vector<std::string> hardest_generators(const Lines& generators) {
  std::map<std::string, std::pair<double, double>> at;  // the largest factor, the share there
  for (const auto& [surface, lines] : generators) {
    for (const auto& [generator, line] : lines) {
      auto& hardest = at.try_emplace(generator, -1, 0).first->second;
      for (const auto& [factor, rows] : line.at) {
        if (total(rows, "violations") > 0)
          hardest = std::max(hardest, std::pair(factor, violated(rows)));
      }
    }
  }
  std::vector<std::string> out;
  for (const auto& [generator, hardest] : at) out.push_back(generator);
  std::stable_sort(out.begin(), out.end(),
                   [&](const std::string& a, const std::string& b) { return at.at(a) > at.at(b); });
  out.resize(std::min(out.size(), kNamed));
  return out;
}

// At each factor the largest share of a generator.
Series envelope_of(const std::map<std::string, Line>& lines) {
  std::map<double, double> most;
  for (const auto& [generator, line] : lines) {
    for (const auto& [factor, rows] : line.at)
      most[factor] = std::max(most[factor], violated(rows));
  }
  Series out{.name = "largest of all generators", .style = Series::Style::lines};
  out.emphasis = true;
  for (const auto& [factor, share] : most) {
    out.x.push_back(factor);
    out.y.push_back(share);
  }
  return out;
}

Figure lemma_figure(const Lines& generators, std::uint64_t points) {
  Figure out{.name = "radius",
             .title = "Points whose pixel lacks a sample or a bound, against the radius"};
  const std::vector<std::string> named = hardest_generators(generators);
  std::size_t count = 0;
  for (const auto& [surface, lines] : generators) {
    count = std::max(count, lines.size());
    Panel panel = panel_of(surface, "violated points (%)");
    Series published{.name = "published radius, each generator", .style = Series::Style::points};
    for (const auto& [generator, line] : lines) {
      if (std::find(named.begin(), named.end(), generator) != named.end())
        panel.series.push_back(line_series(generator, line, violated, Series::Style::lines));
      if (line.published.empty()) continue;
      published.x.push_back(factor_of(*line.published.back()));
      published.y.push_back(violated(line.published));
    }
    panel.series.push_back(envelope_of(lines));
    if (!published.x.empty()) panel.series.push_back(std::move(published));
    out.panels.push_back(std::move(panel));
  }
  // The same once more, close to the published radius.
  const std::size_t surfaces = out.panels.size();
  for (std::size_t i = 0; i < surfaces; ++i) {
    Panel close = out.panels[i];
    close.title = "the same, close to 1";
    close.x.from = kClose;
    close.x.to = 2 - kClose;
    out.panels.push_back(std::move(close));
  }
  out.caption = fmt::format(
      "Lemmas 1 and 2 at {} points of triangles that aim at trouble, drawn by {} generators. The "
      "thick line is the largest share of any generator; those that fail at the largest factors "
      "are named. On the worst canvas a pixel has a fragment only where every device that keeps "
      "the assumptions gives it one.",
      grouped(points), count);
  return out;
}

Figure miss_figure(const Lines& depths) {
  Figure out{.name = "radius-missed", .title = "Missed pairs against the radius"};
  std::vector<std::string> scenes;
  std::size_t runs = 0;
  for (const auto& [depth, lines] : depths) {
    Panel panel = panel_of(depth, "missed pairs (%)");
    Series published{.name = "published radius, each scene", .style = Series::Style::points};
    for (const auto& [scene, line] : lines) {
      panel.series.push_back(line_series(scene, line, missed, Series::Style::lines_points));
      for (const auto& [factor, rows] : line.at) runs += rows.size();
      runs += line.published.size();
      if (!line.published.empty()) {
        published.x.push_back(published_factor(line));
        published.y.push_back(missed(line.published));
      }
      const Row& any = *(line.published.empty() ? line.at.begin()->second : line.published).back();
      const std::string words =
          fmt::format("{} in {}", grouped(number_of(any, "colliding")), scene);
      if (std::find(scenes.begin(), scenes.end(), words) == scenes.end()) scenes.push_back(words);
    }
    if (!published.x.empty()) panel.series.push_back(std::move(published));
    out.panels.push_back(std::move(panel));
  }
  out.caption = fmt::format(
      "FAR with oriented boxes: colliding pairs that culling loses, of {}. n = {}, one "
      "at each point.",
      listed(scenes), counted(runs, "run", "runs"));
  return out;
}

// The least factor from which on no row of the line is violated.
std::string least_safe(const Line& line) {
  std::string out = "-";
  for (auto it = line.at.rbegin(); it != line.at.rend() && total(it->second, "violations") == 0;
       ++it)
    out = fmt::format("{:.4g}", it->first);
  return out;
}

double px_of(const Rows& rows) { return largest(rows, "largest_px", HUGE_VAL); }

DataTable lemma_table(const std::string& name, const std::string& caption, const Lines& lines) {
  DataTable out{
      .name = name,
      .caption =
          "Violated points at the published and at the budget radius, and the least "
          "factor on the budget from which on none is" +
          caption,
      .columns = columns({"depth", "generator"}, {"points", "published", "budget", "least factor",
                                                  "published: farthest outside (px)"})};
  const auto cell = [](const Rows& rows, const char* count) {
    return rows.empty() ? "-" : grouped(total(rows, count));
  };
  for (const auto& [surface, generators] : lines) {
    for (const auto& [generator, line] : generators) {
      const auto found = line.at.find(1);
      const Rows budget = found == line.at.end() ? Rows{} : found->second;
      out.rows.push_back({surface, generator, cell(budget, "points"),
                          cell(line.published, "violations"), cell(budget, "violations"),
                          least_safe(line),
                          line.published.empty() ? "-" : rounded(px_of(line.published))});
    }
  }
  return out;
}

RowColumn radius_column() {
  return {text_column("radius"), [](const Row& row) { return column_text(row.point.radius); }};
}

DataTable all_table(const Rows& rows) {
  return table_of_rows("radius-all", "All points of the lemmas", rows,
                       {{text_column("generator"), generator_of},
                        {text_column("depth"), surface_of},
                        radius_column(),
                        rounded_column("radius px", "radius_px", 6),
                        count_column("points", "points"),
                        count_column("no sample", "no_sample"),
                        count_column("not bounding", "not_bounding"),
                        count_column("rounded", "rounded"),
                        rounded_column("farthest outside (px)", "largest_px")});
}

DataTable miss_table(const Rows& rows) {
  return table_of_rows("radius-missed", "Missed pairs of FAR at every radius", rows,
                       {scene_column(),
                        {text_column("depth"), surface_of},
                        radius_column(),
                        count_column("colliding", "colliding"),
                        count_column("missed", "missed"),
                        count_column("kept triangles", "kept_triangles")});
}

// The lemmas at the budget radius and beyond: with fragment depth a proof stands behind them, also
// where the rows do not say that they promise. Rows for which breaks() holds are said already.
void add_lemma_findings(Rows rows, Chapter& chapter) {
  std::erase_if(rows, [](const Row* row) { return is_published(*row) || factor_of(*row) < 1; });
  bool broken = false;
  for (const Row* row : rows) {
    if (row->point.depth_mode == DepthMode::fixed || number_of(*row, "violations") == 0) continue;
    broken = true;
    if (breaks(*row)) continue;
    chapter.find_broken(fmt::format(
        "at {} of the budget radius, {}, {} points of the generator \"{}\" are violated; the "
        "lemmas say none.",
        factor_of(*row), surface_of(*row), of_all({row}, "violations", "points"),
        generator_of(*row)));
  }
  for (const auto& [surface, safe] : rows_by(rows, surface_of)) {
    const bool promised = surface != "fixed-function depth";
    if (promised && broken && total(safe, "violations") > 0) continue;
    chapter.find(fmt::format("At the budget radius and beyond, {}: {} points are violated{}.",
                             surface, of_all(safe, "violations", "points"),
                             promised ? "" : " (it promises nothing)"));
  }
}

void add_published(const Lines& generators, Chapter& chapter) {
  for (const auto& [surface, lines] : generators) {
    std::vector<std::string> failing;
    Rows all;
    double least = HUGE_VAL, most = 0;
    for (const auto& [generator, line] : lines) {
      if (line.published.empty()) continue;
      all.insert(all.end(), line.published.begin(), line.published.end());
      least = std::min(least, factor_of(*line.published.back()));
      most = std::max(most, factor_of(*line.published.back()));
      if (total(line.published, "violations") == 0) continue;
      failing.push_back(
          fmt::format("{} ({})", generator, of_all(line.published, "violations", "points")));
    }
    if (all.empty()) continue;
    const std::string radius =
        least == most ? fmt::format("{:.4f}", least) : fmt::format("{:.4f} to {:.4f}", least, most);
    if (failing.empty()) {
      chapter.find(
          fmt::format("The published radius, {} of the budget, violates none of {} points, {}.",
                      radius, grouped(total(all, "points")), surface));
      continue;
    }
    chapter.find(fmt::format(
        "The published radius, {} of the budget, fails, {}: {} points, {} of them without a sample"
        "{}; on {}.",
        radius, surface, of_all(all, "violations", "points"), grouped(total(all, "no_sample")),
        px_of(all) > 0
            ? fmt::format(", others up to {} px outside their bounds", rounded(px_of(all)))
            : "",
        listed(failing)));
  }
}

// ---- placements ----

bool is_placement(const Row& row) {
  return row.point.scene.find("@crossing:") != std::string::npos ||
         row.point.scene.find("@grazing:") != std::string::npos;
}

// "dragon-bunny, crossing, 0.25 px".
struct PlacementScene {
  std::string from, contact;
  double side = 0;
};
PlacementScene placement_of(const Row& row) {
  const std::string& scene = row.point.scene;
  const std::size_t at = scene.find('@'), colon = scene.find(':', at);
  return {scene.substr(0, at), scene.substr(at + 1, colon - at - 1),
          std::strtod(scene.c_str() + colon + 1, nullptr)};
}

// 0: corners are not snapped.
int bits_of(const Row& row) {
  constexpr std::string_view kSnapped = "far-snapped-";
  return row.point.method.starts_with(kSnapped)
             ? std::atoi(row.point.method.c_str() + kSnapped.size())
             : 0;
}

std::string bits_text(int bits) {
  return bits > 0 ? fmt::format("{} subpixel bits", bits) : "corners not snapped";
}

std::string rate_of_rows(const Rows& rows) {
  return rate_text(total(rows, "missed_placements"), total(rows, "colliding_placements"));
}

// Adds how often the published radius misses something in scenes that nobody constructed for it,
// and that its failure end to end rests on those that were. First, since the rest of the chapter is
// about constructed points.
void add_headline(const Rows& runs, const Rows& placements, Chapter& chapter) {
  Rows natural, constructed, placed;
  for (const Row* row : runs) {
    if (!is_published(*row) || row->point.depth_mode != DepthMode::fragment) continue;
    (row->point.scene == "pixel-corners" ? constructed : natural).push_back(row);
  }
  for (const Row* row : placements) {
    if (is_published(*row)) placed.push_back(row);
  }
  if (!natural.empty()) {
    const std::uint64_t missed = total(natural, "missed");
    chapter.find(fmt::format(
        "On scenes that were not constructed against it, the published radius missed {} colliding "
        "pairs in {} with fragment depth{}.",
        rate_text(missed, total(natural, "colliding")), counted(natural.size(), "run", "runs"),
        constructed.empty() ? ""
        : missed == 0 && total(constructed, "missed") > 0
            ? fmt::format("; its failure end to end rests on the constructed pixel-corners, where "
                          "it missed {}",
                          of_all(constructed, "missed", "colliding"))
            : fmt::format("; on the constructed pixel-corners it missed {} here",
                          of_all(constructed, "missed", "colliding"))));
  }
  for (const auto& [bits, rows] : rows_by(placed, bits_of)) {
    chapter.find(fmt::format(
        "Of patches placed into each other at random, {}, the published radius missed something in "
        "{} placements{}.",
        bits_text(bits), rate_of_rows(rows),
        total(rows, "missed") > 0
            ? fmt::format("; the longest intersection that it missed is {} px long",
                          rounded(largest(rows, "largest_miss_px", kNone)))
            : ""));
  }
  // So that a rate of 0 says something: what a smaller radius misses in the same placements.
  std::map<double, Rows> smaller;
  for (const Row* row : placements) {
    if (!is_published(*row) && factor_of(*row) < 1) smaller[factor_of(*row)].push_back(row);
  }
  std::vector<std::string> words;
  for (const auto& [factor, rows] : smaller)
    words.push_back(fmt::format("at {:.4g} of the budget in {}", factor,
                                of_all(rows, "missed_placements", "colliding_placements")));
  if (!words.empty()) {
    chapter.find(
        fmt::format("Smaller radii miss something in such placements: {}.", listed(words)));
  }
}

// The rate of placements in which something is missed against the radius over the budget, by the
// size of triangles, where corners are snapped to as many bits as in most placements.
Panel placements_by_radius(const Rows& all) {
  std::map<int, std::uint64_t> times;
  for (const Row* row : all) times[bits_of(*row)] += number_of(*row, "placements");
  Panel panel = panel_of("by the size of triangles", "placements with a miss (%)");
  if (times.empty()) return panel;
  const int bits = std::max_element(times.begin(), times.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                   })->first;
  panel.title = fmt::format("{}, by the size of triangles", bits_text(bits));
  std::map<double, std::map<double, Rows>> sides;
  for (const Row* row : all) {
    const double factor = factor_of(*row);
    if (bits_of(*row) == bits && std::isfinite(factor))
      sides[placement_of(*row).side][factor].push_back(row);
  }
  for (const auto& [side, factors] : sides) {
    if (factors.size() < 2) continue;
    Series series{.name = fmt::format("sides of {:.4g} px", side)};
    for (const auto& [factor, rows] : factors) {
      series.x.push_back(factor);
      series.y.push_back(
          share(total(rows, "missed_placements"), total(rows, "colliding_placements")));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

// The rate of placements in which something is missed, and its interval, by the radius; and at the
// published radius by subpixel bits, by the size of triangles and by resolution.
Figure placement_figure(const Rows& all) {
  Figure out{.name = "radius-placements",
             .title = "How often the published radius misses something in random placements"};
  Rows rows = all;
  std::erase_if(rows, [](const Row* row) { return !is_published(*row); });
  if (Panel panel = placements_by_radius(all); !panel.series.empty())
    out.panels.push_back(std::move(panel));
  // What most rows have is what the others vary.
  const auto usual = [&](const auto& value) {
    std::map<double, std::uint64_t> times;
    for (const Row* row : rows) times[value(*row)] += number_of(*row, "placements");
    return std::max_element(times.begin(), times.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  };
  const auto side = [](const Row& row) { return placement_of(row).side; };
  const auto bits = [](const Row& row) { return static_cast<double>(bits_of(row)); };
  const auto pixels = [](const Row& row) { return static_cast<double>(row.point.resolution); };
  if (rows.empty()) return out;
  const double usual_bits = usual(bits), usual_pixels = usual(pixels);
  std::map<double, int> sides_at_other_bits;
  for (const Row* row : rows) {
    if (bits(*row) != usual_bits) ++sides_at_other_bits[side(*row)];
  }
  const double usual_side =
      sides_at_other_bits.empty() ? side(*rows.front()) : sides_at_other_bits.begin()->first;
  const auto add = [&](const std::string& title, const Axis& x, const auto& value,
                       const auto& belongs) {
    Panel panel{.title = title, .x = x, .y = logarithmic("placements with a miss (%)", true)};
    std::map<std::string, Rows> kinds;
    for (const Row* row : rows) {
      const PlacementScene scene = placement_of(*row);
      if (belongs(*row)) kinds[scene.from + ", " + scene.contact].push_back(row);
    }
    for (auto& [kind, of] : kinds) {
      // Not lines: fewer bits are not on the way to corners that are not snapped.
      Series series{.name = kind, .style = Series::Style::points};
      for (const auto& [at, here] : rows_by(of, value)) {
        const std::uint64_t n = total(here, "colliding_placements");
        if (n == 0) continue;
        const Rate rate = rate_of(total(here, "missed_placements"), n);
        series.x.push_back(at);
        series.y.push_back(100 * rate.value);
        series.y_low.push_back(100 * rate.low);
        series.y_high.push_back(100 * rate.high);
      }
      panel.series.push_back(std::move(series));
    }
    out.panels.push_back(std::move(panel));
  };
  add(fmt::format("{} px sides, {:.0f} px windows", rounded(usual_side), usual_pixels),
      Axis{.label = "subpixel bits (0: not snapped)"}, bits,
      [&](const Row& row) { return side(row) == usual_side && pixels(row) == usual_pixels; });
  add(fmt::format("{:.0f} bits, {:.0f} px windows", usual_bits, usual_pixels),
      logarithmic("longest side of a triangle (px)"), side,
      [&](const Row& row) { return bits(row) == usual_bits && pixels(row) == usual_pixels; });
  add(fmt::format("{:.0f} bits, {} px sides", usual_bits, rounded(usual_side)),
      logarithmic("resolution (px)"), pixels,
      [&](const Row& row) { return bits(row) == usual_bits && side(row) == usual_side; });
  out.caption = fmt::format(
      "FAR with oriented boxes and fragment depth in three views, on placements of two patches of "
      "triangles, each decided by exact predicates: of those in which a pair collides, those in "
      "which one is missed. The first panel is over the radius; the others are at the published "
      "radius ({} placements, the same ones for each number of subpixel bits), with the 95 % "
      "interval of Clopper and Pearson (where none is missed, its upper bound is 3 over their "
      "number).",
      grouped(total(rows, "placements")));
  return out;
}

DataTable placement_table(const Rows& rows) {
  DataTable out{.name = "radius-placements",
                .caption =
                    "Random placements in which FAR misses a colliding pair, of those in "
                    "which one collides",
                .columns = columns({"radius", "patches", "contact"},
                                   {"side (px)", "subpixel bits", "resolution", "placements",
                                    "with a miss", "missed pairs", "largest miss (px)"})};
  for (const Row* row : rows) {
    const PlacementScene scene = placement_of(*row);
    out.rows.push_back(
        {column_text(row->point.radius), scene.from, scene.contact, rounded(scene.side),
         bits_of(*row) > 0 ? std::to_string(bits_of(*row)) : "not snapped",
         std::to_string(row->point.resolution), count_cell(*row, "placements"), rate_of_rows({row}),
         of_all({row}, "missed", "colliding"),
         number_of(*row, "missed") > 0 ? rounded(count_or_none(*row, "largest_miss_px")) : "-"});
  }
  return out;
}

void add_misses(const Lines& depths, Chapter& chapter) {
  for (const auto& [depth, lines] : depths) {
    for (const auto& [scene, line] : lines) {
      double worst = -1;
      for (const auto& [factor, rows] : line.at) {
        if (total(rows, "missed") > 0) worst = std::max(worst, factor);
      }
      std::string text = worst < 0 ? fmt::format("{}, {}: no factor misses a pair", scene, depth)
                                   : fmt::format("{}, {}: pairs are missed up to the factor {:.4g}",
                                                 scene, depth, worst);
      if (!line.published.empty()) {
        text += "; the published radius misses " + of_all(line.published, "missed", "colliding");
      }
      chapter.find(text + ".");
    }
  }
}

}  // namespace

Chapter radius_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  Rows lemmas, runs, placements;
  for (const Row* row : measured(stored))
    (is_lemma(*row) ? lemmas : is_placement(*row) ? placements : runs).push_back(row);
  const Lines generators = lines_of(lemmas, generator_of);
  const Lines together = lines_of(lemmas, [](const Row&) { return kAll; });
  const Lines misses = lines_of(runs, [](const Row& row) { return row.point.scene; });
  add_headline(runs, placements, out);
  add_promises(stored, out);
  add_lemma_findings(lemmas, out);
  put_broken_first(out);
  add_published(generators, out);
  add_misses(misses, out);
  out.limits = {
      "The points are drawn to find violations, so a share of violated points is no probability in "
      "a scene.",
      "Placements are of patches of eight triangles alone, which meet by construction. A rate over "
      "them is no rate over the pairs of a scene, where other triangles keep many of them.",
      "Devices that snap are stood in for: the native canvas draws proxies whose corners are "
      "rounded to the nearest subpixel. A2 allows a device twice that error.",
      "Below the budget a radius that violates nothing here is not thereby safe: another device "
      "may use the slack that this one leaves.",
      "Fixed-function depth is read from the depth buffer, and what rounding of the depth map "
      "explains is no violation (core/canvas/canvas.h, depth_rounding); fragment depth is what the "
      "shader computes, and must bound exactly."};
  add_gaps(stored, out);
  if (!lemmas.empty()) {
    out.figures.push_back(lemma_figure(generators, total(lemmas, "points")));
    out.tables.push_back(lemma_table("radius", "", together));
    out.tables.push_back(lemma_table("radius-generators", ", of every generator", generators));
    out.tables.back().in_text = false;
  }
  if (!misses.empty()) out.figures.push_back(miss_figure(misses));
  if (!placements.empty()) {
    Figure placed = placement_figure(placements);
    if (!placed.panels.empty()) out.figures.push_back(std::move(placed));
    out.tables.push_back(placement_table(placements));
  }
  if (!lemmas.empty()) out.tables.push_back(all_table(lemmas));
  if (!runs.empty()) out.tables.push_back(miss_table(runs));
  return out;
}

}  // namespace farcull
