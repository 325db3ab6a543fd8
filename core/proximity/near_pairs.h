// Computes potential neighbours: the pairs of triangles of two objects that can be nearest.
//
// The potential neighbour set (PNS) of Sud, Govindaraju, Gayle, Kabul and Manocha (Fast Proximity
// Computation Among Deformable Models using Discrete Voronoi Diagrams, SIGGRAPH 2006) comes from a
// grid, whose error can lose the nearest pair. The set computed here contains every pair whose
// lower bound is at most a certified upper bound of the least distance. So each culled pair is
// provably farther apart than the nearest pair.
//
// The bounds hold for the given coordinates, which may be any finite doubles. verify/closest.h then
// decides by exact arithmetic which pair is the nearest.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/stage.h"
#include "core/scene/scene.h"

namespace farcull {

/// Returns the Error for more than `most` pairs within a distance. what: "triangles" or "objects".
Error too_many_within(std::size_t most, const std::string& what);

/// A triangle of objects.a and one of objects.b that are probably near each other, such as the
/// nearest pair of the previous frame.
struct NearHint {
  ObjectPair objects;
  TrianglePair triangles;
};

/// The nearest of several given pairs of triangles, found by exact arithmetic; the first one if
/// their distances are equal. The functions reach and start prove facts about other pairs. Let s be
/// a triangle of the first object and t one of the second. If reach(s) <= start(t), they are at
/// least as far apart as the settled pair. If reach(s) < start(t), they are farther apart.
struct SettledPair {
  TrianglePair pair;
  double distance = 0;  // world units; at least the exact distance; 0 only if the triangles meet
  std::function<double(std::uint32_t)> reach, start;  // empty if the distance is 0
};
/// Returns the nearest of the given pairs, by exact arithmetic. Searches call this function if
/// bounds in doubles cannot decide. The given pairs are sorted. Several threads may call the
/// function at once.
using Settle = std::function<SettledPair(std::span<const TrianglePair>)>;

/// The pairs of triangles of two objects that can be nearest. If objects.a == objects.b, these are
/// pairs within the object, except neighbours (triangles that share a vertex position).
struct NearPairs {
  ObjectPair objects;
  /// Some pair of triangles of these objects is at most this far apart (world units). Infinite if
  /// no pair is within the limit of the search.
  double upper = std::numeric_limits<double>::infinity();
  /// Contains all pairs at the least distance, if this distance is at most the limit of the search.
  /// If triangles meet, or if the trees have a Settle, the list may have only the first of these
  /// pairs. Sorted, distinct.
  std::vector<TrianglePair> pairs;
};

struct ProximityCounts {
  std::uint64_t box_pairs = 0;       // pairs of boxes whose gap was compared with a bound
  std::uint64_t triangle_pairs = 0;  // pairs of triangles whose distance was bounded
  std::uint64_t kept = 0;            // pairs of triangles left to exact arithmetic

  void add_work(const ProximityCounts& other) {
    box_pairs += other.box_pairs;
    triangle_pairs += other.triangle_pairs;
  }
};

/// Trees of boxes over the objects of a scene, which answer questions about distances.
/// Preconditions of all functions:
/// - The scene satisfies validate(), and does not change while the trees exist.
/// - The calling thread rounds to nearest and keeps subnormals.
class ProximityTrees {
 public:
  /// threads: 0 means one per core. The number of threads changes no answer. settle: may be empty.
  /// Otherwise, a search that keeps many pairs calls settle and keeps only the settled pair.
  explicit ProximityTrees(const Scene& scene, unsigned threads = 0, Settle settle = {});
  ~ProximityTrees();

  /// Returns an answer for each question, in the order of the questions. within: a limit in world
  /// units, >= 0, may be infinite; pairs that are farther apart need not be found. hints: empty, or
  /// one for each question: a pair of triangles that is probably near (NearHint). The distance of a
  /// hint bounds the answer from the start. Even a bad hint loses no nearest pair. A hint is used
  /// only if hint.a < hint.b, hint.a is in objects.a, hint.b is in objects.b, and the two triangles
  /// are no neighbours. Throws std::logic_error for objects that the scene does not have, for
  /// objects.a > objects.b, for a wrong number of hints, and for a limit that is negative or NaN.
  /// Throws Error if more than 100 million pairs may be nearest in one question.
  std::vector<NearPairs> near_pairs(std::span<const ObjectPair> questions, double within,
                                    std::span<const std::optional<TrianglePair>> hints,
                                    const Progress& progress = {}) const;

  /// Finds for each object its k nearest other objects, and all others as near as the k-th. Returns
  /// these pairs of objects, and perhaps more, with the pairs of triangles that can be nearest.
  /// Sorted, distinct. Objects farther away than `within` need not be found. Throws like
  /// near_pairs().
  std::vector<NearPairs> nearest_objects(std::size_t k, double within,
                                         const Progress& progress = {}) const;
  /// Does the same, except for ties: among other objects at equal distances, only those with the
  /// lowest numbers need be found. hints: in any order. If two objects have several hints, the
  /// first hint is used. If an object has k hints, their distances bound its answer from the start.
  std::vector<NearPairs> nearest_objects(std::size_t k, double within,
                                         std::span<const NearHint> hints,
                                         const Progress& progress = {}) const;

  /// Returns all pairs of objects at most `within` apart, and perhaps more. An object marked `self`
  /// is paired with itself. Sorted, distinct. Throws std::logic_error if `within` is negative or
  /// NaN, and Error if there are more than `most` pairs.
  std::vector<ObjectPair> objects_within(double within, std::size_t most) const;

  /// Returns all pairs of triangles at most `within` apart. Rounding errors may add pairs that are
  /// slightly farther apart. The triangles belong to two objects, or they are no neighbours and
  /// belong to one object marked `self`. Sorted, distinct. Throws std::logic_error if `within` is
  /// negative, infinite or NaN. Throws Error, which names `most`, if there are more than `most` +
  /// `spare` pairs. Memory: some tens of bytes per pair, plus room for some thousands of pairs.
  std::vector<TrianglePair> pairs_within(double within, std::size_t most,
                                         const Progress& progress = {},
                                         std::size_t spare = 0) const;

  /// Returns the sums over all calls so far.
  ProximityCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
