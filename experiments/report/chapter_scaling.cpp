#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

// One of the plots: which rows are in it, and what time is plotted against.
struct Arm {
  std::string name;   // in the table of exponents
  std::string title;  // of the panel
  std::string axis;
  std::function<bool(const Point&)> holds;
  std::function<std::optional<double>(const Row&)> x;
};

std::size_t colons(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), ':'));
}

bool is_crowd(const Point& point, std::size_t numbers) {
  return point.scene.starts_with("crowd:") && colons(point.scene) == numbers;
}

std::optional<double> density_of(const Row& row) {
  return std::stod(row.point.scene.substr(row.point.scene.rfind(':') + 1));
}

// Pixels are only of those that draw and of far-pairs; the others of the same scene serve no plot.
const std::vector<Arm>& arms() {
  static const std::vector<Arm> all = {
      {"objects", "objects: crowd:N", "objects", [](const Point& p) { return is_crowd(p, 1); },
       [](const Row& row) { return count_of(row, "objects"); }},
      {"triangles", "triangles: torii:N", "triangles",
       [](const Point& p) { return p.scene.starts_with("torii:"); },
       [](const Row& row) { return count_of(row, "triangles"); }},
      {"resolution", "resolution: two-spheres", "px",
       [](const Point& p) { return p.scene == "two-spheres" && p.resolution > 0; },
       [](const Row& row) { return std::optional<double>(row.point.resolution); }},
      {"density", "density: crowd", "objects per unit of volume",
       [](const Point& p) { return is_crowd(p, 2); }, density_of},
      {"colliding pairs", "colliding pairs: crowd", "colliding pairs",
       [](const Point& p) { return is_crowd(p, 2); },
       [](const Row& row) { return count_of(row, "colliding"); }}};
  return all;
}

struct Line {
  std::vector<std::pair<double, double>> points;  // x, ms; ascending in x
  std::vector<double> xs() const {
    std::vector<double> out;
    for (const auto& [x, y] : points) out.push_back(x);
    return out;
  }
  std::vector<double> ys() const {
    std::vector<double> out;
    for (const auto& [x, y] : points) out.push_back(y);
    return out;
  }
};

const std::vector<std::string>& methods() {
  static const std::vector<std::string> all = {"FAR (OBB)", "FAR pairs", "CULLIDE", "I-COLLIDE",
                                               "exact"};
  return all;
}

std::map<std::string, Line> lines_of(const StoredStudy& stored, const Arm& arm) {
  std::map<std::string, Line> out;
  for (const Row& row : stored.rows) {
    if (!arm.holds(row.point)) continue;
    const std::optional<double> x = arm.x(row), ms = time_of(row, "total");
    if (x && ms) out[method_label(row.point)].points.emplace_back(*x, *ms);
  }
  for (auto& [method, line] : out) std::sort(line.points.begin(), line.points.end());
  return out;
}

std::string exponent_text(const Exponent& e) {
  return fmt::format("{:.2f} ± {:.2f}", e.value, e.error);
}

// Missed of colliding pairs by method, over all rows of the study; what misses is a finding.
DataTable miss_table(const StoredStudy& stored, Chapter& chapter) {
  DataTable out{.name = "scaling-missed",
                .caption = "Missed pairs of all that collide, over all sizes",
                .columns = {"method", "runs", "colliding", "missed"},
                .alignment = "lrrr",
                .rows = {}};
  struct Sum {
    std::uint64_t runs = 0, colliding = 0, missed = 0;
  };
  std::map<std::string, Sum> sums;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty() || !count_of(row, "missed")) continue;
    Sum& sum = sums[contestant(row.point)];
    ++sum.runs;
    sum.colliding += number_of(row, "colliding");
    sum.missed += number_of(row, "missed");
  }
  for (const auto& [method, sum] : sums) {
    out.rows.push_back({method, grouped(sum.runs), grouped(sum.colliding), grouped(sum.missed)});
    if (method != "CULLIDE" && sum.missed == 0) continue;
    chapter.findings.push_back(fmt::format("{} misses {} colliding pairs over all sizes.", method,
                                           of_all(sum.missed, sum.colliding)));
  }
  return out;
}

