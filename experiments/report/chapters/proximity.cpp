// The chapter of the study "proximity": sizes of potential neighbour sets, what a grid loses of
// them, both over frames, time against the number of objects, and errors of distances.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/proximity_rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using namespace proximity;

// ---- promises ----

// A row that promises and did not keep it, in words; empty: it kept it.
std::string broken_text(const Row& row) {
  if (!promises(row)) return "";
  if (!of_sets(row)) {
    const std::uint64_t wrong = number_of(row, "wrong");
    return wrong == 0
               ? ""
               : of_all(wrong, number_of(row, "asked")) + " distances are not the nearest double";
  }
  const std::uint64_t missed = number_of(row, "missed"), pairs = number_of(row, "missed_pairs");
  if (missed == 0 && pairs == 0) return "";
  return fmt::format("{} objects lose their nearest neighbour, and {} nearest pairs of triangles",
                     of_all(missed, number_of(row, "with_nearest")),
                     of_all(pairs, number_of(row, "nearest_pairs")));
}

void add_kept_promises(const StoredStudy& stored, Chapter& chapter) {
  Rows sets, distances;
  std::uint64_t silent = 0;
  bool broken = false;
  for (const Row* row : measured(stored)) {
    if (!promises(*row)) continue;
    if (!count_of(*row, of_sets(*row) ? "missed" : "wrong")) {
      ++silent;
      continue;
    }
    (of_sets(*row) ? sets : distances).push_back(row);
    const std::string text = broken_text(*row);
    if (text.empty()) continue;
    broken = true;
    chapter.find_broken(describe(row->point) + ": " + text + ", which it promises not to do.");
  }
  if (silent > 0)
    chapter.find(fmt::format("{} of methods that promise {} not say what they lost.",
                             silent == 1 ? "One row" : grouped(silent) + " rows",
                             silent == 1 ? "does" : "do"));
  if (broken) return;
  if (!sets.empty()) {
    std::vector<std::string> names;
    for (const auto& [name, rows] :
         rows_by(sets, [](const Row& row) { return name_of(row.point); }))
      names.push_back(name);
    chapter.find(fmt::format(
        "{} lost {} nearest neighbours of objects, and {} nearest pairs of triangles, in {}.",
        listed(names), rate_text(0, total(sets, "with_nearest")),
        rate_text(0, total(sets, "nearest_pairs")), counted(sets.size(), "run", "runs")));
  }
  if (!distances.empty())
    chapter.find(fmt::format("Of the distances of farcull {} were not the nearest double.",
                             rate_text(0, total(distances, "asked"))));
}

// ---- what is lost ----

std::set<long> resolutions_of(const std::vector<SetScene>& scenes) {
  std::set<long> out;
  for (const SetScene& scene : scenes) {
    for (const auto& [method, rows] : scene.of) {
      for (const auto& [cells, sums] : rows) {
        if (cells > 0) out.insert(cells);
      }
    }
  }
  return out;
}

// Whether a method without a promise lost something.
bool loses(const SetScene& scene) {
  for (const auto& [method, rows] : scene.of) {
    for (const auto& [at, sums] : rows) {
      if (sums.missed > 0) return true;
    }
  }
  return false;
}

// "n = 202 objects", of each panel where they differ.
std::string objects_text(const std::vector<SetScene>& scenes) {
  std::vector<std::string> parts;
  for (const SetScene& scene : scenes) {
    std::uint64_t most = 0;
    for (const auto& [method, rows] : scene.of) {
      for (const auto& [at, sums] : rows) most = std::max(most, sums.objects);
    }
    parts.push_back(fmt::format("{} ({}{})", scene.name, counted(most, "object", "objects"),
                                scene.seeds > 1 ? fmt::format(", {} seeds", scene.seeds) : ""));
  }
  return "n: " + listed(parts);
}

Series lost_series(const SetScene& scene, const std::string& method) {
  Series out{.name = method};
  const auto rows = scene.of.find(method);
  if (rows == scene.of.end()) return out;
  for (const auto& [cells, sums] : rows->second) {
    if (sums.objects == 0) continue;
    const Rate rate = rate_of(std::min(sums.missed, sums.objects), sums.objects);
    out.x.push_back(static_cast<double>(cells));
    out.y.push_back(100 * rate.value);
    out.y_low.push_back(100 * rate.low);
    out.y_high.push_back(100 * rate.high);
  }
  return out;
}

