// Distances of triangles and the points that realise them, in exact arithmetic.
//
// Triangles are as in verify/exact.h. A distance is the root of a rational number, so it is kept as
// its square, and rounded once, to the nearest double.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/scene/scene.h"

namespace farcull {

/// The exact square of a distance, a rational number >= 0. Copies share one value, which is
/// constant.
class SquaredDistance {
 public:
  SquaredDistance();  // 0
  struct Value;       // defined in verify/squared_distance.h, for verify alone
  explicit SquaredDistance(std::shared_ptr<const Value> value);
  /// The square of this distance. Precondition: finite, >= 0.
  static SquaredDistance of(double distance);

  /// The distance: the root, rounded to nearest, ties to even; infinity beyond the largest double.
  double root() const;
  /// "numerator/denominator" in lowest terms, decimal.
  std::string text() const;
  bool is_zero() const;
  const Value& value() const { return *value_; }

  friend std::strong_ordering operator<=>(const SquaredDistance& a, const SquaredDistance& b);
  friend bool operator==(const SquaredDistance& a, const SquaredDistance& b);

 private:
  std::shared_ptr<const Value> value_;
};

/// The part of a triangle that a point lies on. If the point lies on several parts, the first
/// counts: a corner before an edge before the face, a lower number before a higher one.
enum class FeatureKind : std::uint8_t { vertex, edge, face };
struct Feature {
  FeatureKind kind = FeatureKind::vertex;
  std::uint8_t index = 0;  // vertex: the corner; edge: from corner `index` to the next; face: 0
  auto operator<=>(const Feature&) const = default;
};
/// "vertex 2", "edge 0" or "face".
std::string to_string(const Feature& feature);
/// The number of a feature in certificates: 0 to 2 the corners, 3 to 5 the edges, 6 the face.
constexpr std::uint8_t number_of(const Feature& feature) {
  return static_cast<std::uint8_t>(3 * static_cast<int>(feature.kind) + feature.index);
}

/// Two closest points of two triangles. If several pairs of points are equally near (parallel
/// edges, triangles that overlap), their features choose one pair (docs/proximity.md, "Two nearest
/// points"). A feature includes its boundary here. The point of a is on the least feature of a that
/// has such a point. The point of b is on the least feature of b that has a partner for the point
/// of a.
struct Closest {
  SquaredDistance squared;
  double distance = 0;              // squared.root()
  std::array<Vec3, 2> points;       // of a and of b, each coordinate rounded once; never -0.0
  std::array<Feature, 2> features;  // the exact points lie on these
};

/// Closest points of the closed triangles. If the triangles share a point, the distance is 0 and
/// both points are one common point. The answer depends on the corners and their order alone. With
/// a and b exchanged the distance stays the same, and so do the points unless others are as near.
Closest closest_points(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The square of the distance alone.
SquaredDistance squared_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The pair at the least distance; of several equally near pairs, the first in the order given.
struct NearestPair {
  TrianglePair pair;
  Closest closest;
};
/// The nearest of these pairs of triangles; empty if `pairs` is empty. Throws std::logic_error if a
/// pair names a triangle that the scene does not have.
std::optional<NearestPair> nearest_pair(const Scene& scene, std::span<const TrianglePair> pairs);

// ---- two parallel planes between two triangles, exactly. They show of many other pairs of
// triangles at once that none of these pairs is nearer.

/// Let p and q be closest points of the triangles a and b, and w = q - p. One plane goes through p,
/// the other one through q; both are perpendicular to w. The reach of a triangle is how far it
/// extends beyond the first plane in the direction of w. The start of a triangle is how far behind
/// the second plane it begins. Both have the same unit, and are negative on the plane's other side.
/// If the reach of s is at most the start of t, then w.(y - x) >= w.w for all points x of s and y
/// of t, so |y - x| >= |w|: s and t are no nearer than a and b. If it is below the start, they are
/// farther apart.
class PlanesBetween {
 public:
  /// Throws std::logic_error if the triangles meet.
  PlanesBetween(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

  /// At least the exact reach; equal to it if the exact reach is a double, such as 0.
  double reach(const std::array<Vec3, 3>& t) const { return place(t, 0); }
  /// At most the exact start; equal to it if the exact start is a double.
  double start(const std::array<Vec3, 3>& t) const { return place(t, 1); }

 private:
  struct Planes;
  double place(const std::array<Vec3, 3>& t, int side) const;

  std::shared_ptr<const Planes> planes_;
};

}  // namespace farcull
