#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
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
  // Frames that each of these has a row of; what has no row at all in the scene is not asked.
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
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty()) continue;
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const MovingRows& rows) { return rows.scene == row.point.scene; });
    if (at == out.end()) {
      out.push_back({.scene = row.point.scene, .frames = {}, .of = {}});
      at = out.end() - 1;
    }
    at->frames.insert(row.point.frame);
    at->of[method_label(row.point)][row.point.frame] = &row;
  }
  return out;
}

// Frame by frame how many times more `name` I-COLLIDE leaves than `what` of the method; of frames
// in which the method keeps something.
std::vector<double> factors(const MovingRows& rows, const std::string& method, const char* name,
                            const char* what) {
  std::vector<double> out;
  for (const long frame : rows.frames) {
    const auto boxes = rows.count(kBoxes, frame, name), kept = rows.count(method, frame, what);
    if (boxes && kept && *kept > 0) out.push_back(*boxes / *kept);
  }
  return out;
}

std::string spread(const std::vector<double>& values) {
  if (values.empty()) return "-";
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{} ({} to {})", rounded(median(values)), rounded(*least), rounded(*most));
}

Series over_frames(const MovingRows& rows, const std::string& name, const std::string& method,
                   const char* count, bool emphasis) {
  Series out{.name = name, .x = {}, .y = {}};
  out.emphasis = emphasis;
  for (const long frame : rows.frames) {
    out.x.push_back(static_cast<double>(frame));
    out.y.push_back(rows.count(method, frame, count).value_or(kNone));
  }
  return out;
}

Axis frames_axis(const std::vector<MovingRows>& scenes) {
  Axis out;
  out.label = "frame";
  out.from = 0;
  out.to = 1;
  for (const MovingRows& rows : scenes)
    out.to = std::max(*out.to, static_cast<double>(*rows.frames.rbegin()));
  return out;
}

Figure kept_figure(const std::vector<MovingRows>& scenes) {
  Figure out{.name = "efficiency",
             .title = "Triangles that are left to exact tests, frame by frame",
             .caption = {},
             .panels = {}};
  for (const MovingRows& rows : scenes) {
    Panel panel{.title = rows.scene,
                .x = frames_axis(scenes),
                .y = {.label = "triangles", .logarithmic = true, .shows_zero = true},
                .series = {}};
    panel.series.push_back(
        over_frames(rows, "I-COLLIDE, objects", kBoxes, "object_triangles", false));
    panel.series.push_back(
        over_frames(rows, "I-COLLIDE, triangles", kBoxes, "kept_triangles", false));
    for (const char* method : {"FAR (OBB)", "FAR (exact)", "FAR pairs"}) {
      if (rows.of.contains(method)) {
        panel.series.push_back(over_frames(rows, method, method, "kept_triangles",
                                           std::string(method) != "FAR pairs"));
      }
    }
    panel.series.push_back(
        over_frames(rows, "colliding triangles", kBoxes, "colliding_triangles", false));
    panel.series.back().style = Series::Style::lines;
    out.panels.push_back(std::move(panel));
  }
  out.caption =
      "I-COLLIDE as published ends with the objects whose boxes meet (all their triangles), ours "
      "goes on to boxes of triangles. FAR is drawn with both offsets. No method can leave fewer "
      "than the triangles that collide.";
  return out;
}

