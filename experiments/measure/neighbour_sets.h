// Potential neighbour sets (PNS): for each object the objects and triangles that may hold its
// nearest neighbour. Four methods compute such sets. Their sizes are compared, and exact distances
// show which nearest neighbours they lose.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "core/voronoi/voronoi.h"

namespace farcull {

/// The objects nearest to one object, all at the same distance by exact arithmetic.
struct NearestObjects {
  std::vector<std::uint32_t> objects;   // ascending; empty if there is no other object
  std::vector<TrianglePair> triangles;  // for each of `objects` the first pair at that distance
};

/// For each object: ProximityTrees (core/proximity/near_pairs.h) leave the pairs that can be
/// nearest, and exact arithmetic decides (verify/closest.h). Precondition: the scene satisfies
/// validate().
std::vector<NearestObjects> nearest_objects(const Scene& scene, const Progress& progress = {});

/// boxes: one box for each object (object_boxes()). trees: what `farcull distance --pairs nearest`
/// hands to exact arithmetic (core/proximity/near_pairs.h). voronoi, voronoi_reliable: the discrete
/// Voronoi diagram as published, and the form of it that loses nothing (core/voronoi/voronoi.h).
enum class NeighbourMethod : std::uint8_t { boxes, trees, voronoi, voronoi_reliable };
std::string to_string(NeighbourMethod method);
/// Whether the method has a resolution: true for the two diagrams.
bool has_cells(NeighbourMethod method);

struct NeighbourOptions {
  NeighbourMethod method = NeighbourMethod::trees;
  int resolution = 64;   // of the diagrams, in cells along the longest side of the scene
  double widening = 1;   // of the reliable form (VoronoiOptions)
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
  std::uint64_t most_pairs = std::uint64_t{1} << 25;  // VoronoiOptions::most_pairs; 268 MB
};

/// The sets that a method leaves. Either `pairs` or `left` holds the triangles.
struct NeighbourSets {
  std::vector<ObjectPair> objects;  // sorted, each once: either may hold the other's nearest
  /// trees, voronoi_reliable: the pairs of triangles that may be nearest, sorted, each once.
  bool has_pairs = false;
  std::vector<TrianglePair> pairs = {};
  /// boxes, voronoi: for each pair of objects, how many triangles of a and of b are left.
  std::vector<std::array<std::uint64_t, 2>> left = {};
  /// Why there are no sets: the diagram would keep too many pairs, or memory ran out. Else empty.
  std::string left_out = {};
};

/// The sets of a scene that satisfies validate(). Throws Error for options that are out of range.
NeighbourSets neighbour_sets(const Scene& scene, const NeighbourOptions& options,
                             const Progress& progress = {});

/// The set of one object: how many other objects, and triangles of other objects.
struct SetSize {
  std::uint64_t objects = 0, triangles = 0;
};
/// One value per object of the scene.
std::vector<SetSize> set_sizes(const Scene& scene, const NeighbourSets& sets);

/// Whether the pair of objects is left, in either order.
bool has_objects(const NeighbourSets& sets, std::uint32_t a, std::uint32_t b);

/// Sizes of the sets, and how many nearest neighbours they miss. A nearest pair of triangles is
/// missed if the sets do not hold it; if they hold no pairs of triangles, the pair of objects
/// decides.
struct NeighbourSizes {
  std::uint64_t with_nearest = 0;    // objects that have a nearest neighbour
  std::uint64_t missed = 0;          // objects whose set holds none of their nearest objects
  std::uint64_t nearest_pairs = 0;   // nearest pairs of triangles, summed over the objects
  std::uint64_t missed_pairs = 0;    // nearest pairs that the sets do not hold
  std::uint64_t object_pairs = 0;    // pairs of objects that are left
  std::uint64_t triangle_pairs = 0;  // pairs of triangles that are left
  /// How many objects, and triangles of other objects, the set of an object holds: the sum, the
  /// median (the lower of the two in the middle if the number is even) and the largest, over the
  /// objects with a nearest neighbour.
  std::uint64_t set_objects = 0, median_objects = 0, most_objects = 0;
  std::uint64_t set_triangles = 0, median_triangles = 0, most_triangles = 0;
  FARCULL_FIELDS(with_nearest, missed, nearest_pairs, missed_pairs, object_pairs, triangle_pairs,
                 set_objects, median_objects, most_objects, set_triangles, median_triangles,
                 most_triangles)
};
/// truth: nearest_objects() of the scene. Precondition: there are sets.
NeighbourSizes sizes_of(const Scene& scene, const NeighbourSets& sets,
                        const std::vector<NearestObjects>& truth);

}  // namespace farcull
