// Turns potential neighbours into JSON, CSV and a table.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commit.h"
#include "experiments/measure/potential_neighbours.h"
#include "experiments/record/output.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRowsShown = 24;

std::string name_of(const Scene& scene, std::uint32_t object) {
  return fmt::format("{} {}", object, scene.objects[object].name);
}

// The first of the nearest objects, and how many are as near.
std::string nearest_text(const Scene& scene, const PotentialNeighbours& of) {
  if (of.nearest.empty()) return "none";
  std::string text = name_of(scene, of.nearest.front());
  if (of.nearest.size() > 1) text += fmt::format(" and {} more", of.nearest.size() - 1);
  return text;
}

std::string objects_table(const Scene& scene, const DiagramRecord& record) {
  Table table("llrrrr");
  table.add({"object", "nearest", "distance", "objects left", "triangles left", "lost"});
  const std::size_t shown = std::min(record.objects.size(), kRowsShown);
  for (std::uint32_t object = 0; object < shown; ++object) {
    const PotentialNeighbours& of = record.objects[object];
    table.add({name_of(scene, object), nearest_text(scene, of),
               of.nearest.empty() ? "" : fmt::format("{}", of.distance), grouped(of.objects),
               grouped(of.triangles), grouped(of.lost)});
  }
  std::string out = table.text();
  if (record.objects.size() > shown)
    out += fmt::format("and {} more (--json and --csv have all)\n",
                       grouped(record.objects.size() - shown));
  return out;
}

Json device_json(const DiagramRecord& record) {
  if (!record.gl) return {{"kind", "cpu"}};
  return {{"kind", record.gl->kind},         {"vendor", record.gl->vendor},
          {"renderer", record.gl->renderer}, {"version", record.gl->version},
          {"glsl", record.gl->glsl},         {"reason", "--device " + record.options.device},
          {"probes", record.probes}};
}

}  // namespace

Json diagram_json(const Scene& scene, const DiagramRecord& record,
                  std::optional<std::uint64_t> seed) {
  Json objects = Json::array();
  for (std::uint32_t object = 0; object < record.objects.size(); ++object) {
    const PotentialNeighbours& of = record.objects[object];
    objects.push_back({{"object", object},
                       {"name", scene.objects[object].name},
                       {"nearest", of.nearest},
                       {"distance", of.nearest.empty() ? Json(nullptr) : Json(of.distance)},
                       {"potential_objects", of.objects},
                       {"potential_triangles", of.triangles},
                       {"lost", of.lost}});
  }
  const DiagramTotals totals = totals_of(record);
  return {{"scene", scene_json(scene, record.degenerate_triangles, record.scene_hash)},
          {"diagram", to_string(record.options.form)},
          {"resolution", record.options.resolution},
          {"cells", record.work.cells},
          {"device", device_json(record)},
          {"objects", objects},
          {"totals",
           {{"objects", totals.objects},
            {"nearest", totals.nearest},
            {"lost", totals.lost},
            {"objects_lost", totals.objects_lost},
            {"potential_objects", totals.potential_objects},
            {"potential_triangles", totals.potential_triangles},
            {"object_pairs", record.object_pairs},
            {"triangle_pairs", record.triangle_pairs}}},
          {"counts", {{"blocks", record.work.blocks}, {"distances", record.work.distances}}},
          {"time_ms", {{"diagram", record.diagram_ms}, {"exact", record.exact_ms}}},
          {"seed", seed ? Json(*seed) : Json(nullptr)},
          {"commit", FARCULL_COMMIT}};
}

std::string diagram_csv(const Scene& scene, const DiagramRecord& record) {
  std::string out =
      "object,nearest,nearest_objects,distance,potential_objects,potential_triangles,lost\n";
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const PotentialNeighbours& of = record.objects[object];
    const bool none = of.nearest.empty();
    out +=
        fmt::format("{},{},{},{},{},{},{}\n", object,
                    none ? "" : std::to_string(of.nearest.front()), of.nearest.size(),
                    none ? "" : fmt::format("{}", of.distance), of.objects, of.triangles, of.lost);
  }
  return out;
}

std::string diagram_table(const Scene& scene, const DiagramRecord& record) {
  const DiagramTotals totals = totals_of(record);
  const auto& cells = record.work.cells;
  std::string out =
      fmt::format("{}: {}, {}\n", scene.name, counted(scene.objects.size(), "object", "objects"),
                  counted(scene.triangles.size(), "triangle", "triangles"));
  out += fmt::format("diagram    {}, {} x {} x {} cells\n", to_string(record.options.form),
                     cells[0], cells[1], cells[2]);
  out += "device     " + (record.gl ? record.gl->renderer : "cpu") + "\n";
  if (record.gl) out += "probes     " + record.probes + "\n";
  out += "\n";
  out += objects_table(scene, record) + "\n";
  out += fmt::format("left       {} and {}\n",
                     counted(record.object_pairs, "pair of objects", "pairs of objects"),
                     counted(record.triangle_pairs, "pair of triangles", "pairs of triangles"));
  out += fmt::format("nearest    {} of {}; the diagram lost {}\n",
                     counted(totals.nearest, "nearest object", "nearest objects"),
                     counted(totals.objects, "object", "objects"), grouped(totals.lost));
  out += fmt::format("           {}\n", counted(totals.objects_lost, "object lost all of its own",
                                                "objects lost all of theirs"));
  return out + fmt::format("time       {:.1f} ms; exact distances {:.1f} more\n", record.diagram_ms,
                           record.exact_ms);
}

}  // namespace farcull