Figure quick_figure(const std::vector<MovingRows>& scenes) {
  Figure out{.name = "efficiency-quick",
             .title = "What Quick-CULLIDE asks and draws over what CULLIDE does, frame by frame",
             .caption = {},
             .panels = {}};
  for (const char* what : {"queries", "draws"}) {
    Panel panel;
    panel.title = what;
    panel.x = frames_axis(scenes);
    panel.y.label = "Quick-CULLIDE / CULLIDE";
    panel.y.from = 0;
    panel.marks.push_back({.vertical = false, .at = 1, .name = "as many"});
    for (const MovingRows& rows : scenes) {
      if (!rows.of.contains(kQuick)) continue;
      Series series{.name = rows.scene, .x = {}, .y = {}};
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
      "so "
      "they do not have the same answer.";
  return out;
}

DataTable factor_table(const std::vector<MovingRows>& scenes) {
  DataTable out{.name = "efficiency-factors",
                .caption =
                    "How many times more I-COLLIDE leaves than FAR: triangles of the objects "
                    "whose boxes meet, triangles whose boxes meet, and pairs of them; median "
                    "(least to largest) of the frames in which FAR keeps something",
                .columns = {"scene", "offset", "frames", "objects", "triangles", "pairs"},
                .alignment = "llrrrr",
                .rows = {}};
  for (const MovingRows& rows : scenes) {
    for (const char* method : {"FAR (OBB)", "FAR (exact)"}) {
      if (!rows.of.contains(method)) continue;
      const auto objects = factors(rows, method, "object_triangles", "kept_triangles");
      out.rows.push_back({rows.scene, std::string(method) == "FAR (OBB)" ? "OBB" : "exact",
                          grouped(objects.size()), spread(objects),
                          spread(factors(rows, method, "kept_triangles", "kept_triangles")),
                          spread(factors(rows, method, "candidates", "candidates"))});
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
  DataTable out{.name = "efficiency-quick",
                .caption =
                    "Quick-CULLIDE against CULLIDE, summed over the frames that all of them have: "
                    "queries and draws as a part of CULLIDE's, and the colliding pairs that each "
                    "misses",
                .columns = {"scene", "frames", "queries", "draws", "colliding", "CULLIDE misses",
                            "Quick-CULLIDE misses", "FAR misses"},
                .alignment = "lrrrrrrr",
                .rows = {}};
  for (const MovingRows& rows : scenes) {
    if (!rows.of.contains(kQuick)) continue;
    const std::set<long> over = rows.common({kQuick, kPlain, kBoxes, "FAR (OBB)", "FAR (exact)"});
    const auto sum = [&](const char* method, const char* name) {
      return rows.sum(method, name, over);
    };
    const auto obb = sum("FAR (OBB)", "missed"), exact = sum("FAR (exact)", "missed");
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
  const std::vector<std::string> methods = {"FAR (OBB)", "FAR (exact)", kPlain,
                                            kQuick,      "FAR pairs",   kBoxes};
  DataTable out{.name = "efficiency-times",
                .caption =
                    "Milliseconds from moved vertices to exact pairs, median of the frames that "
                    "all methods of the scene have",
                .columns = {"scene", "triangles", "frames"},
                .alignment = "lrr",
                .rows = {}};
  for (const std::string& method : methods) {
    out.columns.push_back(method);
    out.alignment += 'r';
  }
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
      cells.push_back(times.empty() ? "-" : rounded(median(times)));
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
       {std::pair{"FAR (OBB)", "boxes"}, std::pair{"FAR (exact)", "exact offsets"}}) {
    const auto objects = medians(scenes, method, "object_triangles");
    const auto triangles = medians(scenes, method, "kept_triangles");
    if (objects.empty() || triangles.empty()) continue;
    const auto fewer = std::count_if(triangles.begin(), triangles.end(),
                                     [](const auto& factor) { return factor.first > 1; });
    chapter.findings.push_back(fmt::format(
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
  chapter.findings.push_back(
      fmt::format("Over all frames Quick-CULLIDE asks {} and draws {} times as often as CULLIDE.",
                  rounded(queries[0] / queries[1]), rounded(draws[0] / draws[1])));
}

void add_missed_finding(const StoredStudy& stored, Chapter& chapter) {
  std::map<std::string, std::pair<double, double>> of;  // missed, colliding
  for (const Row& row : stored.rows) {
    const auto missed = count_of(row, "missed"), colliding = count_of(row, "colliding");
    if (!missed || !colliding) continue;
    of[method_label(row.point)].first += *missed;
    of[method_label(row.point)].second += *colliding;
  }
  std::vector<std::string> parts;
  for (const char* method : {"FAR (OBB)", "FAR (exact)", "FAR pairs", kBoxes, kPlain, kQuick}) {
    if (const auto at = of.find(method); at != of.end()) {
      parts.push_back(fmt::format("{} {} of {}", method,
                                  grouped(static_cast<std::uint64_t>(at->second.first)),
                                  grouped(static_cast<std::uint64_t>(at->second.second))));
    }
  }
  if (!parts.empty()) {
    chapter.findings.push_back("Colliding pairs missed in all frames: " + listed(parts) + ".");
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
      "FAR and CULLIDE do not test objects against themselves, so scenes that need that are "
      "measured by I-COLLIDE and FAR pairs alone.",
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
