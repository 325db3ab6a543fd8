// The tests of boxes share this: the truth by exact tests of all pairs.
#pragma once

#include "core/boxes/search.h"
#include "tests/lab/scenes.h"
#include "verify/exact.h"

namespace farcull::lab {

inline Scene with_self(Scene scene) {
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

// Every pair that counts and collides, neighbours included, by the definition: all pairs of
// triangles, exact tests.
inline std::vector<TrianglePair> truth_of(const Scene& scene, double clearance = 0) {
  return all_colliding_pairs(scene, {.clearance = clearance}).all();
}

inline std::size_t missed(const std::vector<TrianglePair>& truth,
                          const std::vector<TrianglePair>& candidates) {
  return static_cast<std::size_t>(std::ranges::count_if(truth, [&](const TrianglePair& pair) {
    return !std::ranges::binary_search(candidates, pair);
  }));
}

/// plan_boxes() and find_boxes() in one call: the candidates.
inline std::vector<TrianglePair> pairs_by_boxes(const Scene& scene,
                                                const BoxesSettings& settings = {},
                                                unsigned threads = 0) {
  return find_boxes(scene, plan_boxes(scene, settings, threads)).candidates;
}

inline std::size_t missed(const Scene& scene, const BoxesSettings& settings = {}) {
  const std::vector<TrianglePair> candidates = pairs_by_boxes(scene, settings, 2);
  EXPECT_TRUE(std::ranges::is_sorted(candidates));
  EXPECT_EQ(std::ranges::adjacent_find(candidates), candidates.end());
  return missed(truth_of(scene, settings.clearance), candidates);
}

}  // namespace farcull::lab
