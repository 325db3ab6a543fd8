#include "core/proximity/run_corners.h"

#include <algorithm>

namespace farcull {
namespace {

// Into the cache, for a use that follows soon.
void fetch([[maybe_unused]] const void* at) {
#ifdef __GNUC__
  __builtin_prefetch(at);
#endif
}

}  // namespace

void load_run(const SceneTrees& trees, std::uint32_t run, RunCorners& out) {
  const Scene& scene = trees.scene();
  out.run = run;
  out.count = trees.count(run);
  out.direction = 0;
  // Triangles and their corners may lie anywhere in memory.
  for (std::uint32_t k = 0; k < kBatch; ++k) {
    out.triangle[k] = trees.triangle(run, std::min(k, out.count - 1));
    fetch(&scene.triangles[out.triangle[k]]);
  }
  for (const std::uint32_t triangle : out.triangle) prefetch(scene, triangle);
  out.boxes.clear();
  for (std::uint32_t k = 0; k < kBatch; ++k) {
    Box box = Box::empty();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 p = trees.corner(out.triangle[k], corner);
      box.add(p);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        out.corner[3 * corner + axis][k] = p[static_cast<Eigen::Index>(axis)];
      }
    }
    if (k < out.count) out.boxes.set(k, box);
  }
}

bool share_position(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const auto &own = scene.triangles[a], &other = scene.triangles[b];
  if (share_index(own, other)) return true;
  for (const std::uint32_t v : own) {
    for (const std::uint32_t w : other) {
      if (scene.vertices[v] == scene.vertices[w]) return true;
    }
  }
  return false;
}

}  // namespace farcull
