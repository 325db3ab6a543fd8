// Small scenes that aim at trouble, for end-to-end tests on any canvas.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/core/canvas/lab.h"

namespace farcull::lab {

// Objects of the given triangles, a vertex per corner.
inline Scene scene_of(const std::vector<std::vector<std::array<Vec3, 3>>>& objects) {
  Scene scene;
  scene.name = "test";
  for (const auto& triangles : objects) {
    scene.objects.push_back({"o" + std::to_string(scene.objects.size()),
                             static_cast<std::uint32_t>(scene.triangles.size()),
                             static_cast<std::uint32_t>(triangles.size())});
    for (const auto& t : triangles) {
      const auto v = static_cast<std::uint32_t>(scene.vertices.size());
      scene.vertices.insert(scene.vertices.end(), t.begin(), t.end());
      scene.source_face.push_back(static_cast<std::uint32_t>(scene.triangles.size()));
      scene.triangles.push_back({v, v + 1, v + 2});
    }
  }
  validate(scene, "test");
  return scene;
}

// Random triangles of several kinds in a unit cube, on a grid of 2^-10 so that exact contacts
// happen.
inline Scene random_scene(std::uint64_t seed) {
  Random random(seed);
  const int kind = random.below(5);
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2 + random.below(4));
  for (auto& object : objects) {
    const int count = random.below(60);
    for (int i = 0; i < count; ++i) {
      std::array<Vec3, 3> t;
      const double size = kind == 3 ? 30 : std::exp2(-random.below(8));
      const Vec3 at(random.grid(0, 1, 0x1p-10), random.grid(0, 1, 0x1p-10),
                    random.grid(0, 1, 0x1p-10));
      for (Vec3& c : t) {
        c = at + Vec3(random.grid(-size, size, 0x1p-10), random.grid(-size, size, 0x1p-10),
                      random.grid(-size, size, 0x1p-10));
      }
      if (kind == 1 && random.below(2))
        t[2] = random.below(2) ? t[1] : Vec3(2 * t[1] - t[0]);              // segments
      if (kind == 1 && random.below(4) == 0) t[2] = t[1] = t[0];            // points
      if (kind == 2) t[2] = t[1] + Vec3(0x1p-10, 0, 0);                     // needles
      if (kind == 4) t[1][2] = t[2][2] = t[0][2] = random.below(4) * 0.25;  // coplanar sheets
      object.push_back(t);
    }
  }
  return scene_of(objects);
}

// Short segments that cross at 45 degrees near the corners of the pixels of the view along z, at a
// resolution of `side`. Two anchors give both objects the same box, so that the pixel grid is
// known.
inline Scene corner_scene(int side) {
  Random random(7);
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  const double half = 0.5 * side;
  for (auto& object : objects) {
    const Vec3 corner(half, half, half);
    object.push_back({-corner, -corner, -corner});
    object.push_back({corner, corner, corner});
  }
  for (int y = -side / 2 + 4; y <= side / 2 - 4; y += 6) {
    for (int x = -side / 2 + 4; x <= side / 2 - 4; x += 6) {
      const Vec3 q(x + random.grid(-0x1p-10, 0x1p-10, 0x1p-14),
                   y + random.grid(-0x1p-10, 0x1p-10, 0x1p-14),
                   random.grid(-half + 1, half - 1, 0x1p-8));
      const Vec3 u(0x1p-12, 0x1p-12, 0), v(0x1p-12, -0x1p-12, 0);
      objects[0].push_back({q - u, q + u, q + u});
      objects[1].push_back({q - v, q + v, q + v});
    }
  }
  return scene_of(objects);
}

// An item beyond the budget: a needle of 1e18 px seen all but end-on, whose image double arithmetic
// cannot place.
inline Scene undrawable_scene() {
  const Vec3 along = Vec3(1, 1, 1) * 0x1p60;
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  objects[0].push_back({-along, along, along + Vec3(0, 0, 0x1p10)});
  for (int i = -20; i <= 20; ++i) {
    const Vec3 at(0.03125 * i, 0.25 * (i % 3), 0.0625 * (i % 5));
    objects[1].push_back({at, at + Vec3(0.125, 0, 0), at + Vec3(0, 0.125, 0.03125)});
  }
  return scene_of(objects);
}

}  // namespace farcull::lab
