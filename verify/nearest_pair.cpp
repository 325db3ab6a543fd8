// Finds the nearest of many pairs of triangles. Bounds in doubles leave few pairs that can be the
// nearest. The squared distances of these pairs are compared exactly.
//
// Often many of these pairs have the same two closest points, since their triangles share a corner
// or an edge. SamePoints recognises such a pair. Let F and G be the features of closest points of a
// solved pair, and w the difference of these points. Another pair has points as near if its first
// triangle has the corners of F and its second triangle those of G. It has no nearer points if
// w . (x - p) < 0 for the other corners x of the triangle with F, and w . (y - q) > 0 for the other
// corners y of the triangle with G (closest_points.cpp, "Proof of a guess"). Here p may be any
// corner of F, and q any corner of G, since w is perpendicular to both features.
//
// Doubles decide the signs if the products exceed the rounding errors: kTie and the constants after
// it (verify/rounding.h) bound these errors, and docs/proofs.md has the proofs (`distance.tie`).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/floating_point.h"
#include "verify/closest.h"
#include "verify/filter.h"
#include "verify/filter_scalars.h"
#include "verify/rounding.h"

namespace farcull {
namespace {

using filters::DistanceBounds;
using Triangle = std::array<Vec3, 3>;

/// Stores the closest points of a pair, and recognises pairs with the same closest points.
class SamePoints {
 public:
  SamePoints(const Triangle& a, const Triangle& b, const Closest& closest)
      : w_(closest.points[1] - closest.points[0]),
        off_(kTie * w_.cwiseAbs() +
             kTiePoints * (closest.points[0].cwiseAbs() + closest.points[1].cwiseAbs()) +
             Vec3::Constant(kTieSubnormal)),
        sides_{side_of(a, closest.features[0]), side_of(b, closest.features[1])} {}

  /// True only if the closest points of the given pair are closest points of a and b as well.
  bool are_those_of(const Triangle& a, const Triangle& b) const {
    return is_behind(sides_[0], a, 1) && is_behind(sides_[1], b, -1);
  }

 private:
  struct Side {
    Triangle corners;  // corners of the feature
    int count;
  };
  static Side side_of(const Triangle& t, const Feature& feature) {
    if (feature.kind == FeatureKind::face) return {t, 3};
    return {{t[feature.index], t[(feature.index + 1) % 3], t[feature.index]},
            feature.kind == FeatureKind::edge ? 2 : 1};
  }
  bool is_behind(const Side& side, const Triangle& t, double sense) const {
    int own = 0;
    for (const Vec3& x : t) {
      bool is_own = false;
      for (int i = 0; i < side.count; ++i) is_own |= x == side.corners[i];
      if (is_own) {
        ++own;
        continue;
      }
      const Vec3 from = x - side.corners[0];
      // If a product overflows, the sum may be infinite although the bound is finite.
      if (!(w_.cwiseAbs().dot(from.cwiseAbs()) < HUGE_VAL)) return false;
      if (!(sense * w_.dot(from) < -(off_.dot(from.cwiseAbs()) + kTieAbsolute))) return false;
    }
    if (own < side.count) return false;
    for (int i = 0; i < side.count; ++i) {
      if (t[0] != side.corners[i] && t[1] != side.corners[i] && t[2] != side.corners[i])
        return false;
    }
    return true;
  }

  Vec3 w_, off_;
  std::array<Side, 2> sides_;
};

/// Recognises pairs that are no nearer than a given pair, by planes that separate the triangles of
/// the given pair. Computes PlanesBetween::reach() and start() once for each triangle.
class NoNearer {
 public:
  NoNearer(const Scene& scene, const TrianglePair& pair)
      : scene_(scene), planes_(scene.corners(pair.a), scene.corners(pair.b)) {}

  /// True only if `pair` is farther apart than the given pair; with as_far, at least as far.
  bool shows(const TrianglePair& pair, bool as_far) {
    const auto [reach, new_reach] = reach_.try_emplace(pair.a);
    if (new_reach) reach->second = planes_.reach(scene_.corners(pair.a));
    const auto [start, new_start] = start_.try_emplace(pair.b);
    if (new_start) start->second = planes_.start(scene_.corners(pair.b));
    return as_far ? reach->second <= start->second : reach->second < start->second;
  }

