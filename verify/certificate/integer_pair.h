// Decides two triangles in integers: finds which of 38 directions separates them, or a point that
// they share.
//
// The certificate checker relies on this file, so the file uses neither CGAL nor verify/exact.
// Every finite double is an integer times a power of two: the pair is scaled by one common power,
// and from there on nothing is rounded and nothing can overflow. The integers are GMP's, or machine
// integers if the scaled coordinates are short enough for a bound that is proved beside the code.
//
// Triangles are as in verify/exact.h: touching counts, and a degenerate triangle is the segment or
// the point that it is. docs/certificate.md proves that one of the 38 directions separates every
// disjoint pair, and one of 21 points shows that any other pair meets. With a clearance, the same
// directions show every pair that is farther apart, and 42 pairs of points or the 21 points show
// every other pair.
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

/// All directions, those of the lowest degree first: 29 .. 37, 0 .. 10, 11 .. 28.
inline constexpr std::array<int, kDirections> kByDegree = [] {
  std::array<int, kDirections> out{};
  for (int n = 0; n < kDirections; ++n) out[n] = n < 9 ? 29 + n : n - 9;
  return out;
}();

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
  /// True iff the triangles share a point. Uses no directions: true iff one of 21 constructed
  /// points (corners, edge with plane, edge with edge) lies in both closed triangles. Each point is
  /// a vector of integers over one integer.
  bool has_common_point();
  /// True iff the distance is at most the clearance. Uses no directions: true iff
  /// has_common_point(), or two constructed points, one verified to lie in each triangle, are no
  /// farther apart than the clearance.
  bool is_within();

  /// True iff a corner of a and a corner of b are equal.
  bool shares_position() const { return shared_[0] != 0; }
  /// True iff the triangles share more than the shared part, as verify/exact.h defines it for
  /// neighbours: the equal corners and the segments between any two of them. A direction may show
  /// that they do not (docs/certificate.md); else the 21 points decide. Precondition:
  /// shares_position().
  bool meets_beyond_shared();

 private:
  struct Big;
  Big& big();

  bool with_direction(int direction, double clearance, const auto& use);

  std::array<std::array<Vec3, 3>, 2> corners_;
  double clearance_;
  std::array<unsigned, 2> shared_{};  // bit i: corner i equals a corner of the other triangle
  // The corners of a, then of b, relative to the first corner of a; only if bits_ is small enough.
  std::array<std::array<std::int64_t, 3>, 6> small_;
  int bits_ = 0;  // |difference of two coordinates| < 2^bits_
  std::unique_ptr<Big> big_;
};

/// Guesses in doubles which of the 38 directions separates two triangles most clearly: the first,
/// in order of degree, whose gap beyond the clearance is far above rounding errors; else the one
/// with the widest gap in proportion to the pair's extent. Doubles may overflow: it is only a
/// guess.
int likely_direction(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

}  // namespace farcull
