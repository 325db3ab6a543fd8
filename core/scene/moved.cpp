#include "core/scene/moved.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace farcull {

bool MovedCorners::update(const Scene& scene) {
  // If an allocation below throws, the copy is partial, so it is invalidated first.
  const bool known = std::exchange(known_, false);
  std::vector<Part> objects;
  objects.reserve(scene.objects.size());
  for (const Object& o : scene.objects) {
    objects.push_back({o.first_triangle, o.triangle_count, o.self});
  }
  const std::size_t n = scene.vertices.size();
  const bool same =
      known && vertices_.size() == n && objects_ == objects && triangles_ == scene.triangles;
  any_ = false;
  if (same) {
    moved_.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
      // By their bits: -0.0 and 0.0 count as different, which costs a comparison at most.
      const bool moved =
          std::memcmp(vertices_[v].data(), scene.vertices[v].data(), 3 * sizeof(double)) != 0;
      moved_[v] = moved;
      any_ |= moved;
      if (moved) vertices_[v] = scene.vertices[v];
    }
  } else {
    objects_ = std::move(objects);
    triangles_ = scene.triangles;
    vertices_ = scene.vertices;
  }
  known_ = true;
  return same;
}

std::vector<std::uint8_t> MovedCorners::triangles(const Scene& scene) const {
  std::vector<std::uint8_t> out(scene.triangles.size(), 0);
  if (!any_) return out;
  for (std::uint32_t t = 0; t < out.size(); ++t) out[t] = triangle(scene, t);
  return out;
}

bool mostly_unmoved(const Scene& scene, const MovedCorners& moved,
                    std::span<const TrianglePair> pairs) {
  constexpr std::size_t kSampled = 256;
  if (pairs.empty()) return !moved.any();
  const std::size_t count = std::min(kSampled, pairs.size());
  std::size_t unmoved = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const TrianglePair& pair = pairs[pairs.size() * k / count];
    unmoved += !moved.triangle(scene, pair.a) && !moved.triangle(scene, pair.b);
  }
  return 2 * unmoved >= count;
}

}  // namespace farcull
