// Computes the exact distance of two triangles in integers, and the features with the nearest
// points. Also proves that two triangles are no nearer than a given length. Distance accounting
// uses this file as a check, so the file uses neither CGAL nor verify/closest. docs/proximity.md
// has the theorems. Triangles are as in verify/exact.h; subnormals are not flushed to zero.
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
/// True iff each coordinate of x is the coordinate of the point, rounded as in IEEE 754: to
/// nearest, ties to even, infinity beyond the largest double. False if a coordinate of x is -0.0.
bool is_rounded(const Vec3& x, const FractionPoint& point);

/// The distance of two triangles, and two nearest points with their features. Features are
/// numbered: 0 to 2 are the corners, 3 + i is the edge from corner i to the next corner, 6 is the
/// face. `features` is the first pair of features that has two nearest points, ordered by the
/// feature of a, then by the feature of b.
struct IntegerDistance {
  Fraction squared;
  std::array<std::uint8_t, 2> features{};
  /// The nearest points on these features: one of a, one of b. Each feature has no other.
  std::array<FractionPoint, 2> points;
};

/// Returns the distance of a and b. Constructs two points per pair of features, until the points
/// lie in the triangles and signs of scalar products prove the points nearest.
IntegerDistance integer_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// True iff the distance is more than `length`; with or_as_far, iff it is at least `length`. Tries
/// the 38 directions d of integer_pair.h. A direction is a proof if g^2 > length^2 (d . d), where g
/// is the gap between the values of d . x on a and on b (with or_as_far: >=). Unlike
/// integer_distance(), this function constructs no points.
bool is_beyond(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Length& length,
               bool or_as_far);

// The next part decides in integers whether one of two objects lies inside the other, as defined in
// verify/inside.h. The accounting uses this part as a check, so it uses neither verify/inside nor
// experiments/method/distances. docs/proximity.md has the proof ("One object inside another").

/// a: object a is inside object b. b: object b is inside object a. none: neither object is inside
/// the other. not_closed: neither object is inside the other, but the box of one object is in the
/// box of the other, and that other mesh is not closed. unknown: nothing is claimed.
enum class InsideClaim : std::uint8_t { unknown, none, a, b, not_closed };

/// Decides pairs of objects of one scene. The scene must not change and must outlive this object.
/// Results per object that take long to compute are stored.
class IntegerInside {
 public:
  explicit IntegerInside(const Scene& scene);
  ~IntegerInside();
  IntegerInside(const IntegerInside&) = delete;
  IntegerInside& operator=(const IntegerInside&) = delete;

  /// Returns which object is inside the other; never `unknown`. Empty if a corner of one object is
  /// found on the mesh of the other. Preconditions: the objects differ, have triangles and share no
  /// point; the caller has to prove the last. Several threads may call this function at once.
  /// Throws std::logic_error if an object is not in the scene or a == b.
  std::optional<InsideClaim> which(std::uint32_t a, std::uint32_t b) const;

 private:
  struct OfObject;
  enum class Answer : std::uint8_t { no, yes, not_closed, on };
  Answer contains(std::uint32_t outer, std::uint32_t inner) const;

  const Scene& scene_;
  std::unique_ptr<OfObject[]> objects_;
};

}  // namespace farcull
