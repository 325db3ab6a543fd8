// Scenes as the library takes them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/library/farcull.h"

namespace farcull {

/// A scene as flat arrays.
struct Flat {
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles, starts;

  explicit Flat(const Scene& scene) {
    for (const Vec3& p : scene.vertices) vertices.insert(vertices.end(), p.data(), p.data() + 3);
    for (const auto& t : scene.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    for (const Object& object : scene.objects) starts.push_back(object.first_triangle);
  }
  ColliderInput input() const { return {vertices, triangles, starts}; }
};

}  // namespace farcull
