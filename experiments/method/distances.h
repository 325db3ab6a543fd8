// Finds distances between objects, with nearest points. Trees of boxes (core/proximity) find the
// pairs of triangles that may be nearest. Exact arithmetic (verify/closest.h) selects the nearest
// pair.
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

/// objects: every two objects, and each object marked `self` with itself.
/// nearest: each object and its k nearest other objects.
/// all: every pair of triangles within a distance. The triangles are in different objects, or in
///   one object marked `self` and are not neighbours.
using DistancePairs = DistanceQuestion::Kind;

/// Which of two objects lies completely inside the other. unknown: not computed, or the objects
/// collide. not_closed: the box of one object lies in the box of the other, but the object with the
/// larger box is not closed, so it has no inside (verify/inside.h).
using WhichInside = InsideClaim;

/// Finds which of two objects of a scene lies inside the other. Caches results, so the scene must
/// not change.
class Insides {
 public:
  explicit Insides(const Scene& scene);
  ~Insides();
  Insides(const Insides&) = delete;
  Insides& operator=(const Insides&) = delete;

  /// Precondition: a and b differ, have triangles and share no point. Several threads may call this
  /// at once.
  WhichInside which(std::uint32_t a, std::uint32_t b) const;

 private:
  struct OfObject;
  bool contains(std::uint32_t outer, std::uint32_t inner, bool& not_closed) const;

  const Scene& scene_;
  std::unique_ptr<OfObject[]> objects_;
};

/// Returns one point of each *part* of the object: the first corner of the part's first triangle. A
/// part is a set of triangles that are connected by common vertex positions.
std::vector<Vec3> point_of_each_part(const Scene& scene, const Object& object);

struct DistanceOptions {
  DistancePairs pairs = DistancePairs::objects;
  std::size_t k = 1;                                        // only for `nearest`
  double within = std::numeric_limits<double>::infinity();  // world units, >= 0; finite with `all`
  bool inside = true;    // find whether one object is inside the other
  unsigned threads = 0;  // 0: one per core; any number gives the same answer
  bool verify = false;   // check every pair exactly (account_distances())
  /// The largest number of answers. More answers are an error, since each answer takes some
  /// hundreds of bytes.
  /// - `all`: limits pairs of triangles.
  /// - `objects` and an infinite `within`: limits pairs of objects.
  /// - `objects` and a finite `within`: the number of pairs of objects whose boxes are at most
  ///   `within` apart is limited to 4 * most_pairs.
  std::size_t most_pairs = std::size_t{1} << 22;
};

/// The distance of the surfaces of two objects. With `all`, the distance of two triangles.
struct Distance {
  ObjectPair objects;
  TrianglePair triangles;  // nearest triangles of objects.a and objects.b; in a tie the first pair
  Closest closest;
  WhichInside inside = WhichInside::unknown;
};

/// The nearest pairs of the previous frame, sorted by objects. These pairs give bounds, which save
/// time and never change an answer.
using DistanceMemory = std::vector<NearHint>;

struct DistanceRecord {
  DistanceOptions options;
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<Stage> trace;
  std::vector<Distance> distances;  // sorted by objects, then by triangles
  ProximityCounts counts;
  std::optional<DistanceAccounting> verification;
  double ms = 0;  // time without the verification
};

/// The answer of `nearest` for one object: at most k distances to other objects, sorted by
/// distance, then by the other object.
struct NearestOfObject {
  std::uint32_t object = 0;
  std::vector<std::size_t> distances;  // indices into DistanceRecord::distances
};
/// Returns the nearest objects of each object that has triangles, in the order of the objects.
std::vector<NearestOfObject> nearest_of_objects(const Scene& scene,
                                                std::span<const Distance> distances, std::size_t k);

/// Returns the nearest triangles of each pair of objects, except pairs farther apart than `within`.
/// threads: 0 for as many as there are cores. Distance::inside is left unknown.
std::vector<Distance> nearest_triangles(const Scene& scene, std::span<const ObjectPair> objects,
                                        double within, unsigned threads,
                                        const Progress& progress = {});

/// Returns why the options select no pair of triangles of the scene, or "" if they select a pair.
std::string nothing_asked(const Scene& scene, const DistanceOptions& options);

/// Returns the answers of the record as claims, for account_distances().
std::vector<ClaimedDistance> claims_of(const DistanceRecord& record);

/// Computes the distances that the options select. memory: the nearest pairs of the previous frame;
/// on return the nearest pairs of this frame; may be null. Throws Error if options are bad, if they
/// select no pair of triangles, or if there are more answers than most_pairs allows. Throws
/// std::logic_error if validate() would not accept the scene.
DistanceRecord distances(const Scene& scene, const DistanceOptions& options,
                         const Progress& progress = {}, DistanceMemory* memory = nullptr);

/// A pair of triangles within a distance, with points and normals.
struct TriangleContact {
  ObjectPair objects;
  TrianglePair triangles;
  NearContact contact;
};

/// Returns the pairs of triangles that distances() returns for `all`, sorted by objects, then by
/// triangles, and split into consecutive parts. within: world units, finite, >= 0. threads: 0 for
/// as many as there are cores. Throws Error if there are more than `most` contacts.
std::vector<std::vector<TriangleContact>> contacts_within(const Scene& scene, double within,
                                                          unsigned threads, std::size_t most,
                                                          const Progress& progress = {});

}  // namespace farcull
