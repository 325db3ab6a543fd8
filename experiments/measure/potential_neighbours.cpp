// Asks the diagram and exact arithmetic, then counts for each object what the one leaves of what
// the other found.
#include "experiments/measure/potential_neighbours.h"

#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/gl/voronoi/voronoi.h"
#include "experiments/measure/neighbour_sets.h"
#include "experiments/measure/neighbours.h"
#include "experiments/method/options.h"
#include "experiments/method/session.h"
#include "verify/closest.h"
#include "verify/exact.h"

namespace farcull {
namespace {

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

}  // namespace farcull
