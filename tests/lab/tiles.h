// Small random scenes, given part by part, and what tiles and one run say about them.
#pragma once

#include "core/base/random.h"
#include "experiments/record/output.h"
#include "experiments/tiles/run_tile.h"
#include "tests/lab/test.h"

namespace farcull {

/// Up to 4 objects of up to 6 triangles on whole numbers from 0 to 4: most boxes begin where others
/// end, and most cuts lie on such a place. Some triangles are degenerate, some vertices are shared.
inline Scene small_scene(RandomNumbers& random) {
  Scene scene;
  scene.name = "small";
  const auto objects = 1 + random.below(4u);
  for (std::uint32_t o = 0; o < objects; ++o) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    const std::uint32_t vertices = 3 + random.below(8u), triangles = random.below(7u);
    for (std::uint32_t v = 0; v < vertices; ++v) {
      Vec3 p;
      for (int i = 0; i < 3; ++i) p[i] = random.below(5);
      scene.vertices.push_back(p);
    }
    scene.objects.push_back({.name = "o" + std::to_string(o),
                             .first_triangle = static_cast<std::uint32_t>(scene.triangles.size()),
                             .triangle_count = triangles,
                             .self = random.below(2) == 0});
    for (std::uint32_t t = 0; t < triangles; ++t) {
      std::array<std::uint32_t, 3> corners{};
      for (std::uint32_t& v : corners) v = first + random.below(vertices);
      scene.triangles.push_back(corners);
      scene.source_face.push_back(t / 2);
    }
  }
  return scene;
}

/// One part for each object, with all vertices of the scene in it.
inline SceneSource source_of(const Scene& scene) {
  return [scene](const TakePart& take) {
    for (const Object& object : scene.objects) {
      Scene part;
      part.name = scene.name;
      part.vertices = scene.vertices;
      const auto from = static_cast<std::ptrdiff_t>(object.first_triangle);
      const auto to = from + static_cast<std::ptrdiff_t>(object.triangle_count);
      part.triangles.assign(scene.triangles.begin() + from, scene.triangles.begin() + to);
      part.source_face.assign(scene.source_face.begin() + from, scene.source_face.begin() + to);
      part.objects = {object};
      part.objects[0].first_triangle = 0;
      take(part);
    }
    return scene.ignored;
  };
}

/// The four numbers at the beginning of a row.
inline std::array<std::uint64_t, 4> key_of(const std::string& row) {
  std::array<std::uint64_t, 4> key{};
  std::istringstream in(row);
  char comma = 0;
  for (std::uint64_t& number : key) in >> number >> comma;
  return key;
}

/// Several lists with one header as one, in order.
inline std::string joined(const std::vector<std::string>& lists) {
  std::vector<std::string> rows;
  std::string header;
  for (const std::string& list : lists) {
    std::istringstream in(list);
    std::getline(in, header);
    for (std::string row; std::getline(in, row);) rows.push_back(row);
  }
  std::ranges::sort(rows, {}, key_of);
  std::string out = header + "\n";
  for (const std::string& row : rows) out += row + "\n";
  return out;
}

}  // namespace farcull
