// Exact answers about triangles in double coordinates: the truth that culling is measured against,
// and the method `exact` (every pair of triangles that counts) that needs no culling.
//
// Semantics: a triangle is the closed convex hull of its three corners with the doubles as given,
// so touching counts, and a degenerate triangle is the segment or the point that it is. Every
// decision is the sign of a polynomial that is evaluated exactly (filtered, then rational); no
// rounded construction ever decides.
//
// Neighbours are two triangles of one object that share a vertex position (-0.0 equals 0.0). What
// they share for that reason is no collision: the *shared part* is the shared positions and the
// segments between any two of them. Neighbours collide iff their intersection is more than that:
// with one shared position, iff a further point is common; with two, iff the intersection is more
// than the edge between them; triangles with the same three corners collide unless the corners are
// collinear.
//
// With a clearance D > 0 two triangles that are not neighbours collide iff their distance is at
// most D. Neighbours have distance 0: D does not matter to them.
//
// Preconditions everywhere: coordinates finite (any finite double: subnormal, 1e308 and -0.0, which
// equals 0.0, are fine); scenes satisfy validate(). Functions of two triangles need a thread that
// rounds to nearest and keeps subnormals (core/base/floating_point.h); functions of a scene see to
// that.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// The answer about one candidate, at first `undecided`. neighbours_unasked: the candidate is a
/// pair of neighbours, and ExactQuestion::neighbours is false.
enum class PairAnswer : std::uint8_t {
  undecided,
  apart,
  colliding,
  neighbours_apart,
  neighbours_colliding,
  neighbours_unasked
};

struct Collisions {
  std::vector<TrianglePair> pairs;            // that collide and are not neighbours
  std::vector<TrianglePair> neighbour_pairs;  // neighbours that collide
  std::uint64_t neighbours = 0;               // candidates that are neighbours, colliding or not
  std::uint64_t apart = 0;                    // other candidates that do not collide
  std::uint64_t neighbours_apart = 0;         // neighbours that were decided and do not collide

  /// pairs and neighbour_pairs together; sorted if both lists are sorted.
  std::vector<TrianglePair> all() const;
  /// Adds the pairs and counts of candidates that come after these.
  void append(const Collisions& next);
};

/// Counts the answers in each class and lists the colliding candidates in the order given. Throws
/// std::logic_error if an answer is undecided, or if there is not one answer for each candidate.
Collisions count_answers(std::span<const TrianglePair> candidates,
                         std::span<const PairAnswer> answers);

/// The shape of the hull of three corners. segment: the corners are collinear, not all equal.
enum class Shape : std::uint8_t { point, segment, triangle };

Shape shape(const std::array<Vec3, 3>& corners);

/// True iff the closed convex hulls share a point. Symmetric; the order of corners does not matter.
bool intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the distance of the closed convex hulls is at most `clearance` (world units, finite,
/// >= 0). Compares squared distances exactly; with clearance 0 the same as intersects().
bool within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

/// True iff a corner of a and a corner of b are equal as doubles.
bool share_position(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the intersection is more than the shared part (see the top of this file). For triangles
/// that share no position the same as intersects().
bool intersects_beyond_shared(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// How many triangles of the scene are segments or points.
std::uint64_t degenerate_triangles(const Scene& scene);

struct ExactQuestion {
  double clearance = 0;                                    // world units, finite, >= 0
  unsigned threads = std::thread::hardware_concurrency();  // 0 counts as 1; changes no answer
  bool neighbours = true;  // false: neighbours are counted, not decided
};

/// The candidates that collide, in the order given, duplicates included. A candidate may be any two
/// different triangles, also of one object that is not `self`. Every candidate begins undecided,
/// and each class counts the candidates that were decided to be in it. Throws std::logic_error if a
/// candidate names a triangle that the scene does not have or one triangle twice, if a candidate
/// was left undecided, or if the clearance is negative or not finite.
Collisions decide(const Scene& scene, std::span<const TrianglePair> candidates,
                  const ExactQuestion& question = {});

struct FirstCollisions {
  Collisions collisions;      // counts the candidates that were decided
  std::uint64_t decided = 0;  // how many candidates, from the first one on, were decided
  bool complete = true;       // all were decided, and not more than the limit collide
};

/// The first `limit` candidates that collide, colliding neighbours included. Decides candidates
/// block by block and stops when `limit` of them collide; the others stay undecided. Preconditions:
/// the candidates are sorted, limit > 0. Throws as decide().
FirstCollisions decide_first(const Scene& scene, std::span<const TrianglePair> candidates,
                             std::uint64_t limit, const ExactQuestion& question = {});

/// Removes the last of `pairs` and `neighbour_pairs` until `limit` pairs are left in all; returns
/// whether there were more. The counts stay. Precondition: both lists are sorted.
bool keep_first(std::uint64_t limit, Collisions& collisions);

/// decide() for successive frames of a scene. The answer about a pair depends only on the corners
/// of its triangles, so if neither triangle moved, the answer of the last frame holds.
class FrameDecider {
 public:
  /// As farcull::decide(). Stores its answers if the candidates are sorted and distinct. Reuses the
  /// answers of the last call if it ended normally, was for the previous frame and asked the same
  /// question (threads may differ). Precondition: moved.update(scene) began this frame.
  Collisions decide(const Scene& scene, std::span<const TrianglePair> candidates,
                    const MovedCorners& moved, const ExactQuestion& question = {});
  /// Pairs that the last call decided anew.
  std::size_t decided() const { return decided_; }

 private:
  std::optional<std::uint64_t> frame_;  // frame of the answers
  double clearance_ = 0;
  bool neighbours_ = true;
  std::vector<TrianglePair> pairs_;
  std::vector<PairAnswer> answers_;  // about pairs_
  std::size_t decided_ = 0;
};

/// The answers about the pairs that count: two triangles of different objects, or of one object
/// marked `self`.
struct ExactResult : Collisions {  // both lists sorted, each pair once
  std::uint64_t box_pairs = 0;     // pairs that count whose closed boxes overlap, or have no gap
                                   // above the clearance along any axis, by differences in double
  std::uint64_t ignored = 0;  // pairs whose boxes overlap likewise, but whose objects are ignored
  double join_ms = 0;         // boxes and box join, wall clock, without the decisions
  double predicates_ms = 0;   // decisions (mean of the deciding threads), and sort of the answers
};

/// The method `exact`: a tree of boxes in doubles finds the pairs whose boxes overlap, and decide()
/// decides them in the threads that find them. Memory O(triangles + colliding pairs): candidates
/// are not kept. The tree (core/boxes/join.h) uses no view, no error budget and no float. A test
/// compares its pairs with those of CGAL's join, which shares no code with it. ignored: pairs of
/// objects that do not count, as in_order() gives them.
ExactResult all_colliding_pairs(const Scene& scene, const ExactQuestion& question = {},
                                std::span<const ObjectPair> ignored = {});

}  // namespace farcull