// "256 px", of those that draw where pixels are not what is varied.
std::string resolutions_of(const StoredStudy& stored) {
  std::set<int> sides;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty() || row.point.resolution <= 0) continue;
    const auto holds = [&](const Arm& arm) { return arm.holds(row.point); };
    if (std::any_of(arms().begin(), arms().end(),
                    [&](const Arm& arm) { return arm.name != "resolution" && holds(arm); }))
      sides.insert(row.point.resolution);
  }
  std::vector<std::string> words;
  for (const int side : sides) words.push_back(std::to_string(side));
  return listed(words) + " px";
}

}  // namespace

Chapter scaling_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  add_promises(stored, out);
  DataTable misses = miss_table(stored, out);

  Figure figure{.name = "scaling",
                .title = "Time against objects, triangles, resolution, density and colliding pairs",
                .caption = {},
                .panels = {}};
  DataTable exponents{.name = "scaling-exponents",
                      .caption =
                          "Exponent b of time = a x^b, by least squares in logarithms over "
                          "the whole range, with its standard error",
                      .columns = {"x", "method", "from", "to", "points", "exponent"},
                      .alignment = "llrrrr",
                      .rows = {}};
  DataTable times{.name = "scaling-times",
                  .caption = "Milliseconds from triangles to exact pairs, median of the repeats",
                  .columns = {"x", "method", "value", "ms"},
                  .alignment = "llrr",
                  .rows = {},
                  .in_text = false};
  for (const Arm& arm : arms()) {
    const std::map<std::string, Line> lines = lines_of(stored, arm);
    Panel panel{.title = arm.title,
                .x = {.label = arm.axis, .logarithmic = true, .shows_zero = true},
                .y = {.label = "time, ms", .logarithmic = true},
                .series = {}};
    std::vector<std::string> said;
    for (const std::string& method : methods()) {
      const auto at = lines.find(method);
      if (at == lines.end()) continue;
      const Line& line = at->second;
      Series series{.name = method, .x = line.xs(), .y = line.ys()};
      series.emphasis = method.starts_with("FAR");
      panel.series.push_back(std::move(series));
      for (const auto& [x, ms] : line.points) {
        times.rows.push_back({arm.name, method, rounded(x, 6), rounded(ms, 4)});
      }
      if (const auto e = exponent_of(line.xs(), line.ys())) {
        exponents.rows.push_back({arm.name, method, rounded(e->from), rounded(e->to),
                                  grouped(e->points), exponent_text(*e)});
        said.push_back(fmt::format("{} {}", method, exponent_text(*e)));
      }
    }
    if (!said.empty()) {
      out.findings.push_back("Exponent of time over " + arm.name + ": " + listed(said) + ".");
    }
    if (!panel.series.empty()) figure.panels.push_back(std::move(panel));
  }
  const std::string resolutions = resolutions_of(stored);
  figure.caption =
      "Both axes are logarithmic, so that a power of x is a straight line. " +
      (resolutions == " px" ? std::string()
                            : "Methods that draw are measured at " + resolutions +
                                  " but for the plot of resolution, and not at the largest "
                                  "sizes. ") +
      "Density and colliding pairs are two views of the same rows: the same objects in ever "
      "smaller "
      "boxes.";
  out.limits = {
      "A fitted exponent holds for its range alone: constant parts flatten small sizes, caches and "
      "the growing number of rounds steepen large ones. The standard error is of the straight "
      "line, "
      "not of the machine, whose times swing.",
      "More objects in `crowd:N` stand at the same density, more triangles in `torii:N` are of the "
      "same six objects, so that what collides grows with both.",
      "I-COLLIDE sorts anew in each run here; from frame to frame it would mend what it has "
      "sorted.",
      "Fragment work runs on the CPU where the device is software: there, resolution costs what "
      "graphics hardware does side by side."};
  add_gaps(stored, out);
  if (!figure.panels.empty()) out.figures.push_back(std::move(figure));
  if (!times.rows.empty()) out.tables = {std::move(exponents), std::move(times)};
  if (!misses.rows.empty()) out.tables.push_back(std::move(misses));
  return out;
}

}  // namespace farcull
