// Proximity queries: distances between objects with the points that realise them, as one function
// from a scene to a record. Potential neighbours (core/proximity) cull, exact arithmetic
// (verify/closest.h) decides.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/stage.h"
#include "core/proximity/near_pairs.h"
#include "core/scene/scene.h"
#include "verify/certificate/integer_distance.h"
#include "verify/closest.h"
#include "verify/distance_accounting.h"

namespace farcull {

/// objects: every two objects, and one that is `self` with itself. nearest: each object and its k
/// nearest others. all: every pair of triangles within a distance, of different objects, and of one
/// that is `self` where they are no neighbours.
using DistancePairs = DistanceQuestion::Kind;

/// Which of two objects that do not meet lies inside the other, with all of its points and so all
/// of its parts. unknown: not asked, or the objects collide. not_closed: the box of one lies in
/// that of the other, which has no inside (verify/inside.h).
using WhichInside = InsideClaim;

/// Tells which object of a scene lies inside another. The scene must not change: what was found
/// about an object is kept.
class Insides {
 public:
  explicit Insides(const Scene& scene);
  ~Insides();
  Insides(const Insides&) = delete;
  Insides& operator=(const Insides&) = delete;

  /// Precondition: the objects differ, have triangles and share no point. May be called by several
  /// threads at once.
  WhichInside which(std::uint32_t a, std::uint32_t b) const;

 private:
  struct OfObject;
  bool contains(std::uint32_t outer, std::uint32_t inner, bool& not_closed) const;

  const Scene& scene_;
  std::unique_ptr<OfObject[]> objects_;
};

struct DistanceOptions {
  DistancePairs pairs = DistancePairs::objects;
  std::size_t k = 1;                                        // with `nearest`
  double within = std::numeric_limits<double>::infinity();  // world units, >= 0; finite with `all`
  bool inside = true;    // tells whether an object is inside another
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
  bool verify = false;   // accounts for every pair that was culled
  /// The most answers; more are an error, since each takes some hundreds of bytes. With `all`:
  /// pairs of triangles, which are counted while they are listed. With `objects`: pairs of objects,
  /// which are counted at the start; four times as many where `within` is finite.
  std::size_t most_pairs = std::size_t{1} << 22;
};

/// The distance of the surfaces of two objects, or of two triangles of them.
struct Distance {
  ObjectPair objects;
  TrianglePair triangles;  // the first of the nearest pairs, of objects.a and objects.b
  Closest closest;
  WhichInside inside = WhichInside::unknown;
};

/// The nearest pairs of an earlier frame, as bounds for this one: they change the time that it
/// takes, never an answer.
struct DistanceMemory {
  std::vector<ObjectPair> objects;    // sorted
  std::vector<TrianglePair> nearest;  // of each of them
};

struct DistanceRecord {
  DistanceOptions options;
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<Stage> trace;
  std::vector<Distance> distances;  // sorted by objects, then by triangles; `nearest`: each
                                    // object's neighbours are those that name it
  ProximityCounts counts;
  std::optional<DistanceAccounting> verification;
  double ms = 0;  // of all but the verification
};

/// The answer of `nearest` about one object: its neighbours, the nearest first, at equal distance
/// the lower object first; at most k, fewer if fewer are within the distance asked for.
struct NearestOfObject {
  std::uint32_t object = 0;
  std::vector<std::size_t> distances;  // indices into those of the record
};
/// For each object with triangles, in order.
std::vector<NearestOfObject> nearest_of_objects(const Scene& scene,
                                                std::span<const Distance> distances, std::size_t k);

/// Why the question is about no two triangles of the scene; empty if it is about some.
std::string nothing_asked(const Scene& scene, const DistanceOptions& options);

/// What the record claims, for account_distances().
std::vector<ClaimedDistance> claims_of(const DistanceRecord& record);

/// Throws Error for options that are bad, for a scene in which nothing is asked, and where there
/// are more answers than most_pairs allows; std::logic_error where the scene breaks validate().
/// memory: holds the previous frame, and on return this one; may be null.
DistanceRecord distances(const Scene& scene, const DistanceOptions& options,
                         const Progress& progress = {}, DistanceMemory* memory = nullptr);

}  // namespace farcull
