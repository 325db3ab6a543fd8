// The chapter of the study "efficiency": frame by frame, the triangles that FAR and I-COLLIDE leave
// to exact tests, and the work of Quick-CULLIDE beside that of CULLIDE.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr const char* kObb = "FAR (OBB)";
constexpr const char* kExact = "FAR (exact)";
constexpr const char* kBoxes = "I-COLLIDE";
constexpr const char* kPlain = "CULLIDE";
constexpr const char* kQuick = "Quick-CULLIDE";

// The rows of a scene by method and frame.
struct MovingRows {
  std::string scene;
  std::set<long> frames;
  std::map<std::string, std::map<long, const Row*>> of;

  std::optional<double> count(const std::string& method, long frame, const char* name) const {
    const auto rows = of.find(method);
    if (rows == of.end()) return {};
    const auto row = rows->second.find(frame);
    return row == rows->second.end() ? std::nullopt : count_of(*row->second, name);
  }
  // Frames of which each of these methods has a row. Methods without any row of the scene do not
  // count.
  std::set<long> common(const std::vector<std::string>& methods) const {
    std::set<long> out = frames;
    for (const std::string& method : methods) {
      const auto rows = of.find(method);
      if (rows == of.end()) continue;
      std::erase_if(out, [&](long frame) { return !rows->second.contains(frame); });
    }
    return out;
  }
  // Over these frames; empty where there is none.
  std::optional<double> sum(const std::string& method, const char* name,
                            const std::set<long>& over) const {
    std::optional<double> out;
    for (const long frame : over) {
      if (const auto value = count(method, frame, name)) out = out.value_or(0) + *value;
    }
    return out;
  }
};

std::vector<MovingRows> by_scene(const StoredStudy& stored) {
  std::vector<MovingRows> out;
  for (const NamedRows& scene : rows_by_scene(stored)) {
    MovingRows& moving = out.emplace_back(MovingRows{.scene = scene.name, .frames = {}, .of = {}});
    for (const Row* row : scene.rows) {
      moving.frames.insert(row->point.frame);
      moving.of[method_label(row->point)][row->point.frame] = row;
    }
  }
  return out;
}

// Of each frame in which the method keeps something: count `name` of I-COLLIDE over count `what` of
// the method.
std::vector<double> factors(const MovingRows& rows, const std::string& method, const char* name,
                            const char* what) {
  std::vector<double> out;
  for (const long frame : rows.frames) {
    const auto boxes = rows.count(kBoxes, frame, name), kept = rows.count(method, frame, what);
    if (boxes && kept && *kept > 0) out.push_back(*boxes / *kept);
  }
  return out;
}

Series over_frames(const MovingRows& rows, const std::string& name, const std::string& method,
                   const char* count) {
  Series out{.name = name};
  for (const long frame : rows.frames) {
    out.x.push_back(static_cast<double>(frame));
    out.y.push_back(rows.count(method, frame, count).value_or(kNone));
  }
  return out;
}

// "n = 12 frames of each scene, each run once".
std::string frames_text(const std::vector<MovingRows>& scenes) {
  std::set<std::size_t> counts;
  for (const MovingRows& rows : scenes) counts.insert(rows.frames.size());
  if (counts.empty()) return "n = 0";
  return fmt::format("n = {}{} of each scene, each run once",
                     counts.size() == 1 ? "" : fmt::format("{} to ", *counts.begin()),
                     counted(*counts.rbegin(), "frame", "frames"));
}

Axis frames_axis(const std::vector<MovingRows>& scenes) {
  Axis out{.label = "frame", .from = 0, .to = 1};
  for (const MovingRows& rows : scenes)
    out.to = std::max(*out.to, static_cast<double>(*rows.frames.rbegin()));
  return out;
}

Figure kept_figure(const std::vector<MovingRows>& scenes) {
  Figure out{.name = "efficiency",
             .title = "Triangles that are left to exact tests, frame by frame"};
  for (const MovingRows& rows : scenes) {
    Panel panel{.title = rows.scene, .x = frames_axis(scenes), .y = logarithmic("triangles", true)};
    panel.series = {over_frames(rows, "I-COLLIDE, objects", kBoxes, "object_triangles"),
                    over_frames(rows, "I-COLLIDE, triangles", kBoxes, "kept_triangles")};
    for (const std::string method : {kObb, kExact, "FAR pairs"}) {
      if (!rows.of.contains(method)) continue;
      panel.series.push_back(over_frames(rows, method, method, "kept_triangles"));
      panel.series.back().emphasis = method != "FAR pairs";
    }
    panel.series.push_back(over_frames(rows, "colliding triangles", kBoxes, "colliding_triangles"));
    panel.series.back().style = Series::Style::lines;
    out.panels.push_back(std::move(panel));
  }
  out.caption =
      "I-COLLIDE as published ends with the objects whose boxes meet (all their triangles), ours "
      "goes on to boxes of triangles. FAR is drawn with both offsets. No method can leave fewer "
      "than the triangles that collide. " +
      frames_text(scenes) + ".";
  return out;
}