Figure lost_figure(const std::vector<SetScene>& scenes) {
  Figure out{.name = "proximity-lost",
             .title = "Objects that lose their nearest neighbour, against the resolution"};
  std::vector<SetScene> drawn;
  for (const SetScene& scene : scenes) {
    if (!loses(scene)) continue;
    drawn.push_back(scene);
    Panel panel{.title = scene.name,
                .x = logarithmic("cells along the scene"),
                .y = {.label = "lost (% of objects)", .from = 0}};
    for (const char* method : {kPublished, kReliable, kNarrow}) {
      Series series = lost_series(scene, method);
      series.emphasis = method == std::string(kReliable);
      if (!series.x.empty()) panel.series.push_back(std::move(series));
    }
    if (!panel.series.empty()) out.panels.push_back(std::move(panel));
  }
  if (out.panels.empty()) return out;
  out.caption =
      "An object is lost if none of its nearest neighbours is in its set. Bars are 95 % intervals "
      "of the share, were the objects independent. clusters:R has clusters whose sides are 1/R of "
      "that of the scene. Not widened: the reliable form without the half diagonal of a cell that "
      "its proof asks for. Scenes of which nothing is lost are in the table. " +
      objects_text(drawn) + ".";
  return out;
}

DataTable lost_table(const std::vector<SetScene>& scenes) {
  DataTable out{.name = "proximity-lost",
                .caption =
                    "Objects that lose their nearest neighbour, at each resolution in cells along "
                    "the scene; \"-\" where the diagram was left out or not asked for",
                .columns = columns({"scene", "method"}, {"objects"})};
  const std::set<long> resolutions = resolutions_of(scenes);
  for (const long cells : resolutions) out.columns.push_back({std::to_string(cells)});
  for (const SetScene& scene : scenes) {
    for (const char* method : {kPublished, kReliable, kNarrow}) {
      const auto rows = scene.of.find(method);
      if (rows == scene.of.end()) continue;
      std::vector<std::string> cells = {scene.name, method,
                                        grouped(rows->second.begin()->second.objects)};
      for (const long resolution : resolutions) {
        const SetSums* const sums = scene.find(method, resolution);
        cells.push_back(sums == nullptr ? "-" : grouped(sums->missed));
      }
      out.rows.push_back(std::move(cells));
    }
  }
  return out;
}

void add_lost_finding(const std::vector<SetScene>& scenes, Chapter& chapter) {
  for (const char* method : {kPublished, kNarrow}) {
    std::vector<std::string> parts;
    for (const long cells : resolutions_of(scenes)) {
      std::uint64_t missed = 0, objects = 0;
      for (const SetScene& scene : scenes) {
        const SetSums* const sums = scene.find(method, cells);
        if (sums == nullptr) continue;
        missed += sums->missed;
        objects += sums->objects;
      }
      if (objects > 0)
        parts.push_back(fmt::format("{} at {} cells", of_all(missed, objects), cells));
    }
    if (!parts.empty())
      chapter.find(fmt::format("{}, lost of all objects: {}.", method, listed(parts)));
  }
}

// ---- sizes ----

using SizeOf = double (SetSums::*)() const;

Figure size_figure(const std::vector<SetScene>& scenes, const char* name, const char* title,
                   const char* axis, SizeOf size) {
  Figure out{.name = name, .title = title};
  for (const SetScene& scene : scenes) {
    Panel panel{.title = scene.name,
                .x = logarithmic("cells along the scene"),
                .y = logarithmic(axis, true)};
    for (const char* method : {kPublished, kReliable}) {
      const auto rows = scene.of.find(method);
      if (rows == scene.of.end()) continue;
      Series series{.name = method};
      series.emphasis = method == std::string(kReliable);
      for (const auto& [cells, sums] : rows->second) {
        series.x.push_back(static_cast<double>(cells));
        series.y.push_back((sums.*size)());
      }
      panel.series.push_back(std::move(series));
    }
    if (panel.series.empty()) continue;
    // Without cells: the same at each resolution.
    for (const char* method : {kBoxes, kTrees}) {
      const SetSums* const sums = scene.find(method, 0);
      if (sums == nullptr) continue;
      const std::vector<double>& x = panel.series.front().x;
      panel.series.push_back({.name = method,
                              .x = x,
                              .y = std::vector<double>(x.size(), (sums->*size)()),
                              .style = Series::Style::lines});
    }
    out.panels.push_back(std::move(panel));
  }
  if (!out.panels.empty())
    out.caption =
        "Mean over the objects that have a nearest neighbour. The published form and boxes take "
        "objects with all their triangles, or all those near enough; trees and the reliable form "
        "take triangles. The published form may be below what holds all nearest neighbours. " +
        objects_text(scenes) + ".";
  return out;
}

