// Asks the diagram and exact arithmetic, counts for each object what the one leaves of what the
// other found, and turns it into JSON, CSV and a table.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "commit.h"
#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/gl/voronoi/voronoi.h"
#include "experiments/measure/neighbour_sets.h"
#include "experiments/method/options.h"
#include "experiments/method/session.h"
#include "experiments/record/fields.h"
#include "experiments/record/output.h"
#include "experiments/system/text_table.h"
#include "verify/closest.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kObjectsShown = 24;

std::string numbered_name(const Scene& scene, std::uint32_t object) {
  return fmt::format("{} {}", object, scene.objects[object].name);
}

// The first of the nearest objects, and how many are as near.
std::string nearest_text(const Scene& scene, const PotentialNeighbours& of) {
  if (of.nearest.empty()) return "none";
  std::string text = numbered_name(scene, of.nearest.front());
  if (of.nearest.size() > 1) text += fmt::format(" and {} more", of.nearest.size() - 1);
  return text;
}

std::string objects_table(const Scene& scene, const DiagramRecord& record) {
  Table table("llrrrr");
  table.add({"object", "nearest", "distance", "objects left", "triangles left", "lost"});
  const std::size_t shown = std::min(record.objects.size(), kObjectsShown);
  for (std::uint32_t object = 0; object < shown; ++object) {
    const PotentialNeighbours& of = record.objects[object];
    table.add({numbered_name(scene, object), nearest_text(scene, of),
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
  Json out = {{"kind", record.gl->kind}};
  out.update(gl_json(*record.gl));
  out.update(Json{{"reason", "--device " + record.options.device}, {"probes", record.probes}});
  return out;
}

// Asks the diagram on a GL device, where one is wanted.
class Asked {
 public:
  Asked(const DiagramOptions& options, DiagramRecord& record)
      : options_{.method = options.form == DiagramForm::reliable ? NeighbourMethod::voronoi_reliable
                                                                 : NeighbourMethod::voronoi,
                 .resolution = options.resolution,
                 .widening = options.widening,
                 .threads = options.threads,
                 .most_pairs = VoronoiOptions{}.most_pairs} {
    if (options.device.empty() || is_cpu(options.device)) return;
    session_.emplace(options.device, options.threads);
    const GlContext& context = session_->context();
    const DeviceVerdict& verdict = session_->verdict(Reliance::drawing);
    record.gl = context.info();
    record.probes = to_string(verdict, Reliance::drawing);
    if (!verdict.holds)
      throw Error("--device " + options.device, record.probes, "use --device cpu");
    device_ = gl_voronoi_device(context);
  }

  NeighbourSets sets(const Scene& scene, const Progress& progress) const {
    return diagram_sets(scene, options_, device_.get(), progress);
  }

 private:
  NeighbourOptions options_;
  std::optional<Session> session_;  // its context outlives the device
  std::unique_ptr<VoronoiDevice> device_;
};

}  // namespace

DiagramRecord potential_neighbours(const Scene& scene, const DiagramOptions& options,
                                   const Progress& progress) {
  const FloatingPointGuard guard;
  DiagramRecord out{.options = options,
                    .scene_hash = scene_hash(scene),
                    .degenerate_triangles = degenerate_triangles(scene),
                    .objects = std::vector<PotentialNeighbours>(scene.objects.size())};
  const Asked diagram(options, out);
  const Stopwatch diagram_watch;
  const NeighbourSets sets = diagram.sets(scene, progress);
  const std::vector<SetSize> sizes = set_sizes(scene, sets);
  out.diagram_ms = diagram_watch.ms();
  out.work = sets.work;
  out.object_pairs = sets.objects.size();
  out.triangle_pairs = triangle_pairs_of(sets);
  const Stopwatch exact_watch;
  std::vector<NearestObjects> truth = nearest_objects(scene, progress);
  for (std::uint32_t object = 0; object < truth.size(); ++object) {
    PotentialNeighbours& of = out.objects[object];
    of.objects = sizes[object].objects;
    of.triangles = sizes[object].triangles;
    for (std::size_t i = 0; i < truth[object].objects.size(); ++i) {
      const std::uint32_t other = truth[object].objects[i];
      of.lost += !has_objects(sets, object, other) ||
                 !has_triangles(sets, object, other, truth[object].triangles[i]);
    }
    if (!truth[object].triangles.empty()) {
      const TrianglePair& pair = truth[object].triangles.front();
      of.distance = squared_distance(scene.corners(pair.a), scene.corners(pair.b)).root();
    }
    of.nearest = std::move(truth[object].objects);
  }
  out.exact_ms = exact_watch.ms();
  require_proved("arithmetic");  // a driver's code ran in this thread too
  return out;
}

DiagramTotals totals_of(const DiagramRecord& record) {
  DiagramTotals out;
  for (const PotentialNeighbours& of : record.objects) {
    out.objects += !of.nearest.empty();
    out.nearest += of.nearest.size();
    out.lost += of.lost;
    out.objects_lost += of.lost > 0 && of.lost == of.nearest.size();
    out.potential_objects += of.objects;
    out.potential_triangles += of.triangles;
  }
  return out;
}

const char* to_string(DiagramForm form) {
  return form == DiagramForm::reliable ? "reliable" : "published";
}

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
  Json totals = json_of(totals_of(record));
  totals["object_pairs"] = record.object_pairs;
  totals["triangle_pairs"] = record.triangle_pairs;
  return {{"scene", scene_json(scene, record.degenerate_triangles, record.scene_hash)},
          {"diagram", to_string(record.options.form)},
          {"resolution", record.options.resolution},
          {"cells", record.work.cells},
          {"device", device_json(record)},
          {"objects", objects},
          {"totals", totals},
          {"counts", {{"blocks", record.work.blocks}, {"distances", record.work.distances}}},
          {"time_ms", {{"diagram", record.diagram_ms}, {"exact", record.exact_ms}}},
          {"seed", json_of(seed)},
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
