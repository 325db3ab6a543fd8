// Scenes whose pairs are found in many pixels, for both back ends of FAR pairs.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/pairs/pairs.h"
#include "tests/core/scene/scenes.h"

namespace farcull::lab {

using Triangles = std::vector<std::array<Vec3, 3>>;

/// `count` triangles an object that lie on each other, up to `apart`.
inline Scene coincident(int count, double apart, std::uint64_t seed) {
  Random random(seed);
  const auto near = [&](double x) { return x + apart * random.between(-1, 1); };
  std::vector<Triangles> objects(2);
  for (Triangles& object : objects) {
    for (int k = 0; k < count; ++k) {
      object.push_back({Vec3(near(0), near(0), near(0)), Vec3(near(1), near(0.1), near(0.3)),
                        Vec3(near(0.2), near(1), near(0.2))});
    }
  }
  return scene_of(objects);
}

/// Long thin triangles, which cross, through a small box.
inline Scene needles(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Triangles> objects(2);
  for (Triangles& object : objects) {
    for (int k = 0; k < count; ++k) {
      const auto point = [&] {
        return Vec3(random.between(-1, 1), random.between(-1, 1), 0.1 * random.between(-1, 1));
      };
      const Vec3 a = point(), b = point();
      object.push_back({a, b, b + Vec3(1e-3, 1e-3, 0)});
    }
  }
  return scene_of(objects);
}

/// Small ones in a heap on two large ones.
inline Scene heap(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Triangles> objects(2);
  for (Triangles& object : objects) {
    const double z = 0.01 * random.unit();
    object.push_back({Vec3(-1, -1, z), Vec3(3, -1, z), Vec3(-1, 3, 0)});
    for (int k = 0; k < count; ++k) {
      const auto near = [&](double x) { return x + 0.03 * random.between(-1, 1); };
      object.push_back({Vec3(near(0.3), near(0.3), near(0)), Vec3(near(0.3), near(0.3), near(0)),
                        Vec3(near(0.3), near(0.3), near(0))});
    }
  }
  return scene_of(objects);
}

inline Scene self_tested(Scene scene) {
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

struct RepeatedCase {
  std::string name;
  Scene scene;
  std::vector<int> resolutions;
};
inline std::vector<RepeatedCase> repeated_cases() {
  std::vector<RepeatedCase> out;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    out.push_back({"random", random_scene(seed), {3, 30, 200}});
  }
  for (const double apart : {0.0, 1e-9, 1e-3, 0.05}) {
    out.push_back({"coincident", coincident(150, apart, 3), {2, 9, 31}});
    out.push_back({"coincident with itself", self_tested(coincident(90, apart, 4)), {9}});
  }
  out.push_back({"crowded", coincident(700, 0.02, 5), {1, 6}});
  for (const std::uint64_t seed : {6u, 7u}) {
    out.push_back({"needles", needles(250, seed), {4, 25}});
    out.push_back({"needles with themselves", self_tested(needles(120, seed)), {4, 25}});
    out.push_back({"heap", heap(300, seed), {2, 20, 90}});
  }
  out.push_back({"crowded heap", heap(900, 8), {2, 20}});
  return out;
}

/// Calls visit(task, name) for each case in each of its resolutions.
template <class Visit>
void for_each_task(const Visit& visit) {
  for (const RepeatedCase& c : repeated_cases()) {
    const PairRegions regions = pair_regions(c.scene, 0, false, 1);
    if (regions.triangles.empty()) continue;
    for (const int resolution : c.resolutions) {
      PairScene seen;
      const std::optional<PairWindow> window = pair_window(regions, parse_view("z"), resolution, 0);
      ASSERT_TRUE(window);
      look(c.scene, regions, regions.triangles, *window, 1, seen);
      visit(seen.task, c.name + " at " + std::to_string(resolution));
    }
  }
}

}  // namespace farcull::lab
