// The exact distance of two triangles with the features that realise it, and the proof that two
// triangles are no nearer than some length. Both in integers. For the accounting of distances, so
// this file uses neither CGAL nor verify/closest. docs/proximity.md has the theorems. Triangles are
// as in verify/exact.h; subnormals are not flushed to zero.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/scene/scene.h"
#include "verify/certificate/integers.h"

namespace farcull {

/// A point with coordinate (over[k] / under) 2^exponent + from[k] along axis k.
struct FractionPoint {
  std::array<mpz_class, 3> over;
  mpz_class under = 1;  // > 0
  int exponent = 0;
  Vec3 from;
};
/// True iff each coordinate of x is that of the point, rounded as IEEE 754 does: to the nearest
/// double, to the even one of two equally near doubles, to infinity beyond the largest double.
/// False for -0.0.
bool is_rounded(const Vec3& x, const FractionPoint& point);

/// The distance of two triangles, and where its ends are. Features are numbered: 0 to 2 the
/// corners, 3 + i the edge from corner i to the next, 6 the face. The features are the first pair
/// (by the feature of a, then by that of b) that has two nearest points.
struct IntegerDistance {
  Fraction squared;
  std::array<std::uint8_t, 2> features{};
  /// The only two nearest points on these features, of a and of b.
  std::array<FractionPoint, 2> points;
};

/// The distance of a and b. For one pair of features after the other, two points are constructed,
/// until they lie in their triangles and signs of scalar products prove them nearest.
IntegerDistance integer_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the distance is more than `length`; with or_as_far, iff it is at least `length`. Finds
/// one of the 38 directions d of integer_pair.h whose gap g is long enough: g^2 > length^2 (d . d),
/// or >=. So this function shares no construction with integer_distance().
bool is_beyond(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Length& length,
               bool or_as_far);

// Decides in integers whether one of two objects lies inside the other, by the definitions of
// verify/inside.h. For the accounting, so this part uses neither verify/inside nor
// experiments/method/distances. docs/proximity.md has the proof ("One object inside another").

/// a, b: this object is inside the other, with all of its points. none: neither object is inside
/// the other. not_closed: neither is inside the other, but the box of one is in the box of the
/// other, which is not closed. unknown: nothing is claimed.
enum class InsideClaim : std::uint8_t { unknown, none, a, b, not_closed };

/// Answers for one scene, which must stay as it is and outlive this object. Keeps facts about each
/// object of the scene that take long to compute.
class IntegerInside {
 public:
  explicit IntegerInside(const Scene& scene);
  ~IntegerInside();
  IntegerInside(const IntegerInside&) = delete;
  IntegerInside& operator=(const IntegerInside&) = delete;

  /// Which object is inside the other; never `unknown`. Empty if a corner of one object is found on
  /// the mesh of the other. The answer holds only if the objects share no point, which the caller
  /// has to prove. Precondition: the objects differ and have triangles. May be called by several
  /// threads at once. Throws std::logic_error for objects that the scene does not have.
  std::optional<InsideClaim> which(std::uint32_t a, std::uint32_t b) const;

 private:
  struct OfObject;
  enum class Answer : std::uint8_t { no, yes, not_closed, on };
  Answer contains(std::uint32_t outer, std::uint32_t inner) const;

  const Scene& scene_;
  std::unique_ptr<OfObject[]> objects_;
};

}  // namespace farcull
