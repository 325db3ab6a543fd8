// A box join finds the partners of each object: the objects whose boxes overlap its box. A triangle
// is kept if its box overlaps the box of a partner of its own object.
#include "core/view/regions.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/boxes/join.h"

namespace farcull {

Regions find_regions(const Scene& scene, const RegionRules& rules) {
  Regions out;
  out.triangle_boxes = triangle_boxes(scene, rules.threads);
  out.object_boxes = object_boxes(scene, out.triangle_boxes);

  std::vector<std::uint32_t> objects(scene.objects.size());
  std::iota(objects.begin(), objects.end(), 0u);
  // Calls box_join() on objects: each object is one item and its own owner.
  std::vector<std::vector<std::uint32_t>> partners(objects.size());
  for (const TrianglePair& pair : box_join(out.object_boxes, objects, objects)) {
    partners[pair.a].push_back(pair.b);
    partners[pair.b].push_back(pair.a);
    out.places.push_back(intersection(out.object_boxes[pair.a], out.object_boxes[pair.b]));
  }
  const auto whole = [&](const Object& object) {
    return rules.self && object.self && object.triangle_count > 1;
  };
  for (const std::uint32_t o : objects)
    if (whole(scene.objects[o])) out.places.push_back(out.object_boxes[o]);

  const std::size_t n = scene.triangles.size(), chunks = chunks_for(n, 4096, rules.threads);
  std::vector<std::vector<std::uint32_t>> found(chunks);
  for_chunks(n, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    const auto ends_before = [&](const Object& object) {
      return std::size_t{object.first_triangle} + object.triangle_count <= begin;
    };
    auto object = std::ranges::partition_point(scene.objects, ends_before);
    for (std::size_t t = begin; t < end; ++object) {
      const bool all = rules.full || whole(*object);
      const auto& others = partners[object - scene.objects.begin()];
      const std::size_t stop =
          std::min<std::size_t>(end, object->first_triangle + std::size_t{object->triangle_count});
      for (; t < stop; ++t) {
        const auto meets = [&](std::uint32_t partner) {
          return overlap(out.triangle_boxes[t], out.object_boxes[partner]);
        };
        if (all || std::ranges::any_of(others, meets))
          found[chunk].push_back(static_cast<std::uint32_t>(t));
      }
    }
  });
  for (const auto& part : found)
    out.triangles.insert(out.triangles.end(), part.begin(), part.end());
  if (rules.full && out.places.empty() && !out.triangles.empty()) {
    Box all = Box::empty();
    for (const Box& box : out.object_boxes) all.add(box);
    out.places.push_back(all);
  }
  return out;
}

Regions regions_of(const Scene& scene, std::span<const TrianglePair> pairs) {
  Regions out;
  out.triangles = members_of(pairs, scene.triangles.size());
  out.triangle_boxes.assign(scene.triangles.size(), Box::empty());
  for (const std::uint32_t t : out.triangles) out.triangle_boxes[t] = grown_box(scene, t, 0);
  const std::vector<std::uint32_t> object = owners(scene);
  std::vector<Box> places(scene.objects.size(), Box::empty());
  for (const auto& [a, b] : pairs) {
    places[object[a]].add(intersection(out.triangle_boxes[a], out.triangle_boxes[b]));
  }
  for (const Box& place : places) {
    if (!place.is_empty()) out.places.push_back(place);
  }
  return out;
}

}  // namespace farcull
