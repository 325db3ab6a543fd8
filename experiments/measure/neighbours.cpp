// The truth about nearest neighbours, and what diagrams lose of it.
#include "experiments/measure/neighbours.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/proximity/near_pairs.h"
#include "verify/closest.h"

namespace farcull {
namespace {

bool holds(const std::vector<ObjectPair>& sorted, std::uint32_t a, std::uint32_t b) {
  return std::binary_search(sorted.begin(), sorted.end(),
                            ObjectPair{std::min(a, b), std::max(a, b)});
}

void count_missed(const std::vector<NearestObjects>& truth, const std::vector<ObjectPair>& kept,
                  DiagramCounts& counts) {
  counts.kept = kept.size();
  for (std::uint32_t object = 0; object < truth.size(); ++object) {
    const std::vector<std::uint32_t>& nearest = truth[object].objects;
    if (nearest.empty()) continue;
    ++counts.objects;
    counts.missed += std::none_of(nearest.begin(), nearest.end(),
                                  [&](std::uint32_t other) { return holds(kept, object, other); });
  }
}

}  // namespace

std::vector<NearestObjects> nearest_objects(const Scene& scene, const Progress& progress) {
  const FloatingPointGuard guard;
  const ProximityTrees trees(scene);
  std::vector<NearestObjects> out(scene.objects.size());
  std::vector<std::optional<SquaredDistance>> least(out.size());
  for (const NearPairs& near :
       trees.nearest_objects(1, std::numeric_limits<double>::infinity(), progress)) {
    const std::optional<NearestPair> nearest = nearest_pair(scene, near.pairs);
    if (!nearest) continue;
    const SquaredDistance& squared = nearest->closest.squared;
    const auto add = [&](std::uint32_t object, std::uint32_t other) {
      if (least[object] && *least[object] < squared) return;
      if (!least[object] || squared < *least[object]) {
        least[object] = squared;
        out[object] = {};
      }
      out[object].objects.push_back(other);
      out[object].triangles.push_back(nearest->pair);
    };
    // Pairs of objects come sorted, so the others of one object come ascending.
    add(near.objects.a, near.objects.b);
    add(near.objects.b, near.objects.a);
  }
  return out;
}

DiagramCounts measure_published(const Scene& scene, const std::vector<NearestObjects>& truth,
                                const VoronoiOptions& options, const Progress& progress) {
  DiagramCounts out;
  const Stopwatch watch;
  const VoronoiNeighbours found = voronoi_neighbours(scene, options, progress);
  out.ms = watch.ms();
  out.work = found.counts;
  count_missed(truth, found.objects, out);
  return out;
}

DiagramCounts measure_reliable(const Scene& scene, const std::vector<NearestObjects>& truth,
                               const VoronoiOptions& options, const Progress& progress) {
  DiagramCounts out;
  const Stopwatch watch;
  const ReliableNeighbours found = reliable_neighbours(scene, options, progress);
  out.ms = watch.ms();
  out.work = found.counts;
  count_missed(truth, found.objects, out);
  out.kept_triangles = found.triangles.size();
  for (const NearestObjects& nearest : truth) {
    for (const TrianglePair& pair : nearest.triangles) {
      out.missed_triangles +=
          !std::binary_search(found.triangles.begin(), found.triangles.end(), pair);
    }
  }
  return out;
}

}  // namespace farcull
