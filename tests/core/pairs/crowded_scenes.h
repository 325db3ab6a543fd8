// Scenes for FAR pairs with everything that takes programs of its own on a GL device.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/pairs/pairs.h"
#include "tests/core/pairs/pairs_lab.h"
#include "tests/core/scene/scenes.h"

namespace farcull::lab {

// Every so-and-so-manyth object is tested against itself.
inline Scene with_self(Scene scene, int every) {
  for (std::size_t o = 0; o < scene.objects.size(); o += every) scene.objects[o].self = true;
  return scene;
}

inline PairSettings settings_of(std::uint64_t k) {
  static const int resolutions[] = {0, 32, 1, 7, 100, 256, 1024};
  static const char* views[] = {"", "z", "x,y,z", "1:1:0.5"};
  static const double clearances[] = {0, 0, 0, 0x1p-10, 0.1};
  PairSettings out{.resolution = resolutions[k % 7], .clearance = clearances[k % 5]};
  if (*views[k % 4] != '\0') out.views = parse_views(views[k % 4]);
  return out;
}

// Needles and crumbs in one corner of a pixel of a coarse view, deep enough for three cuts.
inline Scene crowded_scene(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<std::vector<std::array<Vec3, 3>>> objects(3);
  for (auto& object : objects) {
    object.push_back({Vec3(-1, -1, -1), Vec3(-1, -1, -1), Vec3(-1, -1, -1)});
    object.push_back({Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)});
    for (int i = 0; i < count; ++i) {
      const double spread = std::exp2(-2 - 3 * random.below(4));
      const Vec3 at = Vec3(0.3, 0.3, 0.1) + spread * Vec3(random.unit(), random.unit(), 0) +
                      Vec3(0, 0, random.between(0, 0.5));
      const double size = std::exp2(-4 - random.below(9));
      const auto corner = [&] {
        return Vec3(
            at + size * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)));
      };
      object.push_back({corner(), corner(), corner()});
      if (i % 4 == 0) object.back()[2] = object.back()[1] + Vec3(1e-6, 0, 0);
    }
  }
  return scene_of(objects);
}

// A bit of everything that takes programs of its own: rows, crowds, large triangles, self.
inline Scene mixed_scene() {
  Scene scene = crowded_scene(5, 600);
  const auto v = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(),
                        {Vec3(-1, -1, 0.2), Vec3(1, -1, 0.1), Vec3(0, 1, 0.3), Vec3(-1, 0.9, 0),
                         Vec3(0.9, -1, 0.5), Vec3(0.95, -1, 0.4)});
  for (std::uint32_t t = 0; t < 2; ++t) {
    scene.source_face.push_back(static_cast<std::uint32_t>(scene.triangles.size()));
    scene.triangles.push_back({v + 3 * t, v + 3 * t + 1, v + 3 * t + 2});
    ++scene.objects.back().triangle_count;
  }
  validate(scene, "test");
  return scene;
}

}  // namespace farcull::lab