// How many times more triangles the boxes leave than the method; NaN where one is missing or 0.
double factor(const SetScene& scene, const std::string& method, long at_boxes, long at) {
  const SetSums* const boxes = scene.find(kBoxes, at_boxes);
  const SetSums* const kept = scene.find(method, at);
  return boxes == nullptr || kept == nullptr || kept->set_triangles == 0
             ? kNone
             : static_cast<double>(boxes->set_triangles) / static_cast<double>(kept->set_triangles);
}

DataTable efficiency_table(const std::vector<SetScene>& rest, const std::vector<SetScene>& moving) {
  const std::set<long> resolutions = resolutions_of(rest);
  const long finest = resolutions.empty() ? 0 : *resolutions.rbegin();
  DataTable out{.name = "proximity-efficiency",
                .caption = fmt::format(
                    "Culling efficiency: how many times more triangles the boxes of objects leave "
                    "in the sets. Of scenes at rest the diagrams have {} cells along the scene; of "
                    "scenes that move, the median over the frames with its 95 % interval over them",
                    finest),
                .columns = columns({"scene"}, {"frames", "triangles per object, boxes", kTrees,
                                               kReliable, kPublished})};
  for (const SetScene& scene : rest) {
    const SetSums* const boxes = scene.find(kBoxes, 0);
    out.rows.push_back({scene.name, "-", boxes == nullptr ? "-" : rounded(boxes->triangles_each()),
                        rounded(factor(scene, kTrees, 0, 0)),
                        rounded(factor(scene, kReliable, 0, finest)),
                        rounded(factor(scene, kPublished, 0, finest))});
  }
  for (const SetScene& scene : moving) {
    std::set<long> frames;
    std::vector<double> left;
    for (const auto& [method, rows] : scene.of) {
      for (const auto& [frame, sums] : rows) {
        frames.insert(frame);
        if (method == kBoxes) left.push_back(sums.triangles_each());
      }
    }
    std::vector<std::string> cells = {scene.name, grouped(frames.size()),
                                      estimate_text(median_estimate(left))};
    for (const char* method : {kTrees, kReliable, kPublished}) {
      std::vector<double> factors;
      for (const long frame : frames) {
        const double value = factor(scene, method, frame, frame);
        if (value > 0) factors.push_back(value);
      }
      cells.push_back(estimate_text(median_estimate(factors)));
    }
    out.rows.push_back(std::move(cells));
  }
  return out;
}

void add_size_finding(const std::vector<SetScene>& rest, Chapter& chapter) {
  std::vector<std::pair<double, std::string>> factors;
  for (const SetScene& scene : rest) {
    const double value = factor(scene, kTrees, 0, 0);
    if (value > 0) factors.emplace_back(value, scene.name);
  }
  if (factors.empty()) return;
  std::sort(factors.begin(), factors.end());
  chapter.find(fmt::format(
      "Boxes of objects leave {} ({}) to {} ({}) times more triangles per object than trees of "
      "boxes do.",
      rounded(factors.front().first), factors.front().second, rounded(factors.back().first),
      factors.back().second));
}

Figure frames_figure(const std::vector<SetScene>& scenes) {
  Figure out{.name = "proximity-frames", .title = "Triangles per set, frame by frame"};
  for (const SetScene& scene : scenes) {
    Panel panel{.title = scene.name,
                .x = {.label = "frame"},
                .y = logarithmic("triangles per object", true)};
    for (const char* method : {kBoxes, kPublished, kReliable, kTrees}) {
      const auto rows = scene.of.find(method);
      if (rows == scene.of.end()) continue;
      Series series{.name = method};
      series.emphasis = method == std::string(kReliable);
      for (const auto& [frame, sums] : rows->second) {
        series.x.push_back(static_cast<double>(frame));
        series.y.push_back(sums.triangles_each());
      }
      panel.series.push_back(std::move(series));
    }
    out.panels.push_back(std::move(panel));
  }
  if (!out.panels.empty())
    out.caption =
        "Mean over the objects that have a nearest neighbour in that frame; each frame is searched "
        "anew. " +
        objects_text(scenes) + ".";
  return out;
}

// ---- times ----

