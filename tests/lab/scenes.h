// Small scenes that aim at trouble, for end-to-end tests on any canvas.
#pragma once

#include "tests/lab/canvas.h"

namespace farcull::lab {

// Objects of the given triangles, a vertex per corner.
inline Scene scene_of(const std::vector<std::vector<std::array<Vec3, 3>>>& objects) {
  Scene scene;
  scene.name = "test";
  for (const auto& triangles : objects) {
    scene.objects.push_back({"o" + std::to_string(scene.objects.size()),
                             static_cast<std::uint32_t>(scene.triangles.size()),
                             static_cast<std::uint32_t>(triangles.size())});
    for (const auto& t : triangles) add_triangle(scene, t);
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

// A scene at which a property fails, made small and written where it can be moved to tests/cases.

/// The scene with these triangles alone, ascending; objects stay, perhaps empty.
inline Scene with_triangles(const Scene& scene, const std::vector<std::uint32_t>& kept) {
  Scene out;
  out.name = scene.name;
  auto next = kept.begin();
  for (Object object : scene.objects) {
    const std::uint32_t end = object.first_triangle + object.triangle_count;
    object.first_triangle = static_cast<std::uint32_t>(out.triangles.size());
    for (; next != kept.end() && *next < end; ++next) {
      const auto v = static_cast<std::uint32_t>(out.vertices.size());
      for (const Vec3& x : scene.corners(*next)) out.vertices.push_back(x);
      out.triangles.push_back({v, v + 1, v + 2});
      out.source_face.push_back(scene.source_face[*next]);
    }
    object.triangle_count =
        static_cast<std::uint32_t>(out.triangles.size()) - object.first_triangle;
    out.objects.push_back(object);
  }
  return out;
}

/// Triangles are left out, ever fewer at a time, while `fails` holds of what is left (delta
/// debugging, Zeller and Hildebrandt 2002, without complements). Precondition: it holds of `scene`.
inline Scene minimized(const Scene& scene, const std::function<bool(const Scene&)>& fails) {
  std::vector<std::uint32_t> kept(scene.triangles.size());
  for (std::uint32_t t = 0; t < kept.size(); ++t) kept[t] = t;
  for (std::size_t at_once = (kept.size() + 1) / 2; at_once > 0;) {
    bool shrunk = false;
    for (std::size_t from = 0; from < kept.size();) {
      std::vector<std::uint32_t> fewer = kept;
      const auto begin = fewer.begin() + static_cast<std::ptrdiff_t>(from);
      fewer.erase(begin,
                  begin + static_cast<std::ptrdiff_t>(std::min(at_once, kept.size() - from)));
      if (fails(with_triangles(scene, fewer))) {
        kept = fewer;
        shrunk = true;
      } else {
        from += at_once;
      }
    }
    if (!shrunk) at_once /= 2;
  }
  return with_triangles(scene, kept);
}

/// The scene as OBJ (17 digits give every double back), with the settings it failed at in its first
/// line. The path of the file, which tests/cases replays once it is there.
inline std::string write_case(const std::string& name, const Scene& scene,
                              const std::string& settings) {
  const std::string path = failure_file(name + ".obj").string();
  std::ofstream out(path);
  out << "# " << settings << "\n";
  char line[128];
  for (const Object& object : scene.objects) {
    if (object.triangle_count == 0) continue;
    out << "o " << object.name << "\n";
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count;
         ++t) {
      for (const Vec3& p : scene.corners(t)) {
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
        out << line;
      }
      out << "f -3 -2 -1\n";
    }
  }
  return path;
}

/// Fails the test if the property fails of the scene, and says where the minimized scene is.
inline void expect_not(const std::function<bool(const Scene&)>& fails, const Scene& scene,
                       const std::string& name, const std::string& settings) {
  if (!fails(scene)) return;
  const Scene least = minimized(scene, fails);
  ADD_FAILURE() << "minimized to " << least.triangles.size()
                << " triangles: " << write_case(name, least, settings)
                << " (move it to tests/cases)";
}

}  // namespace farcull::lab
