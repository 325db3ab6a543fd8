// Small scenes for tests of the discrete Voronoi diagram, and what it misses.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/voronoi/voronoi.h"
#include "tests/core/proximity/exact_distance.h"
#include "tests/core/scene/scenes.h"

namespace farcull::lab {

// 3 to 8 objects of 1 to 4 triangles in a cube of side 1, on a grid of 2^-10, so that contacts and
// ties happen. Kinds: triangles of any size; segments and points; needles; sheets one above the
// other; a cluster of any size, from 1/4 to 1/2048, apart from one triangle; copies.
constexpr int kNeighbourKinds = 6;
constexpr int kClusterKind = 4;
inline Scene neighbours_scene(std::uint64_t seed, int kind) {
  Random random(seed);
  constexpr double kGrid = 0x1p-10;
  std::vector<std::vector<std::array<Vec3, 3>>> objects(
      static_cast<std::size_t>(3 + random.below(6)));
  const auto drawn = [&](double from, double to) {
    return Vec3(random.grid(from, to, kGrid), random.grid(from, to, kGrid),
                random.grid(from, to, kGrid));
  };
  const double cluster = std::exp2(-2 - random.below(10));
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const int count = 1 + random.below(4);
    for (int i = 0; i < count; ++i) {
      const double size = std::exp2(-random.below(8));
      const Vec3 at = drawn(0, 1);
      std::array<Vec3, 3> t = {at, at, at};
      for (Vec3& c : t) c += drawn(-size, size);
      if (kind == kClusterKind && (o > 0 || i > 0)) {
        for (Vec3& c : t) c *= cluster;
      }
      if (kind == 1 && random.below(2)) t[2] = random.below(2) ? t[1] : Vec3(2 * t[1] - t[0]);
      if (kind == 1 && random.below(3) == 0) t[2] = t[1] = t[0];
      if (kind == 2) t[2] = t[1] + Vec3(kGrid, 0, 0);
      if (kind == 3) t[0][2] = t[1][2] = t[2][2] = random.below(8) * 0x1p-5;
      if (kind == 5 && o > 0 && random.below(3) == 0) t = objects[o - 1].front();
      objects[o].push_back(t);
    }
  }
  return scene_of(objects);
}

// Of any kind.
inline Scene neighbours_scene(std::uint64_t seed) {
  return neighbours_scene(seed, static_cast<int>(seed % kNeighbourKinds));
}

// How many objects have a nearest neighbour, and how many of these lose all of theirs: no object
// that is as near as any is among the pairs.
struct Losses {
  std::uint64_t objects = 0, lost = 0;
};

inline bool holds(const std::vector<ObjectPair>& sorted, std::uint32_t a, std::uint32_t b) {
  return std::binary_search(sorted.begin(), sorted.end(),
                            ObjectPair{std::min(a, b), std::max(a, b)});
}

inline void count_losses(const Scene& scene, const std::vector<exact_distance::Nearest>& truth,
                         const std::vector<ObjectPair>& found, Losses& losses) {
  const std::vector<std::uint32_t> owner = owners(scene);
  for (const exact_distance::Nearest& nearest : truth) {
    if (nearest.pairs.empty()) continue;
    ++losses.objects;
    losses.lost += std::none_of(
        nearest.pairs.begin(), nearest.pairs.end(),
        [&](const TrianglePair& pair) { return holds(found, owner[pair.a], owner[pair.b]); });
  }
}

}  // namespace farcull::lab
