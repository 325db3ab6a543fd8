// Exact answers about triangles in double coordinates: the truth that culling is measured against,
// and the method `exact` (every pair of triangles of different objects) that needs no culling.
//
// Semantics: a triangle is the closed convex hull of its
// three corners with the doubles as given, so touching counts, and a degenerate triangle is the
// segment or the point that it is. Every decision is the sign of a polynomial that CGAL evaluates
// exactly (filtered, then rational); no rounded construction ever decides.
//
// Preconditions everywhere: coordinates finite (any finite double: subnormal, 1e308 and -0.0, which
// equals 0.0, are fine); the calling thread rounds to nearest and does not flush subnormals to
// zero; scenes satisfy validate().
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// What the convex hull of three corners is. segment: the corners are collinear but not all equal.
enum class Shape : std::uint8_t { point, segment, triangle };

/// Exact, by CGAL's collinearity predicate.
Shape shape(const std::array<Vec3, 3>& corners);

/// True iff the closed convex hulls share a point. Symmetric; the order of corners does not matter.
bool intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// How many triangles of the scene are segments or points.
std::uint64_t degenerate_triangles(const Scene& scene);

/// The candidates that intersect, in the order given (duplicates and all); candidates may be of any
/// two triangles, also of one object. The answer does not depend on `threads` (0 counts as 1).
/// Throws std::logic_error if a candidate names a triangle that the scene does not have.
std::vector<TrianglePair> colliding_pairs(const Scene& scene,
                                          std::span<const TrianglePair> candidates,
                                          unsigned threads = std::thread::hardware_concurrency());

struct ExactResult {
  std::vector<TrianglePair>
      pairs;  // all intersecting pairs of triangles of different objects, sorted, each once
  std::uint64_t box_pairs =
      0;                     // pairs of triangles of different objects whose closed boxes overlap
  double join_ms = 0;        // boxes and box join, wall clock
  double predicates_ms = 0;  // exact predicates on the overlapping pairs, wall clock
};

/// The method `exact`: closed boxes by CGAL::box_intersection_d (Zomorodian, Edelsbrunner: Fast
/// software for box intersections, 2002) with cutoff 2000, then intersects(). Where exactly two
/// objects have triangles the join is bipartite, else the join of all with all, filtered by owner.
/// Memory O(triangles + colliding pairs): candidates are not kept.
ExactResult all_colliding_pairs(const Scene& scene,
                                unsigned threads = std::thread::hardware_concurrency());

}  // namespace farcull
