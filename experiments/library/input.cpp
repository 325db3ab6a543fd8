// Checks what a caller gives, and copies it into a scene.
#include "experiments/library/input.h"

#include <algorithm>
#include <limits>
#include <string>

namespace farcull {

void take(const ColliderInput& input, bool self, const std::vector<bool>& self_objects,
          Scene& scene) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (input.vertices.size() % 3 != 0 || input.vertices.size() / 3 > kMost)
    throw Error("vertices", "are not three doubles for each of at most 2^32 - 1 vertices",
                "give x, y, z of each");
  if (input.triangles.size() % 3 != 0 || input.triangles.size() / 3 > kMost)
    throw Error("triangles", "are not three indices for each of at most 2^32 - 1 triangles",
                "give three indices of each");
  const auto count = static_cast<std::uint32_t>(input.triangles.size() / 3);
  scene.vertices.resize(input.vertices.size() / 3);
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    scene.vertices[v] = {input.vertices[3 * v], input.vertices[3 * v + 1],
                         input.vertices[3 * v + 2]};
    if (scene.vertices[v].allFinite()) continue;
    throw Error("vertices", "vertex " + std::to_string(v) + " is not finite",
                "give finite coordinates");
  }
  scene.triangles.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = input.triangles[3 * t + k];
      scene.triangles[t][k] = v;
      if (v < scene.vertices.size()) continue;
      throw Error("triangles",
                  "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                      std::to_string(scene.vertices.size()),
                  "correct the index");
    }
  }
  scene.source_face.resize(count);
  const std::size_t objects = std::max<std::size_t>(input.object_starts.size(), 1);
  if (!self_objects.empty() && self_objects.size() != objects) {
    throw Error("self_objects",
                "are " + std::to_string(self_objects.size()) + " for " + std::to_string(objects) +
                    " objects",
                "give one for each object, or none");
  }
  scene.objects.resize(objects);
  for (std::size_t o = 0; o < objects; ++o) {
    const std::uint32_t first = input.object_starts.empty() ? 0 : input.object_starts[o];
    const std::uint32_t end = o + 1 < objects ? input.object_starts[o + 1] : count;
    if ((o == 0 && first != 0) || first > end) {
      throw Error("object_starts",
                  "object " + std::to_string(o) + " starts at triangle " + std::to_string(first) +
                      " and ends before " + std::to_string(end),
                  "begin with 0, and let no start be below the one before it or beyond the number "
                  "of triangles");
    }
    scene.objects[o].first_triangle = first;
    scene.objects[o].triangle_count = end - first;
    scene.objects[o].self = self || (!self_objects.empty() && self_objects[o]);
  }
}

}  // namespace farcull
