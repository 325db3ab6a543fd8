// Distances of triangles and closest points of triangles, in exact arithmetic.
//
// Triangles are as in verify/exact.h. A distance is the square root of a rational number. So the
// square is stored exactly, and the distance itself is rounded once, to the nearest double.
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

/// The exact square of a distance: a rational number >= 0. The value is constant, so copies share
/// the memory of the value.
class SquaredDistance {
 public:
  SquaredDistance();  // the square is 0
  struct Value;       // defined in verify/squared_distance.h, for use in verify/
  explicit SquaredDistance(std::shared_ptr<const Value> value);
  /// Returns the square of this distance. Precondition: the distance is finite and >= 0.
  static SquaredDistance of(double distance);

  /// Returns the distance, rounded to nearest, ties to even; infinity beyond the largest double.
  double root() const;
  /// Returns "numerator/denominator" in lowest terms, decimal.
  std::string text() const;
  bool is_zero() const;
  const Value& value() const { return *value_; }

  friend std::strong_ordering operator<=>(const SquaredDistance& a, const SquaredDistance& b);
  friend bool operator==(const SquaredDistance& a, const SquaredDistance& b);

 private:
  std::shared_ptr<const Value> value_;
};

/// The part of a triangle on which a point lies. If a point lies on several parts, its feature is
/// the first of these parts in the order corner 0, 1, 2, edge 0, 1, 2, face.
enum class FeatureKind : std::uint8_t { vertex, edge, face };
struct Feature {
  FeatureKind kind = FeatureKind::vertex;
  std::uint8_t index = 0;  // vertex: the corner; edge: the first corner; face: 0
  auto operator<=>(const Feature&) const = default;
};
/// Returns "vertex 2", "edge 0", "face" and so on.
std::string to_string(const Feature& feature);
/// Returns the number of a feature in certificates: 0 to 2 for the corners, 3 to 5 for the edges, 6
/// for the face.
constexpr std::uint8_t number_of(const Feature& feature) {
  return static_cast<std::uint8_t>(3 * static_cast<int>(feature.kind) + feature.index);
}

/// Two closest points of two triangles a and b. If several pairs of points are equally near, as on
/// parallel edges, the features determine the pair: consider the pairs of features F of a and G of
/// b, ordered by F and then by G. The points are on the first F and G that hold two closest points
/// (docs/proximity.md, "Two nearest points"). Here a feature includes its boundary.
struct Closest {
  SquaredDistance squared;
  double distance = 0;              // squared.root()
  std::array<Vec3, 2> points;       // on a and on b; each coordinate is rounded once; never -0.0
  std::array<Feature, 2> features;  // the features of the exact points
};

/// Returns closest points of the closed triangles. If the triangles share a point, the distance is
/// 0 and both returned points are one common point. The result depends only on the corners and
/// their order. Exchanging a and b does not change the distance; it changes the points only if
/// other points are equally near.
Closest closest_points(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns only the square of the distance.
SquaredDistance squared_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The pair with the least distance. Among equally near pairs, the first in the given order.
struct NearestPair {
  TrianglePair pair;
  Closest closest;
};
/// Returns the nearest of these pairs of triangles; empty if `pairs` is empty. Throws
/// std::logic_error if a pair has an index that is not a triangle of the scene.
std::optional<NearestPair> nearest_pair(const Scene& scene, std::span<const TrianglePair> pairs);

// ---- two parallel planes between two triangles, computed exactly. The planes prove that many
// other pairs of triangles are no nearer.

/// Let p and q be closest points of the triangles a and b, and w = q - p. The first plane goes
/// through p, the second plane through q. Both planes are perpendicular to w. For a triangle s,
/// reach(s) is the maximum of w . (x - p) over all points x of s. For a triangle t, start(t) is the
/// minimum of w . (y - q) over all points y of t. Both are scaled by the same positive number. If
/// reach(s) <= start(t), then w . (y - x) >= w . w for all x and y. So |y - x| >= |w|: s and t are
/// no nearer than a and b. If reach(s) < start(t), s and t are farther apart than a and b.
class PlanesBetween {
 public:
  /// Throws std::logic_error if the triangles meet.
  PlanesBetween(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

  /// Returns an upper bound of reach(t), or the exact value if it is a double, such as 0.
  double reach(const std::array<Vec3, 3>& t) const { return place(t, 0); }
  /// Returns a lower bound of start(t), or the exact value if it is a double.
  double start(const std::array<Vec3, 3>& t) const { return place(t, 1); }

 private:
  struct Planes;
  double place(const std::array<Vec3, 3>& t, int side) const;

  std::shared_ptr<const Planes> planes_;
};

}  // namespace farcull
