// A scene as the library takes it, with what collides in it.
#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "experiments/library/farcull.h"
#include "verify/exact.h"

namespace farcull::lab {

struct FlatScene {
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles, starts;
  std::vector<ColliderPair> pairs, neighbour_pairs;  // the truth, by the method `exact`

  /// self: every object is tested against itself as well.
  FlatScene(Scene scene, bool self) {
    for (const Vec3& p : scene.vertices) vertices.insert(vertices.end(), p.data(), p.data() + 3);
    for (const auto& t : scene.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    for (Object& object : scene.objects) {
      starts.push_back(object.first_triangle);
      object.self = self;
    }
    const ExactResult exact = all_colliding_pairs(scene, {});
    for (const TrianglePair& p : exact.pairs) pairs.push_back({p.a, p.b});
    for (const TrianglePair& p : exact.neighbour_pairs) neighbour_pairs.push_back({p.a, p.b});
  }
  ColliderInput input() const { return {vertices, triangles, starts}; }
  bool found_by(Collider& collider) const {
    const ColliderResult found = collider.find(input());
    return found.pairs == pairs && found.neighbour_pairs == neighbour_pairs;
  }
};

}  // namespace farcull::lab
