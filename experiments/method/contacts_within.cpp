// Sorts the candidates into the order of the answer; then threads decide them in parts.
#include "experiments/method/contacts_within.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "core/proximity/near_pairs.h"
#include "verify/filter.h"

namespace farcull {

std::vector<std::vector<TriangleContact>> contacts_within(const Scene& scene, double within,
                                                          unsigned threads, std::size_t most,
                                                          const Progress& progress) {
  const FloatingPointGuard guard;
  if (progress) progress(StageKind::boxes);
  const ProximityTrees trees(scene, threads);
  // Allows a quarter more, since some pairs turn out to be a little too far apart.
  std::vector<TrianglePair> near = trees.pairs_within(within, most, progress, most / 4);
  remove_ignored(scene, scene.ignored, near);
  const std::vector<std::uint32_t> owner = owners(scene);
  const auto in_order = [&](const TrianglePair& pair) {
    return std::pair(ObjectPair{owner[pair.a], owner[pair.b]}, pair);
  };
  if (!std::ranges::is_sorted(near, {}, in_order)) std::ranges::sort(near, {}, in_order);
  if (progress) progress(StageKind::closest);
  constexpr std::size_t kTogether = 1024;  // pairs that a thread decides at a time
  std::vector<std::vector<TriangleContact>> out((near.size() + kTogether - 1) / kTogether);
  for_each_shared(out.size(), threads, [&](std::size_t part) {
    const std::span<const TrianglePair> pairs = std::span(near).subspan(
        part * kTogether, std::min(kTogether, near.size() - part * kTogether));
    std::array<Triage, kTogether> planes;
    filter_pairs(scene, pairs, within, {planes.data(), pairs.size()});
    out[part].reserve(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto& [a, b] = pairs[k];
      if (const auto contact =
              contact_within(scene.corners(a), scene.corners(b), within, planes[k])) {
        out[part].push_back({{owner[a], owner[b]}, pairs[k], *contact});
      }
    }
  });
  std::size_t count = 0;
  for (const auto& part : out) count += part.size();
  if (count > most) throw too_many_within(most, "triangles");
  return out;
}

}  // namespace farcull
