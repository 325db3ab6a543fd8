// Distances of triangles and the points that realise them, in exact arithmetic.
//
// Triangles are as in verify/exact.h. A distance is the root of a rational number. So its square is
// stored exactly, and the distance itself is rounded once, to the nearest double.
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

/// The exact square of a distance, a rational number >= 0. The value is constant, and copies share
/// it.
class SquaredDistance {
 public:
  SquaredDistance();  // the square is 0
  struct Value;       // defined in verify/squared_distance.h; only verify uses it
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

/// The part of a triangle that a point lies on. If a point lies on several parts, its feature is
/// the first of these parts in the order corner 0, 1, 2, edge 0, 1, 2, face.
enum class FeatureKind : std::uint8_t { vertex, edge, face };
struct Feature {
  FeatureKind kind = FeatureKind::vertex;
  std::uint8_t index = 0;  // vertex: the corner; edge: its first corner; face: 0
  auto operator<=>(const Feature&) const = default;
};
/// Returns "vertex 2", "edge 0", "face" and so on.
std::string to_string(const Feature& feature);
/// Returns the number of a feature in certificates: 0 to 2 the corners, 3 to 5 the edges, 6 the
/// face.
constexpr std::uint8_t number_of(const Feature& feature) {
  return static_cast<std::uint8_t>(3 * static_cast<int>(feature.kind) + feature.index);
}

/// Two closest points of two triangles a and b. If several pairs of points are equally near, as on
/// parallel edges, the features choose one pair. The points are on the first features F of a and G
/// of b, ordered by F and then by G, that hold two closest points (docs/proximity.md, "Two nearest
/// points"). Here a feature includes its boundary.
struct Closest {
  SquaredDistance squared;
  double distance = 0;              // squared.root()
  std::array<Vec3, 2> points;       // on a and on b, each coordinate rounded once; never -0.0
  std::array<Feature, 2> features;  // the features of the exact points
};

/// Returns closest points of the closed triangles. If the triangles share a point, the distance is
/// 0 and both points are one common point. The answer depends only on the corners and their order.
/// Exchanging a and b does not change the distance. It changes the points only if other points are
/// equally near.
Closest closest_points(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns only the square of the distance.
SquaredDistance squared_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The pair at the least distance; of several equally near pairs, the first in the order given.
struct NearestPair {
  TrianglePair pair;
  Closest closest;
};
/// Returns the nearest of these pairs of triangles; nothing if `pairs` is empty. Throws
/// std::logic_error if a pair names a triangle that the scene does not have.
std::optional<NearestPair> nearest_pair(const Scene& scene, std::span<const TrianglePair> pairs);

// ---- two parallel planes between two triangles, exactly. They show for many other pairs of
// triangles that these pairs are no nearer.

/// Let p and q be closest points of the triangles a and b, and w = q - p. The first plane goes
/// through p, the second plane through q. Both planes are perpendicular to w. For a triangle s,
/// reach(s) is the largest w . (x - p) of all points x of s. For a triangle t, start(t) is the
/// least w . (y - q) of all points y of t. Both are scaled by the same positive number. If reach(s)
/// <= start(t), then w . (y - x) >= w . w for all x and y. So |y - x| >= |w|: s and t are no nearer
/// than a and b. If reach(s) < start(t), s and t are farther apart than a and b.
class PlanesBetween {
 public:
  /// Throws std::logic_error if the triangles meet.
  PlanesBetween(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

  /// Returns an upper bound of the reach; the exact reach if it is a double, such as 0.
  double reach(const std::array<Vec3, 3>& t) const { return place(t, 0); }
  /// Returns a lower bound of the start; the exact start if it is a double.
  double start(const std::array<Vec3, 3>& t) const { return place(t, 1); }

 private:
  struct Planes;
  double place(const std::array<Vec3, 3>& t, int side) const;

  std::shared_ptr<const Planes> planes_;
};

}  // namespace farcull
