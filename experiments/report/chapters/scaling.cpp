// The chapter of the study "scaling": time against five measures of size, with fitted exponents.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// One of the plots: the rows in it, and the size that time is plotted against.
struct Arm {
  std::string name;   // in the table of exponents
  std::string title;  // of the panel
  std::string axis;
  std::function<bool(const PointKey&)> holds;
  std::function<std::optional<double>(const Row&)> x;
};

std::size_t colons(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), ':'));
}

bool is_crowd(const PointKey& point, std::size_t numbers) {
  return point.scene.starts_with("crowd:") && colons(point.scene) == numbers;
}

std::optional<double> density_of(const Row& row) {
  return std::stod(row.point.scene.substr(row.point.scene.rfind(':') + 1));
}

// Pixels are only of those that draw and of far-pairs; the others of the same scene serve no plot.
const std::vector<Arm>& arms() {
  static const std::vector<Arm> all = {
      {"objects", "objects: crowd:N", "objects", [](const PointKey& p) { return is_crowd(p, 1); },
       [](const Row& row) { return count_of(row, "objects"); }},
      {"triangles", "triangles: torii:N", "triangles",
       [](const PointKey& p) { return p.scene.starts_with("torii:"); },
       [](const Row& row) { return count_of(row, "triangles"); }},
      {"resolution", "resolution: two-spheres", "px",
       [](const PointKey& p) { return p.scene == "two-spheres" && p.resolution > 0; },
       [](const Row& row) { return std::optional<double>(row.point.resolution); }},
      {"density", "density: crowd", "objects per unit of volume",
       [](const PointKey& p) { return is_crowd(p, 2); }, density_of},
      {"colliding pairs", "colliding pairs: crowd", "colliding pairs",
       [](const PointKey& p) { return is_crowd(p, 2); },
       [](const Row& row) { return count_of(row, "colliding"); }}};
  return all;
}

struct Line {
  std::vector<double> x, ms;  // ascending in x
};

const std::vector<std::string>& methods() {
  static const std::vector<std::string> all = {"FAR (OBB)", "FAR pairs", "CULLIDE", "I-COLLIDE",
                                               "exact"};
  return all;
}

std::map<std::string, Line> lines_of(const StoredStudy& stored, const Arm& arm) {
  std::map<std::string, std::vector<std::pair<double, double>>> points;
  for (const Row& row : stored.rows) {
    if (!arm.holds(row.point)) continue;
    const std::optional<double> x = arm.x(row), ms = time_of(row, "total");
    if (x && ms) points[method_label(row.point)].emplace_back(*x, *ms);
  }
  std::map<std::string, Line> out;
  for (auto& [method, line] : points) {
    std::sort(line.begin(), line.end());
    for (const auto& [x, ms] : line) {
      out[method].x.push_back(x);
      out[method].ms.push_back(ms);
    }
  }
  return out;
}

std::string exponent_text(const Exponent& e) {
  return fmt::format("{:.2f} ± {:.2f}", e.value, e.error);
}

// Missed of colliding pairs by method, over all rows of the study; a method that misses is a
// finding.
DataTable miss_table(const StoredStudy& stored, Chapter& chapter) {
  DataTable out{.name = "scaling-missed",
                .caption = "Missed pairs of all that collide, over all sizes",
                .columns = columns({"method"}, {"runs", "colliding", "missed"})};
  Rows verified = measured(stored);
  std::erase_if(verified, [](const Row* row) { return !count_of(*row, "missed"); });
  for (const auto& [method, runs] :
       rows_by(verified, [](const Row& row) { return contestant(row.point); })) {
    const std::uint64_t missed = total(runs, "missed");
    out.rows.push_back(
        {method, grouped(runs.size()), grouped(total(runs, "colliding")), grouped(missed)});
    if (method != "CULLIDE" && missed == 0) continue;
    chapter.find(fmt::format("{} misses {} colliding pairs over all sizes.", method,
                             of_all(runs, "missed", "colliding")));
  }
  return out;
}

// "256 px": the resolutions of the methods that draw in all plots but that of resolution.
std::string resolutions_of(const StoredStudy& stored) {
  std::set<int> sides;
  for (const Row* row : measured(stored)) {
    const auto holds = [&](const Arm& arm) {
      return arm.name != "resolution" && arm.holds(row->point);
    };
    if (row->point.resolution > 0 && std::any_of(arms().begin(), arms().end(), holds))
      sides.insert(row->point.resolution);
  }
  std::vector<std::string> words;
  for (const int side : sides) words.push_back(std::to_string(side));
  return listed(words) + " px";
}

std::string caption_of(const StoredStudy& stored) {
  const std::string resolutions = resolutions_of(stored);
  return "Both axes are logarithmic, so that a power of x is a straight line. " +
         (resolutions == " px" ? std::string()
                               : "Methods that draw are measured at " + resolutions +
                                     " but for the plot of resolution, and not at the largest "
                                     "sizes. ") +
         "Density and colliding pairs are two views of the same rows: the same objects in ever "
         "smaller boxes.";
}

}  // namespace

Chapter scaling_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  add_promises(stored, out);
  DataTable misses = miss_table(stored, out);

  Figure figure{
      .name = "scaling",
      .title = "Time against objects, triangles, resolution, density and colliding pairs"};
  DataTable exponents{.name = "scaling-exponents",
                      .caption =
                          "Exponent b of time = a x^b, by least squares in logarithms over "
                          "the whole range, with its standard error",
                      .columns = columns({"x", "method"}, {"from", "to", "points", "exponent"})};
  DataTable times{.name = "scaling-times",
                  .caption = "Milliseconds from triangles to exact pairs, median of the repeats",
                  .columns = columns({"x", "method"}, {"value", "ms"}),
                  .in_text = false};
  for (const Arm& arm : arms()) {
    const std::map<std::string, Line> lines = lines_of(stored, arm);
    Panel panel{.title = arm.title, .x = logarithmic(arm.axis, true), .y = logarithmic("time, ms")};
    std::vector<std::string> said;
    for (const std::string& method : methods()) {
      const auto at = lines.find(method);
      if (at == lines.end()) continue;
      const Line& line = at->second;
      Series series{.name = method, .x = line.x, .y = line.ms};
      series.emphasis = method.starts_with("FAR");
      panel.series.push_back(std::move(series));
      for (std::size_t i = 0; i < line.x.size(); ++i)
        times.rows.push_back({arm.name, method, rounded(line.x[i], 6), rounded(line.ms[i], 4)});
      if (const auto e = exponent_of(line.x, line.ms)) {
        exponents.rows.push_back({arm.name, method, rounded(e->from), rounded(e->to),
                                  grouped(e->points), exponent_text(*e)});
        said.push_back(fmt::format("{} {}", method, exponent_text(*e)));
      }
    }
    if (!said.empty()) {
      out.find("Exponent of time over " + arm.name + ": " + listed(said) + ".");
    }
    if (!panel.series.empty()) figure.panels.push_back(std::move(panel));
  }
  figure.caption = caption_of(stored);
  out.limits = {
      "A fitted exponent holds for its range alone: constant parts flatten small sizes, caches and "
      "the growing number of rounds steepen large ones. The standard error is of the straight "
      "line, not of the machine, whose times swing.",
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
