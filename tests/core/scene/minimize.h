// A scene at which a property fails, made small and written where it can be moved to tests/cases.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/core/base/seed.h"

namespace farcull::lab {

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
