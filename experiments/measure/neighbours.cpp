// Trees leave the pairs of triangles that can be nearest, and exact arithmetic decides.
#include "experiments/measure/neighbours.h"

#include <limits>
#include <optional>

#include "core/base/floating_point.h"
#include "core/proximity/near_pairs.h"
#include "verify/closest.h"

namespace farcull {

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

}  // namespace farcull