Figure quick_figure(const std::vector<MovingRows>& scenes) {
  Figure out{.name = "efficiency-quick",
             .title = "What Quick-CULLIDE asks and draws over what CULLIDE does, frame by frame"};
  for (const char* what : {"queries", "draws"}) {
    Panel panel{.title = what,
                .x = frames_axis(scenes),
                .y = {.label = "Quick-CULLIDE / CULLIDE", .from = 0},
                .marks = {{.vertical = false, .at = 1, .name = "as many"}}};
    for (const MovingRows& rows : scenes) {
      if (!rows.of.contains(kQuick)) continue;
      Series series{.name = rows.scene};
      for (const long frame : rows.frames) {
        const auto quick = rows.count(kQuick, frame, what), plain = rows.count(kPlain, frame, what);
        series.x.push_back(static_cast<double>(frame));
        series.y.push_back(quick && plain && *plain > 0 ? *quick / *plain : kNone);
      }
      panel.series.push_back(std::move(series));
    }
    out.panels.push_back(std::move(panel));
  }
  out.caption =
      "Each runs until a round changes nothing. Below 1 Quick-CULLIDE does less. Both miss pairs, "
      "so they do not have the same answer. " +
      frames_text(scenes) + ".";
  return out;
}

std::string median_text(const std::vector<double>& values) {
  return estimate_text(median_estimate(values));
}

DataTable factor_table(const std::vector<MovingRows>& scenes) {
  DataTable out{
      .name = "efficiency-factors",
      .caption =
          "How many times more I-COLLIDE leaves than FAR: triangles of the objects "
          "whose boxes meet, triangles whose boxes meet, and pairs of them; median of the frames "
          "in which FAR keeps something, with its 95 % interval over these frames",
      .columns = columns({"scene", "offset"}, {"frames", "objects", "triangles", "pairs"})};
  for (const MovingRows& rows : scenes) {
    for (const std::string method : {kObb, kExact}) {
      if (!rows.of.contains(method)) continue;
      const auto objects = factors(rows, method, "object_triangles", "kept_triangles");
      out.rows.push_back({rows.scene, method == kObb ? "OBB" : "exact", grouped(objects.size()),
                          median_text(objects),
                          median_text(factors(rows, method, "kept_triangles", "kept_triangles")),
                          median_text(factors(rows, method, "candidates", "candidates"))});
    }
  }
  return out;
}

std::string ratio_text(std::optional<double> a, std::optional<double> b) {
  return a && b && *b > 0 ? rounded(*a / *b) : "-";
}

std::string count_text(std::optional<double> value) {
  return value ? grouped(static_cast<std::uint64_t>(*value)) : "-";
}

DataTable quick_table(const std::vector<MovingRows>& scenes) {
  DataTable out{
      .name = "efficiency-quick",
      .caption =
          "Quick-CULLIDE against CULLIDE, summed over the frames that all of them have: "
          "queries and draws as a part of CULLIDE's, and the colliding pairs that each "
          "misses",
      .columns = columns({"scene"}, {"frames", "queries", "draws", "colliding", "CULLIDE misses",
                                     "Quick-CULLIDE misses", "FAR misses"})};
  for (const MovingRows& rows : scenes) {
    if (!rows.of.contains(kQuick)) continue;
    const std::set<long> over = rows.common({kQuick, kPlain, kBoxes, kObb, kExact});
    const auto sum = [&](const char* method, const char* name) {
      return rows.sum(method, name, over);
    };
    const auto obb = sum(kObb, "missed"), exact = sum(kExact, "missed");
    std::optional<double> far = obb ? obb : exact;
    if (obb && exact) far = *obb + *exact;
    out.rows.push_back({rows.scene, grouped(over.size()),
                        ratio_text(sum(kQuick, "queries"), sum(kPlain, "queries")),
                        ratio_text(sum(kQuick, "draws"), sum(kPlain, "draws")),
                        count_text(sum(kBoxes, "colliding")), count_text(sum(kPlain, "missed")),
                        count_text(sum(kQuick, "missed")), count_text(far)});
  }
  return out;
}

DataTable time_table(const std::vector<MovingRows>& scenes) {
  const std::vector<std::string> methods = {kObb, kExact, kPlain, kQuick, "FAR pairs", kBoxes};
  DataTable out{.name = "efficiency-times",
                .caption =
                    "Time in ms from moved vertices to exact pairs: median of the frames that all "
                    "methods of the scene have, with its 95 % interval over these frames, each run "
                    "once",
                .columns = columns({"scene"}, {"triangles", "frames"})};
  for (const std::string& method : methods) out.columns.push_back({method});
  for (const MovingRows& rows : scenes) {
    const std::set<long> over = rows.common(methods);
    std::vector<std::string> cells = {
        rows.scene, count_text(rows.count(kBoxes, *rows.frames.begin(), "triangles")),
        grouped(over.size())};
    for (const std::string& method : methods) {
      std::vector<double> times;
      if (const auto at = rows.of.find(method); at != rows.of.end()) {
        for (const auto& [frame, row] : at->second) {
          if (!over.contains(frame)) continue;
          if (const auto ms = time_of(*row, "total")) times.push_back(*ms);
        }
      }
      cells.push_back(median_text(times));
    }
    out.rows.push_back(std::move(cells));
  }
  return out;
}

