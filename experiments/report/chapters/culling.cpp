// The chapter of the study "culling": candidates for each colliding pair, by scene.
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

constexpr const char* kBoxes = "boxes";
constexpr const char* kOriented = "oriented boxes (FCL)";
constexpr const char* kChosen = "FAR pairs, own choice";
constexpr const char* kOneView = "FAR pairs, 1 view";
constexpr const char* kThreeViews = "FAR pairs, 3 views";
// From this share of the pairs of boxes on, a method is little more than a join of boxes.
constexpr double kMostBoxes = 90;  // per cent

std::string name_of(const Row& row) {
  const PointKey& point = row.point;
  if (point.method == "cgal-boxes") return kBoxes;
  if (point.method == "fcl-obb") return kOriented;
  if (point.views.empty()) return kChosen;
  return point.views.find(',') == std::string::npos ? kOneView : kThreeViews;
}

// Without neighbours, which libraries leave out.
std::uint64_t candidates_of(const Row& row) {
  return number_of(row, "candidates") - number_of(row, "neighbour_candidates");
}
std::uint64_t colliding_of(const Row& row) {
  return number_of(row, "colliding") - number_of(row, "neighbours");
}
double per_pair(const Row& row) {
  const std::uint64_t colliding = colliding_of(row);
  return colliding == 0 ? kNone
                        : static_cast<double>(candidates_of(row)) / static_cast<double>(colliding);
}

// The rows of a scene, those of a way to cull by resolution; 0: it has none.
struct SceneRows {
  std::string scene;
  std::map<std::string, std::map<int, const Row*>> by_name;

  // Null where nothing was measured.
  const Row* find(const std::string& name, int resolution) const {
    const auto of = by_name.find(name);
    if (of == by_name.end()) return nullptr;
    const auto at = of->second.find(resolution);
    return at == of->second.end() ? nullptr : at->second;
  }
  // At the resolution that leaves the fewest candidates, of equal ones the smallest.
  const Row* find(const std::string& name) const {
    const Row* out = nullptr;
    const auto of = by_name.find(name);
    if (of == by_name.end()) return out;
    for (const auto& [resolution, row] : of->second) {
      if (out == nullptr || candidates_of(*row) < candidates_of(*out)) out = row;
    }
    return out;
  }
};

std::vector<SceneRows> scenes_of(const StoredStudy& stored) {
  std::vector<SceneRows> out;
  for (const NamedRows& scene : rows_by_scene(stored)) {
    SceneRows& rows = out.emplace_back(SceneRows{scene.name, {}});
    for (const Row* row : scene.rows) rows.by_name[name_of(*row)][row->point.resolution] = row;
  }
  return out;
}

Figure figure_of(const std::vector<SceneRows>& scenes, const std::set<int>& resolutions) {
  Figure out{
      .name = "culling",
      .title = "Candidates for each pair that collides",
      .caption = fmt::format(
          "Pairs that are left to exact predicates, over the pairs that collide, on {} scenes; "
          "neighbours are in neither. 1 is the least there can be. Boxes, oriented boxes and "
          "what FAR pairs chooses by itself have no resolution, so they are level lines; where it "
          "leaves what boxes leave, its line lies on theirs. One run at each point.",
          scenes.size())};
  for (const SceneRows& scene : scenes) {
    Panel panel{.title = scene.scene,
                .x = logarithmic("resolution (px)"),
                .y = logarithmic("candidates / colliding")};
    for (const char* name : {kBoxes, kOriented, kChosen, kOneView, kThreeViews}) {
      // Boxes as well: what FAR pairs chooses often lies on their line.
      Series series{.name = name, .emphasis = name == kThreeViews || name == kBoxes};
      const Row* level = scene.find(name, 0);
      if (level != nullptr) series.style = Series::Style::lines;
      for (const int resolution : resolutions) {
        const Row* row = level != nullptr ? level : scene.find(name, resolution);
        if (row == nullptr) continue;
        series.x.push_back(resolution);
        series.y.push_back(per_pair(*row));
      }
      if (!series.x.empty()) panel.series.push_back(std::move(series));
    }
    out.panels.push_back(std::move(panel));
  }
  return out;
}

DataTable table_of(const std::vector<SceneRows>& scenes) {
  DataTable out{
      .name = "culling",
      .caption =
          "Pairs that collide, pairs whose boxes overlap, and candidates for each pair that "
          "collides: of boxes, of FCL's oriented boxes, and of FAR pairs by its own choice, in "
          "the view z and in the views x, y, z, each at the resolution that leaves the fewest",
      .columns = columns({"scene"}, {"colliding", "boxes overlap", "boxes", "oriented", "FAR pairs",
                                     "1 view", "at px", "3 views", "at px"})};
  for (const SceneRows& scene : scenes) {
    const Row *boxes = scene.find(kBoxes), *chosen = scene.find(kChosen);
    const Row* any = chosen != nullptr ? chosen : boxes;
    if (any == nullptr) continue;
    std::vector<std::string> cells = {scene.scene, grouped(colliding_of(*any)),
                                      boxes == nullptr ? "-" : grouped(candidates_of(*boxes))};
    for (const char* name : {kBoxes, kOriented, kChosen, kOneView, kThreeViews}) {
      const Row* row = scene.find(name);
      cells.push_back(row == nullptr ? "-" : rounded(per_pair(*row)));
      if (name == kOneView || name == kThreeViews)
        cells.push_back(row == nullptr ? "-" : std::to_string(row->point.resolution));
    }
    out.rows.push_back(std::move(cells));
  }
  return out;
}

