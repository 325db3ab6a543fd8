// Decides exactly whether triangles with double coordinates collide. Culling is measured against
// these answers. The method `exact` decides every pair that counts, without culling.
//
// Semantics: a triangle is the closed convex hull of its three corners with the doubles as given.
// So touching counts, and a degenerate triangle is a segment or a point. Every decision is the
// exact sign of a polynomial: doubles with error bounds decide most signs, and exact arithmetic
// decides the others. No rounded construction ever decides.
//
// Neighbours are two triangles of one object that share a vertex position (-0.0 equals 0.0). Their
// *shared part* is the shared positions and the segments between any two of them. The shared part
// is no collision: neighbours collide iff their intersection is more than the shared part. With one
// shared position, they collide iff they have another common point. With two, they collide iff the
// intersection is more than the edge between these positions. Triangles with the same three corners
// collide unless the corners are collinear.
//
// With a clearance D > 0, two triangles that are not neighbours collide iff their distance is at
// most D. The clearance has no effect on neighbours, since their distance is 0.
//
// Preconditions everywhere: coordinates are finite (subnormals, 1e308 and -0.0, which equals 0.0,
// are fine); scenes satisfy validate(). Functions of two triangles need a thread that rounds to
// nearest and keeps subnormals (core/base/floating_point.h). Functions of a scene set this
// themselves.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// The answer about one candidate. neighbours_unasked: the candidate is a pair of neighbours, and
/// ExactQuestion::neighbours is false.
enum class PairAnswer : std::uint8_t {
  undecided,
  apart,
  colliding,
  neighbours_apart,
  neighbours_colliding,
  neighbours_unasked
};

struct Collisions {
  std::vector<TrianglePair> pairs;            // colliding pairs that are not neighbours
  std::vector<TrianglePair> neighbour_pairs;  // colliding pairs of neighbours
  std::uint64_t neighbours = 0;               // number of candidates that are neighbours
  std::uint64_t apart = 0;                    // number of other candidates that do not collide
  std::uint64_t neighbours_apart = 0;         // number of neighbours decided not to collide

  /// Returns pairs and neighbour_pairs in one list; sorted if both lists are sorted.
  std::vector<TrianglePair> all() const;
  /// Appends the pairs of `next`, whose candidates come later, and adds its counts.
  void append(const Collisions& next);
};

/// Counts the answers in each class and lists the colliding candidates in the order given. Throws
/// std::logic_error if an answer is undecided, or if there is not one answer for each candidate.
Collisions count_answers(std::span<const TrianglePair> candidates,
                         std::span<const PairAnswer> answers);

/// The shape of the hull of three corners. segment: the corners are collinear, not all equal.
enum class Shape : std::uint8_t { point, segment, triangle };

Shape shape(const std::array<Vec3, 3>& corners);

/// True iff the closed triangles share a point. Symmetric; the order of corners does not matter.
bool intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the distance of the closed triangles is at most `clearance` (world units, finite, >=
/// 0). Compares squared distances exactly. With clearance 0 the same as intersects().
bool within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

/// True iff a corner of a and a corner of b are equal as doubles.
bool share_position(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the intersection is more than the shared part (see the top of this file). The same as
/// intersects() for triangles that share no position.
bool intersects_beyond_shared(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns the number of triangles of the scene that are segments or points.
std::uint64_t degenerate_triangles(const Scene& scene);

struct ExactQuestion {
  double clearance = 0;                                    // world units, finite, >= 0
  unsigned threads = std::thread::hardware_concurrency();  // 0 counts as 1; changes no answer
  bool neighbours = true;  // false: neighbours are counted, not decided
};

/// Returns the candidates that collide, in the order given, duplicates included. A candidate may be
/// any two different triangles, even of one object that is not `self`. Throws std::logic_error if a
/// candidate names one triangle twice or a triangle that the scene does not have, if a candidate
/// was left undecided, or if the clearance is negative or not finite.
Collisions decide(const Scene& scene, std::span<const TrianglePair> candidates,
                  const ExactQuestion& question = {});

struct FirstCollisions {
  Collisions collisions;      // its counts cover only the decided candidates
  std::uint64_t decided = 0;  // this many candidates, from the first one on, were decided
  bool complete = true;       // all candidates were decided, and at most `limit` collide
};

/// Finds the first `limit` candidates that collide, colliding neighbours included. Decides
/// candidates block by block and stops when `limit` candidates collide; later candidates stay
/// undecided. Preconditions: the candidates are sorted, limit > 0. Throws as decide() does.
FirstCollisions decide_first(const Scene& scene, std::span<const TrianglePair> candidates,
                             std::uint64_t limit, const ExactQuestion& question = {});

/// Keeps the first `limit` pairs in the common order of both lists of pairs, and removes the
/// others. Returns true if pairs were removed. Does not change counts. Precondition: both lists are
/// sorted.
bool keep_first(std::uint64_t limit, Collisions& collisions);

/// decide() for successive frames of a scene. The answer about a pair depends only on the corners
/// of its triangles. So if neither triangle moved, the answer of the last frame is still right.
class FrameDecider {
 public:
  /// Like farcull::decide(). Stores its answers if the candidates are sorted and distinct. Reuses
  /// the stored answers if the last call ended normally, was for the previous frame and had the
  /// same question (threads may differ). Precondition: moved.update(scene) began this frame.
  Collisions decide(const Scene& scene, std::span<const TrianglePair> candidates,
                    const MovedCorners& moved, const ExactQuestion& question = {});
  /// Returns the number of pairs that the last call decided anew.
  std::size_t decided() const { return decided_; }

 private:
  std::optional<std::uint64_t> frame_;  // the frame of answers_; empty if answers_ is not valid
  double clearance_ = 0;
  bool neighbours_ = true;
  std::vector<TrianglePair> pairs_;
  std::vector<PairAnswer> answers_;  // one per pair in pairs_
  std::size_t decided_ = 0;
};

/// The answers about the pairs that count: two triangles of different objects, or of one object
/// marked `self`.
struct ExactResult : Collisions {  // both lists sorted, each pair once
  std::uint64_t box_pairs = 0;     // pairs that count and have overlapping boxes: no gap
                                   // along an axis, computed in double, is above the clearance
  std::uint64_t ignored = 0;       // pairs with overlapping boxes whose objects are ignored
  double join_ms = 0;              // wall-clock time for building and joining the boxes
  double predicates_ms = 0;        // mean time of the deciding threads, plus time for sorting
};

/// The method `exact`: a tree of boxes in doubles finds the pairs whose boxes overlap, and decide()
/// decides these pairs in the threads that find them. Memory O(triangles + colliding pairs), since
/// candidates are not stored. The tree (core/boxes/join.h) uses no view, no error budget and no
/// float. A test compares the tree's pairs with those of CGAL's join, which shares no code with the
/// tree. ignored: pairs of objects that do not count, as returned by in_order().
ExactResult all_colliding_pairs(const Scene& scene, const ExactQuestion& question = {},
                                std::span<const ObjectPair> ignored = {});

}  // namespace farcull
