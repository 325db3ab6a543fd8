// Finds distances between objects, with nearest points (docs/proximity.md), and all pairs of
// triangles within a distance. Exact arithmetic decides which pairs are answers. Each number of an
// answer is the exact value, rounded once, except for DistanceKind::all without
// DistanceFinderOptions::exact.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/library/farcull.h"

namespace farcull {

enum class DistanceKind {
  objects,  // the nearest triangles of every two objects; with `self` also within each object
  nearest,  // for each object, its k nearest other objects; in a tie the lower number comes first
  all,      // every pair of triangles within a distance
};

struct DistanceFinderOptions {
  DistanceKind kind = DistanceKind::objects;
  std::size_t k = 1;                  // only for `nearest`; at least 1
  std::optional<double> within = {};  // largest distance of an answer, in world units; at least 0;
                                      // finite with `all`
  bool self =
      false;  // also pairs of triangles within an object, except neighbours; not with `nearest`
  std::vector<bool> self_objects = {};  // one `self` per object; may be empty
  bool inside = true;                   // find which object is inside another; not with `all`
  /// true: sets DistanceAnswer::squared. With `all`, each number is then the exact value, rounded
  /// once; this takes about ten times as long.
  /// false, with `all`: the relative error of a distance is at most 2^-32. The distance is 0 iff
  /// the triangles meet. The error of a normal is at most 2^-15. A point is off its triangle by at
  /// most 2^-45 of the pair's extent. If several points are almost equally near, any of them may be
  /// given.
  bool exact = false;
  /// Pairs of different objects that get no answer. Objects are numbered from 0. Not with
  /// `nearest`.
  std::vector<std::array<std::uint32_t, 2>> ignore = {};
  unsigned threads = 0;  // up to 1024; 0: one per core; any number gives the same answer
  MayGoOn may_go_on = {};
};

/// Which of two objects is inside the other.
/// unknown: not computed, or the objects meet. none: neither object is inside the other.
/// a, b: this object is completely inside the other.
/// not_closed: the object that may contain the other is not closed, so it has no inside.
enum class DistanceInside { unknown, none, a, b, not_closed };

/// The distance of two objects, or with `all` of two triangles.
struct DistanceAnswer {
  std::uint32_t object_a = 0, object_b = 0;      // a <= b
  std::uint32_t triangle_a = 0, triangle_b = 0;  // in a tie the first pair; numbered as in Pair
  double distance = 0;  // rounded to nearest; infinity beyond the largest double
  std::string squared;  // with `exact`: "numerator/denominator" in lowest terms, nothing rounded
  std::array<double, 3> point_a{}, point_b{};  // nearest points, each coordinate rounded
  /// Barycentric coordinates of point_a and point_b. Each has three weights, one per corner of its
  /// triangle. Each weight is at least 0. The sum of the three weights is 1 up to rounding.
  std::array<double, 3> weights_a{}, weights_b{};
  std::array<double, 3> normal{};    // unit vector from point_a to point_b; 0 if the triangles meet
  std::string feature_a, feature_b;  // where the points lie: "vertex 2", "edge 0" or "face"; edge i
                                     // goes from corner i to the next
  DistanceInside inside = DistanceInside::unknown;
};

/// Finds distances repeatedly. Each call begins with the nearest triangles of the previous call,
/// which saves time if the scene moved only a little. Each call may give a different scene. Only
/// one call at a time may use a DistanceFinder.
class DistanceFinder {
 public:
  /// Throws Error naming the option that is bad.
  explicit DistanceFinder(const DistanceFinderOptions& options);
  DistanceFinder();  // default options
  ~DistanceFinder();
  DistanceFinder(DistanceFinder&&) noexcept;
  DistanceFinder& operator=(DistanceFinder&&) noexcept;

  /// Returns the answers, sorted by objects, then by triangles. Sets and restores the
  /// floating-point environment as Collider::find() does. Throws Error as Collider::find() does,
  /// and for
  /// - more than 4,194,304 answers with `all`,
  /// - more than 4,194,304 pairs of objects with `objects` (16,777,216 if `within` is finite).
  std::vector<DistanceAnswer> find(const Input& input);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Calls DistanceFinder::find() once.
std::vector<DistanceAnswer> distances(const Input& input,
                                      const DistanceFinderOptions& options = {});

}  // namespace farcull
