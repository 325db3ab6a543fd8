// How many nearest neighbours a discrete Voronoi diagram loses (core/proximity/voronoi.h), measured
// by exact distances.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/proximity/voronoi.h"
#include "core/scene/scene.h"

namespace farcull {

/// The other objects at the least distance of an object, by exact arithmetic.
struct NearestObjects {
  std::vector<std::uint32_t> objects;   // ascending; none where there is no other one
  std::vector<TrianglePair> triangles;  // of each of these, the first pair at that distance
};

/// For each object: ProximityTrees (core/proximity/near_pairs.h) leave the pairs that can be
/// nearest, and exact arithmetic decides (verify/closest.h). Precondition: the scene satisfies
/// validate().
std::vector<NearestObjects> nearest_objects(const Scene& scene, const Progress& progress = {});

/// What a diagram keeps and what it loses.
struct DiagramCounts {
  std::uint64_t objects = 0;  // that have a nearest neighbour
  std::uint64_t missed = 0;   // of these, with none of the nearest ones among their neighbours
  std::uint64_t kept = 0;     // pairs of objects that are neighbours
  std::uint64_t missed_triangles = 0;  // pairs of NearestObjects::triangles that are not kept, each
                                       // for each of its objects; of the reliable form
  std::uint64_t kept_triangles = 0;    // pairs of triangles; of the reliable form
  VoronoiCounts work;
  double ms = 0;
};
DiagramCounts measure_published(const Scene& scene, const std::vector<NearestObjects>& truth,
                                const VoronoiOptions& options, const Progress& progress = {});
DiagramCounts measure_reliable(const Scene& scene, const std::vector<NearestObjects>& truth,
                               const VoronoiOptions& options, const Progress& progress = {});

}  // namespace farcull
