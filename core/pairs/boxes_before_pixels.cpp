// The pairs of boxes that FAR pairs finds by blocks say which triangles stay.
#include "core/pairs/boxes_before_pixels.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <vector>

#include "core/boxes/block_join.h"
#include "core/pairs/regions.h"

namespace farcull {
namespace {

// Where the boxes of each two objects' triangles meet.
std::vector<Box> places_of(const Scene& scene, std::span<const TrianglePair> pairs,
                           std::span<const Box> boxes) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Box> places;
  for (const auto& [a, b] : pairs) {
    const auto objects = std::minmax(owner[a], owner[b]);
    places.try_emplace(objects, Box::empty()).first->second.add(intersection(boxes[a], boxes[b]));
  }
  std::vector<Box> out;
  for (const auto& [objects, place] : places) out.push_back(place);
  return out;
}

}  // namespace

NarrowedRegions narrow_regions(const Scene& scene, std::span<const ObjectPair> ignored,
                               unsigned threads, Regions& regions) {
  PairParts parts = split_meetings(scene, 0, threads, false, ignored);
  if (parts.join != Reason::none || parts.rest.crowded) return {};
  const std::vector<TrianglePair> pairs = pairs_of_blocks(scene, parts.blocks, 0, true, threads);
  const std::vector<std::uint32_t> members = members_of(pairs, scene.triangles.size());
  std::vector<std::uint32_t> stay;
  std::ranges::set_union(members, parts.rest.triangles, std::back_inserter(stay));
  std::vector<std::uint32_t> both;
  std::ranges::set_intersection(regions.triangles, stay, std::back_inserter(both));
  regions.triangles = std::move(both);
  regions.places = places_of(scene, pairs, regions.triangle_boxes);
  for (const Box& place : parts.rest.objects) {
    if (!place.is_empty()) regions.places.push_back(place);
  }
  return {.narrowed = true, .pairs = pairs.size()};
}

}  // namespace farcull
