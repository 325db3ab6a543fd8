// Two triangles decided in integers: which of 38 directions separates them, or a point they share;
// with a clearance, which one shows that they are farther apart, or two points that are not.
//
// The certificate checker rests on this file alone, so it knows neither CGAL nor verify/exact.
// Every finite double is an integer times a power of two: the pair is scaled by one common power,
// and from there on nothing is rounded and nothing can overflow (GMP; machine integers where the
// scaled coordinates are short enough for a bound that is proved beside the code).
//
// Semantics as in verify/exact.h: closed convex hulls of the three corners, touching counts, a
// degenerate triangle is the segment or the point that it is. docs/certificate.md proves that the
// 38 directions find every disjoint pair and the 21 points every other one, and that with a
// clearance the same directions find every pair that is farther apart, and 42 pairs of points or
// the 21 points every other one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/scene/scene.h"

namespace farcull {

/// Directions are numbered 0 .. 37. With i, j in 0 .. 2, edge i of t = t[(i + 1) % 3] - t[i] and
/// w = b[j] - a[i]:
///   0           edge 0 of a x edge 1 of a, the normal of a
///   1           the same of b
///   2 + 3i + j  edge i of a x edge j of b
///   11 + 3i + j w (e . e) - e (w . e), e = edge i of a: from that edge's line to corner j of b
///   20 + 3i + j the same, e = edge j of b: from corner i of a to that edge's line
///   29 + 3i + j w, from corner i of a to corner j of b
constexpr int kDirections = 38;

/// A pair in integers. Preconditions: finite coordinates; subnormals are not flushed to zero.
class IntegerPair {
 public:
  /// clearance: world units, finite, >= 0; a distance of exactly that much is within it.
  IntegerPair(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance = 0);
  ~IntegerPair();
  IntegerPair(const IntegerPair&) = delete;
  IntegerPair& operator=(const IntegerPair&) = delete;

  /// True iff the projections of a and b onto the direction have a gap, whichever comes first, that
  /// is longer than the clearance times the direction's length. A direction that is zero separates
  /// nothing. Precondition: 0 <= direction < kDirections.
  bool separated_by(int direction);
  /// A direction that separates; none iff the distance is at most the clearance.
  std::optional<int> separating_direction();
  /// True iff one of 21 constructed points (corners, edge with plane, edge with edge) lies in both
  /// closed triangles; each is a vector of integers over one integer. True iff the triangles share
  /// a point, found without any of the directions.
  bool has_common_point();
  /// True iff two constructed points, one verified to lie in each triangle, are no farther apart
  /// than the clearance, or has_common_point(). True iff the distance is at most the clearance,
  /// found without any of the directions.
  bool is_within();

  /// True iff a corner of a and a corner of b are equal.
  bool shares_position() const { return shared_[0] != 0; }
  /// True iff the triangles share more than the shared part, as verify/exact.h defines it for
  /// neighbours: the equal corners and the segments between any two of them. By a direction that
  /// shows the contrary (docs/certificate.md), else by the 21 points. Precondition:
  /// shares_position().
  bool meets_beyond_shared();

 private:
  struct Big;
  Big& big();

  bool only_shared_by(int direction);

  std::array<std::array<Vec3, 3>, 2> corners_;
  double clearance_;
  std::array<unsigned, 2> shared_{};  // bit i: corner i equals one of the other triangle
  // Relative to the first corner of a, where bits_ allows; the corners of a, then of b.
  std::array<std::array<std::int64_t, 3>, 6> small_;
  int bits_ = 0;  // |difference of two coordinates| < 2^bits_
  std::unique_ptr<Big> big_;
};

/// True iff the closed convex hulls share a point: iff none of the 38 directions separates them.
bool integer_intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the distance of the closed convex hulls is at most `clearance` (finite, >= 0): iff
/// along none of the 38 directions the gap is longer.
bool integer_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

/// A guess which of the 38 directions parts two triangles most clearly: one whose gap beyond the
/// clearance, in doubles, is clear of rounding, cheap ones first; else the one with the widest in
/// proportion. Only a guess, whatever doubles overflow.
int likely_direction(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

}  // namespace farcull
