// Distances between objects, with nearest points (docs/proximity.md), and contacts: all pairs of
// triangles within a distance. Which pairs are answered is decided exactly. Numbers are exact,
// rounded once, except for `all` without `exact` (DistanceFinderOptions).
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
  objects,  // the nearest triangles of every two objects, and within each object with `self`
  nearest,  // the same for each object and its k nearest others; of ties, the lower number first
  all,      // every pair of triangles within a distance
};

struct DistanceFinderOptions {
  DistanceKind kind = DistanceKind::objects;
  std::size_t k = 1;                  // with `nearest`, 1 or more
  std::optional<double> within = {};  // leaves out answers that are farther apart; world units, 0
                                      // or more; with `all` finite
  bool self = false;  // also triangles of one object, without neighbours; not with `nearest`
  std::vector<bool> self_objects = {};  // `self` for each object; empty, or one for each
  bool inside = true;                   // find whether an object is inside another; not with `all`
  /// true: sets DistanceAnswer::squared; with `all`, each number is the exact one, rounded once,
  /// which takes about ten times as long. false, with `all`: a distance is off by at most 2^-32 of
  /// itself (0 iff the triangles meet), a normal by 2^-15, and a point is off its triangle by at
  /// most 2^-45 of the pair's extent. If several points are nearly as near, others may be given
  /// than with `exact`, on other features.
  bool exact = false;
  /// Pairs of different objects, by their numbers from 0, that are not answered; not with
  /// `nearest`.
  std::vector<std::array<std::uint32_t, 2>> ignore = {};
  unsigned threads = 0;  // up to 1024; 0: as many as there are cores; changes no answer
  MayGoOn may_go_on = {};
};

/// Which of two objects is inside the other. unknown: not asked, or the objects meet. none: neither
/// is. a, b: all of this object is inside the other. not_closed: one may be inside the other, but
/// the other is not closed, so it has no inside.
enum class DistanceInside { unknown, none, a, b, not_closed };

/// The distance of two objects, or with `all` of two triangles.
struct DistanceAnswer {
  std::uint32_t object_a = 0, object_b = 0;      // a <= b
  std::uint32_t triangle_a = 0, triangle_b = 0;  // the first nearest pair; numbered as in Pair
  double distance = 0;  // rounded to nearest; infinity beyond the largest double
  std::string squared;  // with `exact`: "numerator/denominator" in lowest terms, nothing rounded
  std::array<double, 3> point_a{}, point_b{};  // nearest points, each coordinate rounded
  /// Barycentric: the point is the mean of the triangle's corners with these weights, which are 0
  /// or more and sum to 1 up to rounding.
  std::array<double, 3> weights_a{}, weights_b{};
  std::array<double, 3> normal{};    // unit, from point_a to point_b; zeros if the triangles meet
  std::string feature_a, feature_b;  // where the points lie: "vertex 2", "edge 0" or "face"; edge i
                                     // goes from corner i to the next
  DistanceInside inside = DistanceInside::unknown;
};

/// Finds distances again and again. The nearest triangles of one call are the first guess of the
/// next call, which saves time if the scene moved only a little; any other scene may follow, too.
/// An object serves one call at a time, as a Collider does.
class DistanceFinder {
 public:
  /// Throws Error naming the option that is bad.
  explicit DistanceFinder(const DistanceFinderOptions& options);
  DistanceFinder();  // default options
  ~DistanceFinder();
  DistanceFinder(DistanceFinder&&) noexcept;
  DistanceFinder& operator=(DistanceFinder&&) noexcept;

  /// The answers, sorted by objects, then by triangles. Throws Error as Collider::find() does.
  /// Also throws Error if kind is `all` and there are more than 4,194,304 answers, or if kind is
  /// `objects` and there are more than 4,194,304 pairs of objects (16,777,216 if `within` is
  /// finite). Sets and restores the floating-point environment as Collider::find() does.
  std::vector<DistanceAnswer> find(const Input& input);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// DistanceFinder::find() for one scene.
std::vector<DistanceAnswer> distances(const Input& input,
                                      const DistanceFinderOptions& options = {});

}  // namespace farcull
