// Asks the diagram and exact arithmetic, then counts for each object what the one leaves of what
// the other found.
#include "experiments/measure/potential_neighbours.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/gl/voronoi.h"
#include "experiments/measure/neighbours.h"
#include "experiments/method/options.h"
#include "experiments/method/session.h"
#include "verify/closest.h"
#include "verify/exact.h"

namespace farcull {
namespace {

// An object, and a triangle of another one that may be nearest to it.
using Potential = std::pair<std::uint32_t, std::uint32_t>;

void sort_each_once(std::vector<Potential>& all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

// Counts the triangles of each object's neighbours. Pairs repeat triangles, so what was found is
// made shorter on the way: memory is that of the answer and some millions of entries.
void count_triangles(const Scene& scene, const std::vector<TrianglePair>& pairs,
                     std::vector<PotentialNeighbours>& out) {
  constexpr std::size_t kMore = std::size_t{1} << 22;
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<Potential> found;
  std::size_t shortened = 0;
  for (const TrianglePair& pair : pairs) {
    found.emplace_back(owner[pair.a], pair.b);
    found.emplace_back(owner[pair.b], pair.a);
    if (found.size() < 2 * shortened + kMore) continue;
    sort_each_once(found);
    shortened = found.size();
  }
  sort_each_once(found);
  for (const Potential& potential : found) ++out[potential.first].triangles;
}

bool holds(const std::vector<ObjectPair>& sorted, std::uint32_t a, std::uint32_t b) {
  return std::binary_search(sorted.begin(), sorted.end(),
                            ObjectPair{std::min(a, b), std::max(a, b)});
}

// Asks the diagram on a GL device, where one is wanted.
class Asked {
 public:
  Asked(const DiagramOptions& options, DiagramRecord& record)
      : options_{.resolution = options.resolution,
                 .widening = options.widening,
                 .threads = options.threads} {
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

  VoronoiNeighbours published(const Scene& scene, const Progress& progress) const {
    return device_ ? voronoi_neighbours(scene, options_, *device_, progress)
                   : voronoi_neighbours(scene, options_, progress);
  }
  ReliableNeighbours reliable(const Scene& scene, const Progress& progress) const {
    return device_ ? reliable_neighbours(scene, options_, *device_, progress)
                   : reliable_neighbours(scene, options_, progress);
  }

 private:
  VoronoiOptions options_;
  std::optional<Session> session_;  // its context outlives the device
  std::unique_ptr<VoronoiDevice> device_;
};

void add_published(const Scene& scene, const Asked& diagram, const Progress& progress,
                   DiagramRecord& out, std::vector<ObjectPair>& objects) {
  VoronoiNeighbours found = diagram.published(scene, progress);
  out.work = found.counts;
  objects = std::move(found.objects);
  for (const ObjectPair& pair : objects) {
    const std::uint64_t a = scene.objects[pair.a].triangle_count;
    const std::uint64_t b = scene.objects[pair.b].triangle_count;
    out.objects[pair.a].triangles += b;
    out.objects[pair.b].triangles += a;
    out.triangle_pairs += a * b;
  }
}

std::vector<TrianglePair> add_reliable(const Scene& scene, const Asked& diagram,
                                       const Progress& progress, DiagramRecord& out,
                                       std::vector<ObjectPair>& objects) {
  ReliableNeighbours found = diagram.reliable(scene, progress);
  out.work = found.counts;
  out.triangle_pairs = found.triangles.size();
  objects = std::move(found.objects);
  count_triangles(scene, found.triangles, out.objects);
  return std::move(found.triangles);
}

}  // namespace

DiagramRecord potential_neighbours(const Scene& scene, const DiagramOptions& options,
                                   const Progress& progress) {
  const FloatingPointGuard guard;
  DiagramRecord out{.options = options,
                    .scene_hash = scene_hash(scene),
                    .degenerate_triangles = degenerate_triangles(scene),
                    .objects = std::vector<PotentialNeighbours>(scene.objects.size())};
  const bool reliable = options.form == DiagramForm::reliable;
  std::vector<ObjectPair> objects;
  std::vector<TrianglePair> triangles;
  const Asked diagram(options, out);
  const Stopwatch diagram_watch;
  if (reliable)
    triangles = add_reliable(scene, diagram, progress, out, objects);
  else
    add_published(scene, diagram, progress, out, objects);
  out.diagram_ms = diagram_watch.ms();
  out.object_pairs = objects.size();
  for (const ObjectPair& pair : objects) {
    ++out.objects[pair.a].objects;
    ++out.objects[pair.b].objects;
  }
  const Stopwatch exact_watch;
  std::vector<NearestObjects> truth = nearest_objects(scene, progress);
  for (std::uint32_t object = 0; object < truth.size(); ++object) {
    PotentialNeighbours& of = out.objects[object];
    for (std::size_t i = 0; i < truth[object].objects.size(); ++i) {
      const TrianglePair& pair = truth[object].triangles[i];
      of.lost += !holds(objects, object, truth[object].objects[i]) ||
                 (reliable && !std::binary_search(triangles.begin(), triangles.end(), pair));
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