 private:
  const Scene& scene_;
  PlanesBetween planes_;
  std::unordered_map<std::uint32_t, double> reach_, start_;
};

/// A pair that may be the nearest pair: its index, and bounds of its distance.
struct Candidate {
  std::size_t at;
  DistanceBounds bounds;
};

/// Returns the pairs, in order, that can be the first of the nearest pairs. Leaves out pairs[0],
/// whose distance is at most `least`, and later pairs with the same closest points (`same`).
std::vector<Candidate> candidates_of(const Scene& scene, std::span<const TrianglePair> pairs,
                                     double least, const SamePoints& same) {
  std::vector<Candidate> out;
  std::size_t kept = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Triangle a = scene.corners(pairs[i].a), b = scene.corners(pairs[i].b);
    if (same.are_those_of(a, b)) continue;
    const DistanceBounds bounds = filter_planes(a, b) == Triage::yes
                                      ? DistanceBounds{0, 0}
                                      : filters::distance_bounds<FilterBounds>(a, b);
    if (bounds.lower > least) continue;
    least = std::min(least, bounds.upper);
    out.push_back({i, bounds});
    if (least == 0 && bounds.upper == 0) break;  // no later pair can be the first at distance 0
    if (out.size() > 2 * kept + 1000) {
      std::erase_if(out, [&](const Candidate& c) { return c.bounds.lower > least; });
      kept = out.size();
    }
  }
  std::erase_if(out, [&](const Candidate& c) { return c.bounds.lower > least; });
  return out;
}

double not_below(const Closest& closest) {
  if (closest.squared.is_zero()) return 0;
  return std::nextafter(closest.distance, std::numeric_limits<double>::infinity());
}

}  // namespace

std::optional<NearestPair> nearest_pair(const Scene& scene, std::span<const TrianglePair> pairs) {
  const FloatingPointGuard guard;
  for (const TrianglePair& pair : pairs) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size())
      throw std::logic_error("nearest_pair: a pair names a triangle that the scene lacks");
  }
  if (pairs.empty()) return std::nullopt;
  const auto corners = [&](std::size_t at) {
    return std::array{scene.corners(pairs[at].a), scene.corners(pairs[at].b)};
  };
  const auto [first_a, first_b] = corners(0);
  Closest closest = closest_points(first_a, first_b);
  if (closest.squared.is_zero()) return NearestPair{pairs[0], std::move(closest)};
  std::size_t best = 0, solved = 0;
  double at_most = not_below(closest);
  SamePoints same(first_a, first_b, closest);
  std::optional<NoNearer> no_nearer;  // made once a candidate is found to be no nearer
  std::vector<Candidate> left = candidates_of(scene, pairs, at_most, same);
  // Sorts by lower bound, so that near pairs come early. The sort is stable, so pairs with lower
  // bound 0 stay in order, and the first pair that touches ends the search.
  std::ranges::stable_sort(left, {}, [](const Candidate& c) { return c.bounds.lower; });
  for (const auto& [at, bounds] : left) {
    if (bounds.lower > at_most) break;  // all later candidates are farther, too
    if (at_most == 0 && at > best) continue;
    const auto [a, b] = corners(at);
    if (at_most > 0 && same.are_those_of(a, b)) {
      best = std::min(best, at);
      continue;
    }
    if (no_nearer && no_nearer->shows(pairs[at], at > best)) continue;
    const auto order = squared_distance(a, b) <=> closest.squared;
    if (order >= 0 && !no_nearer && at_most > 0) no_nearer.emplace(scene, pairs[solved]);
    if (order > 0 || (order == 0 && at > best)) continue;
    best = at;
    if (order == 0) continue;
    solved = at;
    closest = closest_points(a, b);
    same = SamePoints(a, b, closest);
    no_nearer.reset();
    at_most = not_below(closest);
  }
  if (best != solved) {
    const auto [a, b] = corners(best);
    closest = closest_points(a, b);
  }
  return NearestPair{pairs[best], std::move(closest)};
}

}  // namespace farcull
