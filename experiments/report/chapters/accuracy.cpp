// The chapter of the study "accuracy": missed pairs against resolution, and a picture of CULLIDE
// beside FAR where CULLIDE misses something.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

Figure missed_figure(const std::vector<NamedRows>& scenes, const std::string& name,
                     const std::string& what, const std::string& missed,
                     const std::string& colliding) {
  Figure out{.name = name, .title = "Missed colliding " + what + " against resolution"};
  std::vector<std::string> of;
  for (const NamedRows& scene : scenes) {
    const std::set<int> resolutions = resolutions_in(scene.rows);
    if (resolutions.empty()) continue;
    Panel panel{.title = scene.name,
                .x = logarithmic("resolution (px)"),
                .y = logarithmic("missed " + what, true)};
    for (const NamedRows& method : rows_by_contestant(scene.rows)) {
      Rows drawn;
      for (const int resolution : resolutions) {
        if (const Row* row = at_resolution(method.rows, resolution)) drawn.push_back(row);
      }
      if (drawn.empty()) continue;
      Series series = series_of(
          method.name, drawn, [](const Row& row) { return row.point.resolution; },
          [&](const Row& row) { return count_or_none(row, missed); });
      series.emphasis = method.name == "FAR (OBB)" || method.name == "FAR pairs";
      panel.series.push_back(std::move(series));
    }
    of.push_back(
        fmt::format("{} {}", grouped(number_of(*scene.rows.front(), colliding)), scene.name));
    out.panels.push_back(std::move(panel));
  }
  out.caption = fmt::format(
      "Colliding {} that are not found, of all: {}. The line below the powers is 0. What lies on "
      "it missed nothing.",
      what, listed(of));
  return out;
}

DataTable short_table(const std::vector<NamedRows>& scenes) {
  std::set<int> resolutions;
  for (const NamedRows& scene : scenes) resolutions.merge(resolutions_in(scene.rows));
  DataTable out{.name = "accuracy",
                .caption = "Missed pairs by resolution in px",
                .columns = columns({"scene", "method"}, {"colliding"})};
  for (const int resolution : resolutions) out.columns.push_back({std::to_string(resolution)});
  for (const NamedRows& scene : scenes) {
    for (const NamedRows& method : rows_by_contestant(scene.rows)) {
      std::vector<std::string> cells = {scene.name, method.name,
                                        count_cell(*scene.rows.front(), "colliding")};
      for (const int resolution : resolutions) {
        const Row* row = at_resolution(method.rows, resolution);
        cells.push_back(row == nullptr ? "-" : count_cell(*row, "missed"));
      }
      out.rows.push_back(std::move(cells));
    }
  }
  return out;
}

DataTable long_table(const Rows& rows) {
  return table_of_rows(
      "accuracy-all", "All points", rows,
      {scene_column(), contestant_column(), resolution_column("resolution", "auto"),
       rounded_column("radius px", "radius_px"), count_column("colliding pairs", "colliding"),
       count_column("missed pairs", "missed"),
       count_column("of them penetrating", "missed_penetrating"),
       count_column("colliding triangles", "colliding_triangles"),
       count_column("missed triangles", "missed_triangles"),
       count_column("kept triangles", "kept_triangles"), count_column("candidates", "candidates"),
       time_column("ms", "total")});
}

// Adds how the misses of a method that promises nothing change from the fewest pixels to the most.
void add_course(const NamedRows& scene, const std::string& method, Chapter& chapter) {
  const Row *first = nullptr, *last = nullptr;
  for (const int resolution : resolutions_in(scene.rows)) {
    const Row* row = find_row(scene.rows, method, resolution);
    if (row == nullptr) continue;
    if (first == nullptr) first = row;
    last = row;
  }
  if (first == last) return;
  const std::uint64_t from = number_of(*first, "missed"), to = number_of(*last, "missed");
  chapter.find(fmt::format("{} on {}: {} colliding pairs are missed at {} px and {} at {} px{}.",
                           method, scene.name, of_all(from, number_of(*first, "colliding")),
                           first->point.resolution, grouped(to), last->point.resolution,
                           to > from              ? ", so more pixels made it worse"
                           : to == from && to > 0 ? ", so more pixels did not help"
                                                  : ""));
}

