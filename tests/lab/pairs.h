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

/// The triangles of each object in another order.
inline Scene shuffled(Scene scene, std::uint64_t seed) {
  Random random(seed);
  for (const Object& object : scene.objects) {
    for (std::uint32_t k = object.triangle_count; k > 1; --k) {
      std::swap(scene.triangles[object.first_triangle + k - 1],
                scene.triangles[object.first_triangle + random.below(k)]);
    }
  }
  return scene;
}

/// Two objects of `count` triangles each: those of the first lie in one oblique plane, and on each
/// of them stands one of the second, on the middle of an edge or `gap` above it.
inline Scene standing(std::uint32_t count, std::uint64_t seed, double gap = 0) {
  Random random(seed);
  const auto whole = [&] { return static_cast<double>(random.below(200) - 100); };
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vec3 normal = Vec3(-3, 5, 1).normalized();
    const auto corner = [&] {
      const double x = whole(), y = whole();
      return Vec3(x, y, 3 * x - 5 * y);
    };
    const std::array<Vec3, 3> flat = {corner(), corner(), corner()};
    const Vec3 foot = 0.5 * (flat[0] + flat[1]) + gap * normal;
    objects[0].push_back(flat);
    objects[1].push_back({foot, foot + 50 * normal + Vec3(1, 0, 0), foot + 50 * normal});
  }
  return scene_of(objects);
}

/// Pairs that count and whose boxes, grown by half the clearance, overlap: by comparing all boxes.
inline std::vector<TrianglePair> overlapping(const Scene& scene, double clearance,
                                             bool neighbours = true,
                                             std::span<const ObjectPair> ignored = {}) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < owner.size(); ++t) boxes.push_back(grown_box(scene, t, clearance));
  std::vector<TrianglePair> out;
  for (std::uint32_t a = 0; a < boxes.size(); ++a) {
    for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
      if (!overlap(boxes[a], boxes[b])) continue;
      if (std::ranges::count(ignored, ObjectPair{owner[a], owner[b]})) continue;
      if (owner[a] == owner[b]) {
        if (!scene.objects[owner[a]].self) continue;
        if (!neighbours && share_index(scene.triangles[a], scene.triangles[b])) continue;
      }
      out.push_back({a, b});
    }
  }
  return out;
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