// The median factor of each scene, ascending.
std::vector<std::pair<double, std::string>> medians(const std::vector<MovingRows>& scenes,
                                                    const char* method, const char* name) {
  std::vector<std::pair<double, std::string>> out;
  for (const MovingRows& rows : scenes) {
    const auto values = factors(rows, method, name, "kept_triangles");
    if (!values.empty()) out.emplace_back(median(values), rows.scene);
  }
  std::sort(out.begin(), out.end());
  return out;
}

void add_factor_findings(const std::vector<MovingRows>& scenes, Chapter& chapter) {
  for (const auto& [method, offset] :
       {std::pair{kObb, "boxes"}, std::pair{kExact, "exact offsets"}}) {
    const auto objects = medians(scenes, method, "object_triangles");
    const auto triangles = medians(scenes, method, "kept_triangles");
    if (objects.empty() || triangles.empty()) continue;
    const auto fewer = std::count_if(triangles.begin(), triangles.end(),
                                     [](const auto& factor) { return factor.first > 1; });
    chapter.find(fmt::format(
        "FAR with {} leaves {} ({}) to {} ({}) times fewer triangles than the objects of I-COLLIDE "
        "have, by medians over the frames; against boxes of triangles the factor is {} ({}) to {} "
        "({}), above 1 in {} of {} scenes.",
        offset, rounded(objects.front().first), objects.front().second,
        rounded(objects.back().first), objects.back().second, rounded(triangles.front().first),
        triangles.front().second, rounded(triangles.back().first), triangles.back().second, fewer,
        triangles.size()));
  }
}

void add_quick_finding(const std::vector<MovingRows>& scenes, Chapter& chapter) {
  double queries[2] = {0, 0}, draws[2] = {0, 0};
  for (const MovingRows& rows : scenes) {
    for (const long frame : rows.frames) {
      const auto a = rows.count(kQuick, frame, "queries"), b = rows.count(kPlain, frame, "queries");
      const auto c = rows.count(kQuick, frame, "draws"), d = rows.count(kPlain, frame, "draws");
      if (!a || !b || !c || !d) continue;
      queries[0] += *a;
      queries[1] += *b;
      draws[0] += *c;
      draws[1] += *d;
    }
  }
  if (queries[1] <= 0 || draws[1] <= 0) return;
  chapter.find(
      fmt::format("Over all frames Quick-CULLIDE asks {} and draws {} times as often as CULLIDE.",
                  rounded(queries[0] / queries[1]), rounded(draws[0] / draws[1])));
}

void add_missed_finding(const StoredStudy& stored, Chapter& chapter) {
  Rows verified;
  for (const Row& row : stored.rows) {
    if (count_of(row, "missed") && count_of(row, "colliding")) verified.push_back(&row);
  }
  const auto of = rows_by(verified, [](const Row& row) { return method_label(row.point); });
  std::vector<std::string> parts;
  for (const char* method : {kObb, kExact, "FAR pairs", kBoxes, kPlain, kQuick}) {
    if (const auto at = of.find(method); at != of.end())
      parts.push_back(
          fmt::format("{} {}", method,
                      with_bound(total(at->second, "missed"), total(at->second, "colliding"))));
  }
  if (!parts.empty()) {
    chapter.find("Colliding pairs missed in all frames (bounds at 95 %, 3/N): " + listed(parts) +
                 ".");
  }
}

}  // namespace

Chapter efficiency_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  add_promises(stored, out);
  const std::vector<MovingRows> scenes = by_scene(stored);
  add_factor_findings(scenes, out);
  add_missed_finding(stored, out);
  add_quick_finding(scenes, out);
  out.limits = {
      "Scenes are far smaller than in the papers, so that a software device can draw them; "
      "`farcull experiment family` takes any size.",
      "Factors depend on resolution: at a lower one FAR fattens more and keeps more.",
      "FAR and CULLIDE are measured between objects; scenes with objects that are tested against "
      "themselves are measured by I-COLLIDE and FAR pairs alone.",
      "Boxes of triangles are our addition to I-COLLIDE; as published it ends with objects.",
      "On a software device the times of methods that draw say nothing about graphics hardware; "
      "queries and draws carry over."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = {kept_figure(scenes), quick_figure(scenes)};
  out.tables = {factor_table(scenes), quick_table(scenes), time_table(scenes)};
  return out;
}

}  // namespace farcull