Figure count_figure(const StoredStudy& stored, DataTable& exponents, Chapter& chapter) {
  Figure out{.name = "proximity-objects", .title = "Time against the number of objects"};
  Rows drawn;
  for (const bool sets : {true, false}) {
    Panel panel{.title = sets ? "sets: crowd:N" : "distances to the nearest: crowd:N",
                .x = logarithmic("objects", true),
                .y = logarithmic("time (ms)")};
    std::vector<std::string> said;
    for (const NamedRows& line : rows_by_count(stored, sets)) {
      const auto objects = [](const Row& row) { return count_or_none(row, "objects"); };
      panel.series.push_back(times_of(line.name, line.rows, objects));
      Series& series = panel.series.back();
      series.emphasis = line.name == kTrees || line.name == "farcull";
      drawn.insert(drawn.end(), line.rows.begin(), line.rows.end());
      if (const auto e = exponent_of(series.x, series.y)) {
        exponents.rows.push_back({sets ? "sets" : "distances", line.name, rounded(e->from),
                                  rounded(e->to), grouped(e->points), exponent_text(*e)});
        said.push_back(line.name + " " + exponent_text(*e));
      }
    }
    if (!said.empty())
      chapter.find(fmt::format("Exponent of time over objects, {}, with its 95 % interval: {}.",
                               sets ? "of sets" : "of distances", listed(said)));
    if (!panel.series.empty()) out.panels.push_back(std::move(panel));
  }
  if (!out.panels.empty())
    out.caption =
        sample_text(drawn) +
        ", on one thread, with its 95 % interval as a bar. Objects stand at the same "
        "density. Distances are from the triangles to the distance of each object from its "
        "nearest one, trees included.";
  return out;
}

// ---- distances ----

Figure error_figure(const std::vector<NamedRows>& scenes) {
  Figure out{.name = "proximity-error", .title = "Errors of distances against time"};
  Rows drawn;
  for (const NamedRows& scene : scenes) {
    Panel panel{.title = scene.name,
                .x = logarithmic("time (ms)"),
                .y = logarithmic("largest relative error", true)};
    for (const NamedRows& of : rows_by_contestant(scene.rows)) {
      const Row& row = *of.rows.front();
      const Estimate ms = time_estimate(row).value_or(Estimate{kNone, kNone, kNone, 0});
      const bool bar = ms.n > 1;
      panel.series.push_back({.name = name_of(row.point),
                              .x = {ms.value},
                              .y = {count_or_none(row, "largest_relative")},
                              .style = Series::Style::points,
                              .emphasis = name_of(row.point) == "farcull",
                              .x_low = {bar ? ms.low : kNone},
                              .x_high = {bar ? ms.high : kNone}});
      drawn.push_back(&row);
    }
    if (!panel.series.empty()) out.panels.push_back(std::move(panel));
  }
  if (!out.panels.empty())
    out.caption =
        "The largest error of a distance over the exact distance, of those where neither is 0; "
        "those that are wrong in another way are in the table. " +
        sample_text(drawn) +
        " on one thread, from the triangles to the distances, with its 95 % "
        "interval as a bar.";
  return out;
}

DataTable distance_table(const std::vector<NamedRows>& scenes) {
  DataTable out{
      .name = "proximity-distances",
      .caption =
          "Distances asked for, those that are not the nearest double, and of these: lacking, 0 "
          "where objects are apart or the reverse, of another object that is not as near; the "
          "largest relative error of the others; time in ms as the median with its 95 % interval",
      .columns = columns(
          {"scene", "contestant"},
          {"asked", "off", "lacking", "other 0", "other object", "largest error", "time (ms)"},
          {"library"})};
  for (const NamedRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      const auto largest = count_of(*row, "largest_relative");
      out.rows.push_back(
          {scene.name, name_of(row->point), count_cell(*row, "asked"), count_cell(*row, "wrong"),
           count_cell(*row, "lacking"), count_cell(*row, "other_zero"),
           count_cell(*row, "other_object"), largest ? rounded(*largest, 2) : "-",
           estimate_text(time_estimate(*row).value_or(Estimate{})), text_of(*row, "library")});
    }
  }
  return out;
}

void add_distance_findings(const StoredStudy& stored, Chapter& chapter) {
  Rows rows = measured(stored);
  std::erase_if(rows, [](const Row* row) { return of_sets(*row) || promises(*row); });
  for (const auto& [name, of] : rows_by(rows, [](const Row& row) { return name_of(row.point); })) {
    const Row* const worst =
        *std::max_element(of.begin(), of.end(), [](const Row* a, const Row* b) {
          return count_of(*a, "largest_relative").value_or(0) <
                 count_of(*b, "largest_relative").value_or(0);
        });
    chapter.find(fmt::format(
        "{}: {} distances are not the nearest double; the largest relative "
        "error is {} ({}).",
        name, of_all(of, "wrong", "asked"),
        rounded(count_of(*worst, "largest_relative").value_or(0), 2), worst->point.scene));
  }
}

