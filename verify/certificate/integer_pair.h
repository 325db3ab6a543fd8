// Decides in integers whether two triangles meet: finds one of 38 directions that separates the
// triangles, or a common point.
//
// The certificate checker relies on this file, so the file uses neither CGAL nor verify/exact.
// Every finite double is an integer times a power of two. So one common power of two turns all
// coordinates of a pair into integers. All further steps are exact and cannot overflow. The
// integers are those of GMP, or machine integers if the scaled coordinates are short enough
// (most_bits() has the bound and its proof).
//
// Triangles are as in verify/exact.h: touching counts, and a degenerate triangle is a segment or a
// point. docs/certificate.md proves: if the triangles are disjoint, one of the 38 directions
// separates them; otherwise one of 21 points lies in both. With a clearance: if the distance is
// above the clearance, one of the 38 directions proves this. Otherwise one of 42 pairs of points or
// one of the 21 points proves that the distance is not above the clearance.
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
///   1           edge 0 of b x edge 1 of b, the normal of b
///   2 + 3i + j  edge i of a x edge j of b
///   11 + 3i + j w (e . e) - e (w . e), e = edge i of a: from the line of e to corner j of b
///   20 + 3i + j w (e . e) - e (w . e), e = edge j of b: from corner i of a to the line of e
///   29 + 3i + j w, from corner i of a to corner j of b
constexpr int kDirections = 38;

/// All directions, sorted by degree in the coordinates: 29 .. 37, 0 .. 10, 11 .. 28.
inline constexpr std::array<int, kDirections> kByDegree = [] {
  std::array<int, kDirections> out{};
  for (int n = 0; n < kDirections; ++n) out[n] = n < 9 ? 29 + n : n - 9;
  return out;
}();

/// Two triangles in integers. Preconditions: finite coordinates; no flushing of subnormals.
class IntegerPair {
 public:
  /// clearance: world units, finite, >= 0.
  IntegerPair(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance = 0);
  ~IntegerPair();
  IntegerPair(const IntegerPair&) = delete;
  IntegerPair& operator=(const IntegerPair&) = delete;

  /// True iff the projections of a and b onto the direction d, in either order, have a gap that is
  /// longer than clearance * |d|. False if d is zero. Precondition: 0 <= direction < kDirections.
  bool separated_by(int direction);
  /// Returns a direction that separates the pair; empty iff the distance is at most the clearance.
  std::optional<int> separating_direction();
  /// True iff the triangles share a point. Constructs 21 points: corners, crossings of an edge and
  /// a plane, crossings of two edges. The triangles share a point iff one of the 21 points lies in
  /// both closed triangles.
  bool has_common_point();
  /// True iff the distance is at most the clearance: has_common_point() is true, or two constructed
  /// points, one in each triangle, are no farther apart than the clearance.
  bool is_within();

  /// True iff a corner of a and a corner of b are equal.
  bool shares_position() const { return shared_[0] != 0; }
  /// True iff the triangles share more than the shared part, which verify/exact.h defines: the
  /// equal corners and the segments between any two of them. First looks for a direction that
  /// proves that they share no more (docs/certificate.md). If there is none, the 21 points decide.
  /// Precondition: shares_position().
  bool meets_beyond_shared();

 private:
  struct Big;
  Big& big();

  bool with_direction(int direction, double clearance, const auto& use);

  std::array<std::array<Vec3, 3>, 2> corners_;
  double clearance_;
  std::array<unsigned, 2> shared_{};  // bit i: corner i equals a corner of the other triangle
  // Corners of a, then of b, relative to a's first corner. Unset if a coordinate is too long.
  std::array<std::array<std::int64_t, 3>, 6> small_;
  int bits_ = 0;  // |difference of two coordinates| < 2^bits_
  std::unique_ptr<Big> big_;
};

/// Guesses in doubles which of the 38 directions separates two triangles most clearly. Returns the
/// first direction of kByDegree whose gap exceeds the clearance by much more than rounding errors.
/// If there is no such direction, returns the direction with the widest gap relative to the extent
/// of the pair. Doubles may overflow, so the guess may be wrong.
int likely_direction(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

}  // namespace farcull
