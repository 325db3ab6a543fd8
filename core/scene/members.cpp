// Marks in an array of the scene's size, so that no list is sorted.
#include "core/scene/members.h"

#include <algorithm>

namespace farcull {

std::vector<std::uint32_t> members_of(std::span<const TrianglePair> pairs, std::size_t triangles) {
  std::vector<std::uint8_t> in(triangles, 0);
  for (const TrianglePair& pair : pairs) in[pair.a] = in[pair.b] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t t = 0; t < in.size(); ++t) {
    if (in[t] != 0) out.push_back(t);
  }
  return out;
}

std::uint64_t count_objects(const Scene& scene, std::span<const std::uint32_t> triangles) {
  std::uint64_t objects = 0;
  std::size_t t = 0;
  for (const Object& object : scene.objects) {
    const std::size_t end = static_cast<std::size_t>(object.first_triangle) + object.triangle_count;
    const std::size_t before = t;
    while (t < triangles.size() && triangles[t] < end) ++t;
    objects += t > before;
  }
  return objects;
}

bool has_self(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const Object& object) { return object.self; });
}

}  // namespace farcull