DataTable all_sets(const StoredStudy& stored) {
  Rows rows = measured(stored);
  std::erase_if(rows, [](const Row* row) { return !of_sets(*row); });
  return table_of_rows(
      "proximity-sets",
      "Every row of sets: sizes over the objects that have a nearest neighbour, and times on one "
      "thread",
      rows,
      {scene_column(),
       {text_column("method"), [](const Row& row) { return name_of(row.point); }},
       resolution_column("cells", "-"),
       {{"frame"},
        [](const Row& row) {
          return row.point.frame < 0 ? std::string("-") : std::to_string(row.point.frame);
        }},
       count_column("objects", "with_nearest"),
       count_column("lost", "missed"),
       count_column("nearest pairs", "nearest_pairs"),
       count_column("pairs lost", "missed_pairs"),
       count_column("pairs of objects", "object_pairs"),
       count_column("pairs of triangles", "triangle_pairs"),
       count_column("objects, median", "median_objects"),
       count_column("objects, most", "most_objects"),
       count_column("triangles, median", "median_triangles"),
       count_column("triangles, most", "most_triangles"),
       estimate_column("time (ms)")});
}

// What the distances of Embree are; nothing where it was not asked.
void add_limit_of_vertices(const std::vector<NamedRows>& scenes, Chapter& chapter) {
  const auto asked = [](const Row* row) { return name_of(row->point) == "embree-points"; };
  if (std::none_of(scenes.begin(), scenes.end(), [&](const NamedRows& scene) {
        return std::any_of(scene.rows.begin(), scene.rows.end(), asked);
      }))
    return;
  chapter.limits.push_back(
      "Embree has no query for the distance of two meshes. embree-points asks it from every vertex "
      "of each object for the nearest point of the other one. That bounds the distance from above, "
      "but for the rounding to floats: it is too large where the nearest points lie inside two "
      "edges, and above 0 where objects cross. So its time is no time of the same question.");
}

}  // namespace

Chapter proximity_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  add_kept_promises(stored, out);
  const std::vector<SetScene> rest = scenes_at_rest(stored), moving = scenes_in_motion(stored);
  const std::vector<NamedRows> distances = distances_by_scene(stored);
  add_lost_finding(rest, out);
  add_size_finding(rest, out);
  add_distance_findings(stored, out);
  out.limits = {
      "The code of the published diagram is not known: its form here is the one that "
      "docs/voronoi.md "
      "defines. It runs on one thread of the CPU, so that its times say nothing about graphics "
      "hardware.",
      "Objects of one scene are not independent, so that intervals of shares are the best that so "
      "many objects allow.",
      "Boxes of objects are those along the axes; other hulls would leave fewer triangles.",
      "Most of the time of a library is that of building its trees, which a program that asks "
      "again "
      "would build once."};
  add_limit_of_vertices(distances, out);
  add_gaps(stored, out);
  DataTable exponents{
      .name = "proximity-exponents",
      .caption = fmt::format("Exponent b of time = a x^b over the number of objects x, by least "
                             "squares in logarithms, with its 95 % interval (Student's t of the "
                             "residuals; not given for fewer than {} points)",
                             kFewestForInterval),
      .columns = columns({"of", "method"}, {"from", "to", "points", "exponent"})};
  Figure counts = count_figure(stored, exponents, out);
  for (Figure& figure : std::vector<Figure>{
           lost_figure(rest),
           size_figure(rest, "proximity-triangles", "Triangles per set against the resolution",
                       "triangles per object", &SetSums::triangles_each),
           size_figure(rest, "proximity-set-objects", "Objects per set against the resolution",
                       "objects per object", &SetSums::objects_each),
           frames_figure(moving), std::move(counts), error_figure(distances)}) {
    if (!figure.panels.empty()) out.figures.push_back(std::move(figure));
  }
  for (DataTable& table :
       std::vector<DataTable>{lost_table(rest), efficiency_table(rest, moving),
                              std::move(exponents), distance_table(distances), all_sets(stored)}) {
    if (!table.rows.empty()) out.tables.push_back(std::move(table));
  }
  return out;
}

}  // namespace farcull
