// Proximity queries: distances between objects, with the points that realise them. One function
// makes a record from a scene. Trees of boxes (core/proximity) find the pairs that may be nearest;
// exact arithmetic (verify/closest.h) decides.
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
#include "verify/near_contact.h"

namespace farcull {

/// objects: every two objects, and each object marked `self` with itself. nearest: each object and
/// its k nearest other objects. all: every pair of triangles within a distance, of different
/// objects, or of one object marked `self` if they are no neighbours.
using DistancePairs = DistanceQuestion::Kind;

/// Which of two objects that do not meet lies inside the other, with all of its points. unknown:
/// not asked, or the objects collide. not_closed: the box of one lies in the box of the other, and
/// this other object is not closed, so it has no inside (verify/inside.h).
using WhichInside = InsideClaim;

/// Tells which object of a scene lies inside another. The scene must not change, since facts about
/// its objects are kept.
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

/// For each *part* of the object (its triangles connected by common vertex positions), the first
/// corner of its first triangle.
std::vector<Vec3> point_of_each_part(const Scene& scene, const Object& object);

struct DistanceOptions {
  DistancePairs pairs = DistancePairs::objects;
  std::size_t k = 1;                                        // with `nearest`
  double within = std::numeric_limits<double>::infinity();  // world units, >= 0; finite with `all`
  bool inside = true;    // tells whether an object is inside another
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
  bool verify = false;   // accounts for every pair that was culled
  /// The most answers; more are an error, since each takes some hundreds of bytes. With `all` it
  /// limits pairs of triangles, counted while they are listed. With `objects` it limits pairs of
  /// objects, counted at the start. If `within` is finite, only pairs of objects whose boxes are at
  /// most `within` apart are counted, and the limit is four times `most_pairs`.
  std::size_t most_pairs = std::size_t{1} << 22;
};

/// The distance of the surfaces of two objects, or with `all` of two triangles.
struct Distance {
  ObjectPair objects;
  TrianglePair triangles;  // the first nearest pair: a triangle of objects.a, and one of objects.b
  Closest closest;
  WhichInside inside = WhichInside::unknown;
};

/// The nearest pairs of the previous frame, sorted by objects, as bounds for this frame. They
/// change the time, never an answer.
using DistanceMemory = std::vector<NearHint>;

struct DistanceRecord {
  DistanceOptions options;
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<Stage> trace;
  std::vector<Distance> distances;  // sorted by objects, then by triangles; with `nearest`, each
                                    // object's k nearest ones are among them
  ProximityCounts counts;
  std::optional<DistanceAccounting> verification;
  double ms = 0;  // time without the verification
};

/// The answer of `nearest` for one object: its nearest other objects, sorted by distance, then by
/// index. At most k; fewer if fewer are within the distance asked for.
struct NearestOfObject {
  std::uint32_t object = 0;
  std::vector<std::size_t> distances;  // indices into DistanceRecord::distances
};
/// The nearest objects of each object with triangles, in order.
std::vector<NearestOfObject> nearest_of_objects(const Scene& scene,
                                                std::span<const Distance> distances, std::size_t k);

/// For each pair of objects its nearest triangles, unless these are farther apart than `within`.
/// threads: 0 for as many as there are cores. Distance::inside is left unknown.
std::vector<Distance> nearest_triangles(const Scene& scene, std::span<const ObjectPair> objects,
                                        double within, unsigned threads,
                                        const Progress& progress = {});

/// If the options ask about no pair of triangles of the scene, says why; else empty.
std::string nothing_asked(const Scene& scene, const DistanceOptions& options);

/// The answers of the record as claims, for account_distances().
std::vector<ClaimedDistance> claims_of(const DistanceRecord& record);

/// Answers what the options ask. Throws Error if options are bad, if they ask about no triangles of
/// the scene, or if there are more answers than most_pairs allows; std::logic_error if validate()
/// would not accept the scene. memory: holds the previous frame, and on return this frame; may be
/// null.
DistanceRecord distances(const Scene& scene, const DistanceOptions& options,
                         const Progress& progress = {}, DistanceMemory* memory = nullptr);

/// A pair of triangles within a distance, with points and normals.
struct TriangleContact {
  ObjectPair objects;
  TrianglePair triangles;
  NearContact contact;
};

/// The pairs of triangles at most `within` apart (finite, >= 0) that distances() with `all` gives:
/// of different objects that are not ignored, or of one object marked `self` if they are no
/// neighbours. Sorted by objects, then by triangles; split into consecutive parts. threads: 0 for
/// as many as there are cores. Throws Error if there are more than `most` contacts.
std::vector<std::vector<TriangleContact>> contacts_within(const Scene& scene, double within,
                                                          unsigned threads, std::size_t most,
                                                          const Progress& progress = {});

}  // namespace farcull
