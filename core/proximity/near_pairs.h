// Potential neighbours: for two objects, the pairs of triangles that can be nearest.
//
// The potential neighbour set (PNS) of Sud, Govindaraju, Gayle, Kabul and Manocha (Fast Proximity
// Computation Among Deformable Models using Discrete Voronoi Diagrams, SIGGRAPH 2006) rests on a
// grid, whose error can lose the nearest pair. Here it has every pair whose lower bound is at most
// a certified upper bound of the least distance, so a culled pair is provably farther apart.
//
// Bounds hold for the coordinates as given, which may be any finite doubles. Nothing is decided
// exactly here; verify/closest.h does that.
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

/// The Error for more than `most` pairs of triangles or of objects (`what`) within a distance.
Error too_many_within(std::size_t most, const std::string& what);

/// Two triangles, of objects.a and of objects.b, that are probably near, such as the nearest ones
/// of the frame before.
struct NearHint {
  ObjectPair objects;
  TrianglePair triangles;
};

/// The nearest of some pairs of triangles, decided exactly; of several nearest ones, the first. It
/// also proves that other pairs are no nearer: triangles s of the first object and t of the second
/// are at least as far apart if reach(s) <= start(t), and farther if reach(s) < start(t).
struct SettledPair {
  TrianglePair pair;
  double distance = 0;  // world units, not below the exact one; 0 only if the triangles meet
  std::function<double(std::uint32_t)> reach, start;  // of a triangle; empty if the distance is 0
};
/// Exact arithmetic for a search in which bounds in doubles cannot decide which of many pairs is
/// the nearest. Several threads call it at once, with sorted pairs.
using Settle = std::function<SettledPair(std::span<const TrianglePair>)>;

/// The pairs of triangles of two objects that can be nearest. If both are the same object: its own
/// pairs, except neighbours (triangles that share a vertex position).
struct NearPairs {
  ObjectPair objects;
  /// Some pair of triangles of these objects is at most this far apart (world units); infinite if
  /// there is no pair, or none within the limit asked for.
  double upper = std::numeric_limits<double>::infinity();
  /// If the least distance is at most the limit: all pairs at that distance. But if triangles meet,
  /// or if the trees have exact arithmetic, only the first is sure to be here. Sorted, each once.
  std::vector<TrianglePair> pairs;
};

/// The number of boxes and pairs that were examined; it shows how well culling works.
struct ProximityCounts {
  std::uint64_t box_pairs = 0;       // pairs of boxes whose gap was compared with a bound
  std::uint64_t triangle_pairs = 0;  // pairs of triangles whose distance was bounded
  std::uint64_t kept = 0;            // pairs of triangles left to exact arithmetic

  void add_work(const ProximityCounts& other) {
    box_pairs += other.box_pairs;
    triangle_pairs += other.triangle_pairs;
  }
};

/// Trees of boxes over the objects of a scene, and the questions that they answer. Precondition of
/// all functions: the scene satisfies validate() and does not change before the trees are gone, and
/// the thread rounds to nearest and keeps subnormals.
class ProximityTrees {
 public:
  /// threads: 0 for as many as there are cores; changes no answer. settle: may be empty; else
  /// searches call it when many pairs may be nearest, and replace these by the settled pair.
  explicit ProximityTrees(const Scene& scene, unsigned threads = 0, Settle settle = {});
  ~ProximityTrees();

  /// Answers each question, in their order. within: world units, >= 0, may be infinite: pairs that
  /// are farther apart need not be found. hints: empty, or one for each question: a pair of
  /// triangles of these objects that is probably near, such as the nearest one of the frame before.
  /// Its distance bounds the answer from the start; no nearest pair is lost by a hint. A hint of
  /// other triangles, in the other order, or of neighbours is ignored. Throws std::logic_error for
  /// objects that the scene does not have or in the other order, for another number of hints, and
  /// for a limit that is negative or NaN; Error where one question leaves more than 100 million
  /// pairs.
  std::vector<NearPairs> near_pairs(std::span<const ObjectPair> questions, double within,
                                    std::span<const std::optional<TrianglePair>> hints,
                                    const Progress& progress = {}) const;

  /// Finds for each object with triangles its k nearest others, and all others as near as the k-th.
  /// Returns these pairs of objects and perhaps more, sorted, each once, with the pairs of
  /// triangles that can be nearest. Objects farther away than `within` need not be found. Throws as
  /// near_pairs().
  std::vector<NearPairs> nearest_objects(std::size_t k, double within,
                                         const Progress& progress = {}) const;
  /// As above, but of others at the same distance only those with the lowest numbers need be found.
  /// hints: in any order; of hints for the same two objects the first one counts. If hints name
  /// k others of an object, their distances bound its answer from the start.
  std::vector<NearPairs> nearest_objects(std::size_t k, double within,
                                         std::span<const NearHint> hints,
                                         const Progress& progress = {}) const;

  /// All pairs of objects at most `within` apart, also each object marked `self` with itself, and
  /// perhaps more. Sorted, each once. Throws std::logic_error for an invalid limit, and Error if
  /// there are more than `most` pairs.
  std::vector<ObjectPair> objects_within(double within, std::size_t most) const;

  /// All pairs of triangles at most `within` apart, of different objects, or of one `self` object
  /// if they are no neighbours; and a few that are farther only by rounding errors. Sorted,
  /// distinct. Precondition: within is finite. Throws std::logic_error for an invalid limit, and
  /// Error, which names `most`, if there are more than `most` + `spare` pairs. Memory: at most some
  /// tens of bytes for each pair, and for some thousands of other pairs.
  std::vector<TrianglePair> pairs_within(double within, std::size_t most,
                                         const Progress& progress = {},
                                         std::size_t spare = 0) const;

  /// The sums over all calls so far.
  ProximityCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
