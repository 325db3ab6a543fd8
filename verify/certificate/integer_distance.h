// The exact distance of two triangles with the features that realise it, and the proof that two
// triangles are no nearer than some length, both in integers. For the checker of distances: it
// knows neither CGAL nor verify/closest. docs/certificate.md has the theorems.
//
// Semantics as in verify/exact.h: closed convex hulls of the three corners, degenerate triangles
// included. Preconditions: finite coordinates; subnormals are not flushed to zero.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/scene/scene.h"
#include "verify/certificate/integers.h"

namespace farcull {

/// (over[k] / under) 2^exponent + from[k] along axis k.
struct FractionPoint {
  std::array<mpz_class, 3> over;
  mpz_class under = 1;  // > 0
  int exponent = 0;
  Vec3 from;
};
/// True iff each coordinate of x is the point's, rounded as IEEE 754 does: to the nearest double,
/// of two equally near ones to the even one, beyond the largest double to infinity. False for -0.0.
bool is_rounded(const Vec3& x, const FractionPoint& point);

/// The distance of two triangles, and where on them its ends lie. Features are numbered: 0 to 2 the
/// corners, 3 to 5 the edge from corner 0 to 2 to the next one, 6 the face. Of all pairs of nearest
/// points this is the first pair of features that has one, that of a compared first.
struct IntegerDistance {
  Fraction squared;
  std::array<std::uint8_t, 2> features{};
  /// The only two nearest points on these features, of a and of b.
  std::array<FractionPoint, 2> points;
};

/// Points are constructed for one pair of features after the other, until two of them lie in their
/// triangles and are proved nearest by the signs of scalar products.
IntegerDistance integer_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the distance is more than `length`; with or_as_far, iff it is at least that. By one of
/// the 38 directions of integer_pair.h, whose gap g is long enough: g^2 > length^2 (d . d), or >=.
/// So it shares no construction with integer_distance().
bool is_beyond(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Length& length,
               bool or_as_far);

// Whether one of two objects lies inside the other, decided in integers. For the checker of
// distances and the accounting: it knows neither verify/inside nor experiments/method/distances.
// docs/certificate.md has the proof.
//
// A mesh is *closed* if every edge, by the positions of its ends, belongs to an even number of its
// triangles; triangles with two equal corners do not count. A point off a closed mesh is *inside*
// if a ray from it crosses the mesh an odd number of times.

/// a, b: this object is inside the other, with all of its points. none: neither is. not_closed:
/// neither is, but the box of one is in that of the other, which is not closed. unknown: nothing is
/// said.
enum class InsideClaim : std::uint8_t { unknown, none, a, b, not_closed };

/// Answers for one scene, which must stay as it is and outlive the object. What is found out about
/// an object is kept.
class IntegerInside {
 public:
  explicit IntegerInside(const Scene& scene);
  ~IntegerInside();
  IntegerInside(const IntegerInside&) = delete;
  IntegerInside& operator=(const IntegerInside&) = delete;

  /// Never unknown; nothing where a corner of one object is met on the mesh of the other. The
  /// answer counts only where the objects share no point, which others have to prove. Precondition:
  /// the objects differ and have triangles. May be called by several threads at once. Throws
  /// std::logic_error for objects that the scene does not have.
  std::optional<InsideClaim> which(std::uint32_t a, std::uint32_t b) const;

 private:
  struct OfObject;
  enum class Answer : std::uint8_t { no, yes, not_closed, on };
  Answer contains(std::uint32_t outer, std::uint32_t inner) const;

  const Scene& scene_;
  std::unique_ptr<OfObject[]> objects_;
};

}  // namespace farcull
