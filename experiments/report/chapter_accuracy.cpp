#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

// Only what was drawn at a declared resolution belongs to the curves.
std::set<int> resolutions_in(const SceneRows& scene) {
  std::set<int> out;
  for (const Row* row : scene.rows) {
    if (row->point.resolution > 0) out.insert(row->point.resolution);
  }
  return out;
}

const Row* find(const SceneRows& scene, const std::string& name, int resolution) {
  for (const Row* row : scene.rows) {
    if (row->point.resolution == resolution && contestant(row->point) == name) return row;
  }
  return nullptr;
}

Figure missed_figure(const std::vector<SceneRows>& scenes, const std::string& name,
                     const std::string& what, const char* missed, const char* colliding) {
  Figure out{.name = name,
             .title = "Missed colliding " + what + " against resolution",
             .caption = {},
             .panels = {}};
  std::vector<std::string> of;
  for (const SceneRows& scene : scenes) {
    const std::set<int> resolutions = resolutions_in(scene);
    if (resolutions.empty()) continue;
    Panel panel{.title = scene.scene,
                .x = {.label = "resolution (px)", .logarithmic = true},
                .y = {.label = "missed " + what, .logarithmic = true, .shows_zero = true},
                .series = {}};
    for (const std::string& method : contestants_in(scene.rows)) {
      Series series{.name = method, .x = {}, .y = {}};
      for (const int resolution : resolutions) {
        if (const Row* row = find(scene, method, resolution)) {
          series.x.push_back(resolution);
          series.y.push_back(
              count_of(*row, missed).value_or(std::numeric_limits<double>::quiet_NaN()));
        }
      }
      series.emphasis = method == "FAR (OBB)" || method == "FAR pairs";
      if (!series.x.empty()) panel.series.push_back(std::move(series));
    }
    of.push_back(
        fmt::format("{} {}", grouped(number_of(*scene.rows.front(), colliding)), scene.scene));
    out.panels.push_back(std::move(panel));
  }
  out.caption = fmt::format(
      "Colliding {} that are not found, of all: {}. The line below the powers is 0. What lies on "
      "it missed nothing.",
      what, listed(of));
  return out;
}

DataTable short_table(const std::vector<SceneRows>& scenes) {
  std::set<int> resolutions;
  for (const SceneRows& scene : scenes) resolutions.merge(resolutions_in(scene));
  DataTable out{.name = "accuracy",
                .caption = "Missed pairs by resolution in px",
                .columns = {"scene", "method", "colliding"},
                .alignment = "llr",
                .rows = {}};
  for (const int resolution : resolutions) {
    out.columns.push_back(std::to_string(resolution));
    out.alignment += 'r';
  }
  for (const SceneRows& scene : scenes) {
    for (const std::string& method : contestants_in(scene.rows)) {
      std::vector<std::string> cells = {scene.scene, method,
                                        count_cell(*scene.rows.front(), "colliding")};
      for (const int resolution : resolutions) {
        const Row* row = find(scene, method, resolution);
        cells.push_back(row == nullptr ? "-" : count_cell(*row, "missed"));
      }
      out.rows.push_back(std::move(cells));
    }
  }
  return out;
}

DataTable long_table(const std::vector<SceneRows>& scenes) {
  DataTable out{.name = "accuracy-all",
                .caption = "All points",
                .columns = {"scene", "method", "resolution", "radius px", "colliding pairs",
                            "missed pairs", "of them penetrating", "colliding triangles",
                            "missed triangles", "kept triangles", "candidates", "ms"},
                .alignment = "llrrrrrrrrrr",
                .rows = {},
                .in_text = false};
  for (const SceneRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      const auto radius = count_of(*row, "radius_px");
      out.rows.push_back(
          {scene.scene, contestant(row->point),
           row->point.resolution > 0 ? std::to_string(row->point.resolution) : "auto",
           radius ? rounded(*radius) : "-", count_cell(*row, "colliding"),
           count_cell(*row, "missed"), count_cell(*row, "missed_penetrating"),
           count_cell(*row, "colliding_triangles"), count_cell(*row, "missed_triangles"),
           count_cell(*row, "kept_triangles"), count_cell(*row, "candidates"),
           time_cell(*row, "total")});
    }
  }
  return out;
}

// How the misses of a method that promises nothing change from the fewest pixels to the most.
void add_course(const SceneRows& scene, const std::string& method, Chapter& chapter) {
  const Row *first = nullptr, *last = nullptr;
  for (const int resolution : resolutions_in(scene)) {
    const Row* row = find(scene, method, resolution);
    if (row == nullptr) continue;
    if (first == nullptr) first = row;
    last = row;
  }
  if (first == last) return;
  const std::uint64_t from = number_of(*first, "missed"), to = number_of(*last, "missed");
  chapter.findings.push_back(
      fmt::format("{} on {}: {} colliding pairs are missed at {} px and {} at {} px{}.", method,
                  scene.scene, of_all(from, number_of(*first, "colliding")),
                  first->point.resolution, grouped(to), last->point.resolution,
                  to > from              ? ", so more pixels made it worse"
                  : to == from && to > 0 ? ", so more pixels did not help"
                                         : ""));
}

// Sums over all rows of methods that promise nothing.
void add_sums(const std::vector<SceneRows>& scenes, Chapter& chapter) {
  struct Sum {
    std::uint64_t runs = 0, missing = 0, missed = 0, penetrating = 0;
  };
  std::map<std::string, Sum> sums;
  for (const SceneRows& scene : scenes) {
    for (const Row* row : scene.rows) {
      if (promises(*row)) continue;
      Sum& sum = sums[contestant(row->point)];
      ++sum.runs;
      sum.missing += number_of(*row, "missed") > 0;
      sum.missed += number_of(*row, "missed");
      sum.penetrating += number_of(*row, "missed_penetrating");
    }
  }
  for (const auto& [method, sum] : sums) {
    chapter.findings.push_back(
        sum.missed == 0
            ? fmt::format("{} misses nothing in {} runs here, and promises nothing.", method,
                          grouped(sum.runs))
            : fmt::format("{} misses pairs in {} runs; {} missed pairs penetrate, the others "
                          "touch.",
                          method, of_all(sum.missing, sum.runs),
                          of_all(sum.penetrating, sum.missed)));
  }
}

}  // namespace

Chapter accuracy_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const std::vector<SceneRows> scenes = rows_by_scene(stored);
  add_promises(stored, out);
  for (const SceneRows& scene : scenes) {
    for (const char* method : {"CULLIDE", "S-CULLIDE"}) add_course(scene, method, out);
  }
  add_sums(scenes, out);
  out.limits = {
      "Scenes are few and still, so that no miss is no proof; the proof is in "
      "docs/reliability.md.",
      "FAR culls sets of triangles of different objects; against themselves objects are tested by "
      "S-CULLIDE and FAR pairs alone.",
      "How much CULLIDE misses depends on how a device samples: other devices give other counts.",
      "The published radius may miss nothing in these scenes and pairs in others (see the study of "
      "the radius)."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = {missed_figure(scenes, "accuracy", "pairs", "missed", "colliding"),
                 missed_figure(scenes, "accuracy-triangles", "triangles", "missed_triangles",
                               "colliding_triangles")};
  out.tables = {short_table(scenes), long_table(scenes)};
  return out;
}

}  // namespace farcull
