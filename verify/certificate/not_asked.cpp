// One pass over the objects: n triangles make n (n - 1) / 2 pairs, and neighbours in the order of
// the scene join into one range.
#include "verify/certificate/not_asked.h"

namespace farcull {

NotAsked not_asked(const Scene& scene) {
  NotAsked out;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.self) continue;
    ++out.objects;
    const std::uint64_t n = object.triangle_count;
    if (n > 0) out.pairs += n * (n - 1) / 2;
    if (out.ranges.empty() || out.ranges.back()[1] + 1 != o) out.ranges.push_back({o, o});
    out.ranges.back()[1] = o;
  }
  return out;
}

}  // namespace farcull
