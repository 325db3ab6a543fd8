// Checks of options that both forms of the diagram share.
#include "core/proximity/voronoi_blocks.h"

#include "core/base/error.h"

namespace farcull::voronoi {

void require(const VoronoiOptions& options) {
  if (options.resolution < 1 || options.resolution > kVoronoiLargest) {
    throw Error("resolution", "is " + std::to_string(options.resolution),
                "give 1 to " + std::to_string(kVoronoiLargest));
  }
  if (!(options.widening >= 0 && options.widening <= 1)) {
    throw Error("widening", "is not in 0 to 1", "leave it at 1, which the proof asks for");
  }
}

std::uint64_t distances_in(int slice, const VoronoiBricks& bricks) {
  std::uint64_t out = 0;
  for (const VoronoiBrick& brick : bricks.bricks) {
    if (slice < brick.from[2] || slice >= brick.to[2]) continue;
    out += static_cast<std::uint64_t>(brick.to[0] - brick.from[0]) *
           static_cast<std::uint64_t>(brick.to[1] - brick.from[1]) * brick.count;
  }
  return out;
}

void sort_each_once(std::vector<ObjectPair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace farcull::voronoi
