// Computes potential neighbour sets (PNS) by four methods. The set of an object contains the other
// objects that may be nearest to the object, and the triangles that may be nearest. This file also
// counts the sizes of the sets, and the exact nearest neighbours that a method loses.
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

/// The objects nearest to one object. All have the same distance by exact arithmetic.
struct NearestObjects {
  std::vector<std::uint32_t> objects;   // ascending; empty if there is no other object
  std::vector<TrianglePair> triangles;  // the first nearest pair with each of `objects`
};

/// Returns the nearest objects of each object, by exact arithmetic (verify/closest.h).
/// Precondition: the scene satisfies validate().
std::vector<NearestObjects> nearest_objects(const Scene& scene, const Progress& progress = {});

/// boxes: one box for each object (object_boxes()).
/// trees: trees of boxes, as in `farcull distance --pairs nearest` (core/proximity/near_pairs.h).
/// voronoi: the discrete Voronoi diagram as published (core/voronoi/voronoi.h).
/// voronoi_reliable: a form of this diagram that loses no nearest neighbour.
enum class NeighbourMethod : std::uint8_t { boxes, trees, voronoi, voronoi_reliable };
std::string to_string(NeighbourMethod method);
/// True if the method is a Voronoi diagram, which has cells.
bool has_cells(NeighbourMethod method);

struct NeighbourOptions {
  NeighbourMethod method = NeighbourMethod::trees;
  int resolution = 64;   // cells of a Voronoi diagram along the longest side of the scene
  double widening = 1;   // for voronoi_reliable (VoronoiOptions)
  unsigned threads = 0;  // 0: one per core; any number gives the same answer
  std::uint64_t most_pairs = std::uint64_t{1} << 25;  // VoronoiOptions::most_pairs (268 MB)
};

/// The sets of all objects by one method. The triangles are in `pairs` or in `left`.
struct NeighbourSets {
  std::vector<ObjectPair> objects;  // pairs that may be nearest; sorted, each once
  /// For trees and voronoi_reliable: the pairs of triangles that may be nearest, sorted, each once.
  bool has_pairs = false;
  std::vector<TrianglePair> pairs = {};
  /// For boxes and voronoi: for each pair of objects (a, b), the number of triangles of a that may
  /// be nearest to b, then the number of triangles of b that may be nearest to a.
  std::vector<std::array<std::uint64_t, 2>> left = {};
  /// Why there are no sets: too many pairs, or not enough memory. Empty if there are sets.
  std::string left_out = {};
};

/// Computes the sets. Precondition: the scene satisfies validate(). Throws Error for options that
/// are out of range.
NeighbourSets neighbour_sets(const Scene& scene, const NeighbourOptions& options,
                             const Progress& progress = {});

/// The number of objects, and of triangles, in the set of one object.
struct SetSize {
  std::uint64_t objects = 0, triangles = 0;
};
/// Returns one value per object of the scene.
std::vector<SetSize> set_sizes(const Scene& scene, const NeighbourSets& sets);

/// True if the pair (a, b) or (b, a) is in sets.objects.
bool has_objects(const NeighbourSets& sets, std::uint32_t a, std::uint32_t b);

/// Sizes of the sets, and how many nearest neighbours the sets miss. A nearest pair of triangles is
/// missed if NeighbourSets::pairs lacks the pair. If the method gives no pairs of triangles, a
/// nearest pair of triangles is missed if its pair of objects is missed.
struct NeighbourSizes {
  std::uint64_t with_nearest = 0;    // objects that have a nearest neighbour
  std::uint64_t missed = 0;          // objects whose set holds none of their nearest objects
  std::uint64_t nearest_pairs = 0;   // nearest pairs of triangles, summed over the objects
  std::uint64_t missed_pairs = 0;    // nearest pairs of triangles that are missed
  std::uint64_t object_pairs = 0;    // pairs of objects in the sets
  std::uint64_t triangle_pairs = 0;  // pairs of triangles in the sets
  /// Numbers of objects and of triangles in a set: sum, lower median and maximum, over the objects
  /// with a nearest neighbour.
  std::uint64_t set_objects = 0, median_objects = 0, most_objects = 0;
  std::uint64_t set_triangles = 0, median_triangles = 0, most_triangles = 0;
  FARCULL_FIELDS(with_nearest, missed, nearest_pairs, missed_pairs, object_pairs, triangle_pairs,
                 set_objects, median_objects, most_objects, set_triangles, median_triangles,
                 most_triangles)
};
/// truth: the result of nearest_objects() for the scene. Precondition: sets.left_out is empty.
NeighbourSizes sizes_of(const Scene& scene, const NeighbourSets& sets,
                        const std::vector<NearestObjects>& truth);

}  // namespace farcull
