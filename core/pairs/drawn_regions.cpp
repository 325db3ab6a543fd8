// Boxes before pixels: which pairs the boxes of a scene leave, and what has to be drawn for these.
#include <optional>
#include <vector>

#include "core/boxes/oriented.h"
#include "core/pairs/regions.h"

namespace farcull {

std::optional<std::vector<TrianglePair>> pairs_of_boxes(const Scene& scene,
                                                        std::span<const ObjectPair> ignored,
                                                        bool neighbours, unsigned threads) {
  const PairParts parts = split_meetings(scene, 0, threads, false, ignored);
  if (parts.join != Reason::none || !parts.rest.triangles.empty() || parts.blocks.oriented) {
    return std::nullopt;
  }
  return pairs_of_blocks(scene, parts.blocks, 0, neighbours, threads);
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
