// The chapter of the study "scenes": a table of all scenes of the studies.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/studies/study.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr int kResolutions[] = {64, 128, 256, 512, 1024, 2048, 4096};  // px

enum class Source { meshes, simulated, drawn, constructed };

Source source_of(const std::string& scene) {
  const BuiltinScene* entry = find_builtin_scene(scene);
  if (entry == nullptr) return Source::constructed;
  if (entry->needs_meshes) return Source::meshes;
  if (entry->name == "cloth") return Source::simulated;
  return entry->seed ? Source::drawn : Source::constructed;
}

// The number after @seed, else the scene's own seed. (The studies' names have suffixes that a scene
// does not know.) Precondition: the scene is drawn.
std::string drawn_with(const std::string& scene) {
  const std::string_view mark = "@seed";
  const std::size_t at = scene.find(mark);
  if (at == std::string::npos) return std::to_string(*find_builtin_scene(scene)->seed);
  const std::size_t from = at + mark.size();
  return scene.substr(from, scene.find('@', from) - from);
}

std::string source_text(const std::string& scene) {
  switch (source_of(scene)) {
    case Source::meshes:
      return "scanned or modelled";
    case Source::simulated:
      return "simulated";
    case Source::drawn:
      return fmt::format("drawn, seed {}", drawn_with(scene));
    case Source::constructed:
      break;
  }
  return "constructed";
}

// The studies of a scene by its name, in the order of studies().
std::map<std::string, std::vector<std::string>> users_of_scenes(const GridChoice& choice) {
  std::map<std::string, std::vector<std::string>> out;
  for (const Study& study : studies_of_all()) {
    if (study.name == "scenes") continue;
    for (const PointKey& point : keys_of(study.grid(choice))) {
      std::vector<std::string>& users = out[point.scene];
      if (users.empty() || users.back() != study.name) users.push_back(study.name);
    }
  }
  return out;
}

// Pixels that the triangle of this rank covers at a resolution.
std::string pixels_text(const Row& row, const char* rank, int resolution) {
  const std::optional<double> pixels = count_of(row, rank);
  if (!pixels) return "-";
  const double factor = static_cast<double>(resolution) / kSceneResolution;
  const double there = *pixels * factor * factor;
  return there >= 1 ? rounded(there, 2) : fmt::format("{:.2g}", there);
}

std::string frame_text(const Row& row) {
  return row.point.frame >= 0 ? std::to_string(row.point.frame) : "-";
}

std::string self_text(const Row& row) {
  const std::uint64_t self = number_of(row, "self_objects"), all = number_of(row, "objects");
  return self == 0 ? "no" : self == all ? "yes" : fmt::format("{} of {}", self, all);
}

DataTable table_of(const Rows& rows) {
  std::vector<std::string> pixels;
  for (const int resolution : kResolutions) pixels.push_back(fmt::format("{} px", resolution));
  DataTable out{
      .name = "scenes",
      .caption =
          "All scenes of the studies. Self: whether objects are tested against themselves. "
          "Pairs that collide, without neighbours inside an object. Then the pixels that "
          "the median triangle covers at each resolution: the area of its image in the views "
          "x, y and z, of the triangles whose box meets another object's or whose object is "
          "tested against itself. Of a scene that moves, the frame that is named",
      .columns =
          columns({"scene", "source", "self"}, {"frame", "objects", "triangles", "colliding"})};
  for (const std::string& name : pixels) out.columns.push_back({name});
  for (const Row* row : rows) {
    std::vector<std::string> cells = {row->point.scene,
                                      source_text(row->point.scene),
                                      self_text(*row),
                                      frame_text(*row),
                                      count_cell(*row, "objects"),
                                      count_cell(*row, "triangles"),
                                      count_cell(*row, "colliding")};
    for (const int resolution : kResolutions)
      cells.push_back(pixels_text(*row, "pixels_half", resolution));
    out.rows.push_back(std::move(cells));
  }
  return out;
}

DataTable all_table(const Rows& rows, const GridChoice& choice) {
  auto users = users_of_scenes(choice);
  DataTable out{.name = "scenes-all",
                .caption = fmt::format(
                    "All scenes, the studies that use them, colliding neighbours, and the "
                    "pixels that the smallest tenth, half and nine tenths of the triangles "
                    "cover at most at {} px",
                    kSceneResolution),
                .columns = columns({"scene", "source", "description", "studies", "self"},
                                   {"frame", "objects", "triangles", "colliding", "neighbours",
                                    "tenth", "half", "nine tenths"},
                                   {"scene hash"}),
                .in_text = false};
  for (const Row* row : rows) {
    const BuiltinScene* entry = find_builtin_scene(row->point.scene);
    std::string studies;
    for (const std::string& study : users[row->point.scene])
      studies += (studies.empty() ? "" : " ") + study;
    const auto hash = row->measurement.counts->value("scene_hash", std::string("-"));
    out.rows.push_back(
        {row->point.scene, source_text(row->point.scene),
         entry == nullptr ? "-" : entry->description, studies, self_text(*row), frame_text(*row),
         count_cell(*row, "objects"), count_cell(*row, "triangles"), count_cell(*row, "colliding"),
         count_cell(*row, "neighbours"), pixels_text(*row, "pixels_tenth", kSceneResolution),
         pixels_text(*row, "pixels_half", kSceneResolution),
         pixels_text(*row, "pixels_ninety", kSceneResolution), hash});
  }
  return out;
}

}  // namespace

Chapter scenes_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows rows = measured(stored);
  std::map<Source, std::size_t> of;
  std::size_t self = 0;
  for (const Row* row : rows) {
    ++of[source_of(row->point.scene)];
    self += number_of(*row, "self_objects") > 0;
  }
  if (!rows.empty()) {
    const auto range =
        std::minmax_element(rows.begin(), rows.end(), [](const Row* a, const Row* b) {
          return number_of(*a, "triangles") < number_of(*b, "triangles");
        });
    out.find(fmt::format(
        "The studies use {} scenes: {} of scanned or modelled meshes, {} of simulated cloth, {} "
        "drawn at random and {} constructed. They have {} to {} triangles. In {} of them objects "
        "are tested against themselves.",
        rows.size(), of[Source::meshes], of[Source::simulated], of[Source::drawn],
        of[Source::constructed], count_cell(**range.first, "triangles"),
        count_cell(**range.second, "triangles"), self));
    std::size_t below = 0, sized = 0;
    for (const Row* row : rows) {
      const std::optional<double> pixels = count_of(*row, "pixels_half");
      sized += pixels.has_value();
      below += pixels && *pixels < 1;
    }
    out.find(
        fmt::format("At {} px the median triangle covers less than a pixel in {} of {} scenes.",
                    kSceneResolution, below, sized));
  }
  out.limits = {
      "The generated scenes are ours. The meshes are a few that many papers use, scanned or "
      "modelled "
      "at one resolution each.",
      "A window is as large as the place where objects can meet. A method that divides a scene "
      "into "
      "several windows has smaller pixels there."};
  add_gaps(stored, out);
  if (!rows.empty()) out.tables = {table_of(rows), all_table(rows, stored.declaration.choice)};
  return out;
}

}  // namespace farcull
