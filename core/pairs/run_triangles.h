// The pairs of triangles that pairs of runs give.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/pairs/regions.h"

namespace farcull {

/// The runs of some pairs, ascending. runs: of the scene.
std::vector<std::uint32_t> runs_of(std::span<const RunPair> between,
                                   std::span<const RunPair> inside, std::size_t runs);

/// The pairs of triangles whose boxes overlap, sorted, each once, of some pairs of runs of the
/// scene: between objects, and inside one. neighbours: as pairs_of_runs().
std::vector<TrianglePair> pairs_of_some(const Scene& scene, const RunMeetings& meetings,
                                        std::span<const RunPair> between,
                                        std::span<const RunPair> inside, double clearance,
                                        bool neighbours, unsigned threads);

}  // namespace farcull
