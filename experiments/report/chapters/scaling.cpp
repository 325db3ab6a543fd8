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
      {"resolution", "resolution: two-spheres", "resolution (px)",
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
  std::vector<double> x;
  std::vector<Estimate> ms;
  Rows rows;  // all ascending in x
};

const std::vector<std::string>& methods() {
  static const std::vector<std::string> all = {"FAR (OBB)", "FAR pairs", "CULLIDE", "I-COLLIDE",
                                               "exact"};
  return all;
}

std::map<std::string, Line> lines_of(const StoredStudy& stored, const Arm& arm) {
  std::map<std::string, std::vector<std::pair<double, const Row*>>> points;
  for (const Row& row : stored.rows) {
    if (!arm.holds(row.point)) continue;
    const std::optional<double> x = arm.x(row);
    if (x && time_of(row, "total")) points[method_label(row.point)].emplace_back(*x, &row);
  }
  std::map<std::string, Line> out;
  for (auto& [method, line] : points) {
    std::stable_sort(line.begin(), line.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Line& to = out[method];
    for (const auto& [x, row] : line) {
      to.x.push_back(x);
      to.ms.push_back(*time_estimate(*row));
      to.rows.push_back(row);
    }
  }
  return out;
}

std::vector<double> medians_of(const Line& line) {
  std::vector<double> out;
  for (const Estimate& ms : line.ms) out.push_back(ms.value);
  return out;
}

// Missed of colliding pairs by method, over all rows of the study; a method that misses is a
// finding.
DataTable miss_table(const StoredStudy& stored, Chapter& chapter) {
  DataTable out{.name = "scaling-missed",
                .caption =
                    "Missed pairs of all that collide, over all sizes; of what missed none, the "
                    "upper bound of the rate at 95 %, 3/N, were the pairs independent",
                .columns = columns({"method"}, {"points", "colliding", "missed", "rate"})};
  Rows verified = measured(stored);
  std::erase_if(verified, [](const Row* row) { return !count_of(*row, "missed"); });
  for (const auto& [method, runs] :
       rows_by(verified, [](const Row& row) { return contestant(row.point); })) {
    const std::uint64_t missed = total(runs, "missed"), colliding = total(runs, "colliding");
    const double rate = static_cast<double>(missed) / static_cast<double>(colliding);
    out.rows.push_back({method, grouped(runs.size()), grouped(colliding), grouped(missed),
                        colliding == 0 ? "-"
                        : missed == 0  ? at_most(colliding)
                                       : rounded(rate)});
    if (method != "CULLIDE" && missed == 0) continue;
    chapter.find(fmt::format("{} missed {} colliding pairs over all sizes.", method,
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

std::string caption_of(const StoredStudy& stored, Rows drawn) {
  const std::string resolutions = resolutions_of(stored);
  // Rows of two plots count once.
  std::sort(drawn.begin(), drawn.end());
  drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
  return sample_text(drawn) +
         ", with its 95 % interval as a bar. Both axes are logarithmic, so that a power of x is a "
         "straight line. " +
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
                      .caption = fmt::format(
                          "Exponent b of time = a x^b, by least squares in logarithms over the "
                          "whole range, with its 95 % interval (Student's t of the residuals; not "
                          "given for fewer than {} points)",
                          kFewestForInterval),
                      .columns = columns({"x", "method"}, {"from", "to", "points", "exponent"})};
  DataTable times{.name = "scaling-times",
                  .caption =
                      "Time from triangles to exact pairs: median of the runs, with its 95 % "
                      "interval",
                  .columns = columns({"x", "method"}, {"value", "runs", "time (ms)"}),
                  .in_text = false};
  Rows drawn;
  for (const Arm& arm : arms()) {
    const std::map<std::string, Line> lines = lines_of(stored, arm);
    Panel panel{
        .title = arm.title, .x = logarithmic(arm.axis, true), .y = logarithmic("time (ms)")};
    std::vector<std::string> said;
    for (const std::string& method : methods()) {
      const auto at = lines.find(method);
      if (at == lines.end()) continue;
      const Line& line = at->second;
      std::size_t point = 0;
      Series series = times_of(method, line.rows, [&](const Row&) { return line.x[point++]; });
      series.emphasis = method.starts_with("FAR");
      panel.series.push_back(std::move(series));
      drawn.insert(drawn.end(), line.rows.begin(), line.rows.end());
      for (std::size_t i = 0; i < line.x.size(); ++i) {
        times.rows.push_back({arm.name, method, rounded(line.x[i], 6), grouped(line.ms[i].n),
                              estimate_text(line.ms[i], 4)});
      }
      if (const auto e = exponent_of(line.x, medians_of(line))) {
        exponents.rows.push_back({arm.name, method, rounded(e->from), rounded(e->to),
                                  grouped(e->points), exponent_text(*e)});
        said.push_back(fmt::format("{} {}", method, exponent_text(*e)));
      }
    }
    if (!said.empty()) {
      out.find("Exponent of time over " + arm.name + ", with its 95 % interval: " + listed(said) +
               ".");
    }
    if (!panel.series.empty()) figure.panels.push_back(std::move(panel));
  }
  figure.caption = caption_of(stored, drawn);
  out.limits = {
      "A fitted exponent holds for its range alone: constant parts flatten small sizes, caches and "
      "the growing number of rounds steepen large ones. The interval is of the straight line "
      "through the medians, not of another machine.",
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