// Adds the sums over all rows of methods that promise nothing.
void add_sums(Rows rows, Chapter& chapter) {
  std::erase_if(rows, [](const Row* row) { return promises(*row); });
  const auto sums = rows_by(rows, [](const Row& row) { return contestant(row.point); });
  for (const auto& [method, runs] : sums) {
    if (total(runs, "missed") == 0) {
      chapter.find(fmt::format("{} misses nothing in {} runs here, and promises nothing.", method,
                               grouped(runs.size())));
      continue;
    }
    const auto missing = std::count_if(
        runs.begin(), runs.end(), [](const Row* row) { return number_of(*row, "missed") > 0; });
    chapter.find(
        fmt::format("{} misses pairs in {} runs; {} missed pairs penetrate, the others touch.",
                    method, of_all(static_cast<std::uint64_t>(missing), runs.size()),
                    of_all(runs, "missed_penetrating", "missed")));
  }
}

// A picture with fewer pixels than these shows hardly more than misses.
constexpr int kLeastPixels = 128;

bool is_of(const Row& row, const char* method) {
  return row.point.method == method && row.point.resolution >= kLeastPixels;
}

// FAR as it promises, of the same scene and resolution; null where it was not measured.
const Row* partner_of(const Rows& rows, const Row& cullide) {
  for (const Row* row : rows) {
    if (is_of(*row, "far") && row->point.scene == cullide.point.scene &&
        row->point.resolution == cullide.point.resolution && row->point.offset == "obb" &&
        row->point.radius == "budget") {
      return row;
    }
  }
  return nullptr;
}

// Meshes are easier to see than slivers.
int rank(const Row& row) { return row.point.scene.starts_with("two-bunnies") ? 0 : 1; }

// CULLIDE beside FAR on a scene, at a resolution where both were measured and CULLIDE missed
// something. Empty where there is none.
std::vector<Picture> pictures_of(const Rows& rows) {
  const Row *cullide = nullptr, *far = nullptr;
  for (const Row* row : rows) {
    if (!is_of(*row, "cullide") || number_of(*row, "missed") == 0) continue;
    const bool better = cullide == nullptr || rank(*row) < rank(*cullide) ||
                        (row->point.scene == cullide->point.scene &&
                         row->point.resolution < cullide->point.resolution);
    const Row* partner = better ? partner_of(rows, *row) : nullptr;
    if (partner == nullptr) continue;
    cullide = row;
    far = partner;
  }
  if (cullide == nullptr) return {};
  Picture out{
      .name = "accuracy-compare",
      .caption = fmt::format(
          "CULLIDE and FAR on {} at {} px. Missed pairs are drawn in the colour that nothing else "
          "has. What collides and was found is coloured, what was kept and does not collide is "
          "faint.",
          cullide->point.scene, cullide->point.resolution)};
  out.arguments.scene = {cullide->point.scene};
  for (const Method method : {Method::cullide, Method::far}) {
    RunOptions& options = out.arguments.panels.emplace_back();
    options.method = method;
    options.resolution = cullide->point.resolution;
    options.verify = false;
  }
  out.panels = {{"CULLIDE", count_of(*cullide, "missed"), count_of(*cullide, "colliding")},
                {"FAR", count_of(*far, "missed"), count_of(*far, "colliding")}};
  return {std::move(out)};
}

}  // namespace

Chapter accuracy_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows rows = measured(stored);
  const std::vector<NamedRows> scenes = rows_by_scene(stored);
  add_promises(stored, out);
  for (const NamedRows& scene : scenes) {
    for (const char* method : {"CULLIDE", "S-CULLIDE"}) add_course(scene, method, out);
  }
  add_sums(rows, out);
  out.limits = {
      "Scenes are few and still, so that no miss is no proof; the proof is in "
      "docs/reliability.md.",
      "FAR is measured between objects; against themselves objects are tested by S-CULLIDE and FAR "
      "pairs alone.",
      "How much CULLIDE misses depends on how a device samples: other devices give other counts.",
      "The published radius may miss nothing in these scenes and pairs in others (see the study of "
      "the radius)."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = {missed_figure(scenes, "accuracy", "pairs", "missed", "colliding"),
                 missed_figure(scenes, "accuracy-triangles", "triangles", "missed_triangles",
                               "colliding_triangles")};
  out.tables = {short_table(scenes), long_table(rows)};
  out.pictures = pictures_of(rows);
  return out;
}

}  // namespace farcull