DataTable all_table(const StoredStudy& stored) {
  const auto number = [](const char* name, std::uint64_t (*value)(const Row&)) {
    return RowColumn{{name}, [value](const Row& row) { return grouped(value(row)); }};
  };
  DataTable out = table_of_rows(
      "culling-all", "Every scene, way to cull and resolution, without neighbours",
      measured(stored),
      {scene_column(),
       {text_column("culled by"), [](const Row& row) { return name_of(row); }},
       resolution_column("px", "-"),
       number("colliding", colliding_of),
       number("candidates", candidates_of),
       {{"candidates/colliding"}, [](const Row& row) { return rounded(per_pair(row)); }},
       time_column("cull (ms)", "cull")});
  out.in_text = false;
  return out;
}

// Where FAR pairs by its own choice keeps nearly what boxes keep, and where it keeps less.
void add_choice(const std::vector<SceneRows>& scenes, Chapter& chapter) {
  std::vector<std::string> join, less;
  for (const SceneRows& scene : scenes) {
    const Row *boxes = scene.find(kBoxes), *chosen = scene.find(kChosen);
    if (boxes == nullptr || chosen == nullptr) continue;
    const std::uint64_t of = candidates_of(*boxes), kept = candidates_of(*chosen);
    (share(kept, of) >= kMostBoxes ? join : less)
        .push_back(fmt::format("{} ({})", scene.scene, of_all(kept, of)));
  }
  if (!join.empty()) {
    chapter.find(fmt::format(
        "By its own choice FAR pairs keeps at least {} % of the pairs of triangles whose boxes "
        "overlap on {}: there it is a fast join of boxes.",
        kMostBoxes, listed(join)));
  }
  if (!less.empty())
    chapter.find(fmt::format("By its own choice FAR pairs keeps fewer on {}.", listed(less)));
}

// What views add where they are asked for.
void add_views(const std::vector<SceneRows>& scenes, Chapter& chapter) {
  std::size_t better = 0, both = 0, worse = 0;
  const SceneRows *most = nullptr, *least = nullptr;
  const auto gain = [](const SceneRows& scene) {
    const Row *boxes = scene.find(kBoxes), *views = scene.find(kThreeViews);
    if (boxes == nullptr || views == nullptr || candidates_of(*views) == 0) return kNone;
    return static_cast<double>(candidates_of(*boxes)) / static_cast<double>(candidates_of(*views));
  };
  for (const SceneRows& scene : scenes) {
    const Row *oriented = scene.find(kOriented), *views = scene.find(kThreeViews);
    if (oriented != nullptr && views != nullptr) {
      ++both;
      better += candidates_of(*views) < candidates_of(*oriented);
    }
    if (views != nullptr) {
      const Row& largest = *scene.by_name.at(kThreeViews).rbegin()->second;
      worse += candidates_of(largest) > candidates_of(*views);
    }
    if (std::isnan(gain(scene))) continue;
    if (most == nullptr || gain(scene) > gain(*most)) most = &scene;
    if (least == nullptr || gain(scene) < gain(*least)) least = &scene;
  }
  const auto told = [](const SceneRows& scene) {
    const Row &boxes = *scene.find(kBoxes), &views = *scene.find(kThreeViews);
    return fmt::format(
        "{} candidates for each pair that collides on {} (at {} px), where boxes leave {}",
        rounded(per_pair(views)), scene.scene, views.point.resolution, rounded(per_pair(boxes)));
  };
  if (most != nullptr && most != least)
    chapter.find(fmt::format("Three views leave {}, and {}.", told(*most), told(*least)));
  if (both > 0) {
    chapter.find(fmt::format(
        "Three views at the best resolution leave fewer candidates than FCL's oriented boxes on {} "
        "of {} scenes.",
        better, both));
  }
  if (worse > 0) {
    chapter.find(
        fmt::format("More pixels do not always leave fewer: on {} of {} scenes three views "
                    "leave more at the largest resolution than at a smaller one.",
                    worse, scenes.size()));
  }
}

}  // namespace

Chapter culling_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const std::vector<SceneRows> scenes = scenes_of(stored);
  const std::set<int> resolutions = resolutions_in(measured(stored));
  add_promises(stored, out);
  add_choice(scenes, out);
  add_views(scenes, out);
  out.limits = {
      "Fewer candidates are not less time: where boxes leave few pairs for each that collides, "
      "exact predicates on all of them take less time than a view.",
      "FCL refuses degenerate triangles. Libraries leave out neighbours that share an index, FAR "
      "pairs "
      "those that share a position: where a mesh has a vertex twice, the libraries' candidates "
      "hold a "
      "few more.",
      "Inside an object FAR pairs leaves neighbours to the predicates as well. They are not "
      "counted "
      "here."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = {figure_of(scenes, resolutions)};
  out.tables = {table_of(scenes), all_table(stored)};
  return out;
}

}  // namespace farcull
