// Computes closest points of two triangles, and the two planes between the triangles.
#include "verify/closest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "verify/closest_features.h"
#include "verify/filter.h"
#include "verify/filter_scalars.h"
#include "verify/squared_distance.h"

namespace farcull {

// Doubles guess the features. Integers prove the guess. If the proof fails, all features are tried.
//
// Scale. Every finite double is an integer times a power of two. All corners are multiplied by one
// power of two that makes them integers. All later steps add, subtract and multiply integers.
//
// The result is the first pair of features, F of a and G of b ordered by F and then by G, that
// holds two closest points. docs/proximity.md ("Two nearest points") proves that F and G hold only
// one such pair of points, and that find() constructs this pair. For other features, find()
// constructs points of these features or nothing, so never nearer points. So find() is called for
// all pairs of features in order, and the result is the first pair with the least distance.
//
// Proof of a guess. By the theorem in docs/proximity.md, p and q with w = q - p are closest points
// iff w.(x - p) <= 0 for all corners x of a and w.(y - q) >= 0 for all corners y of b. All closest
// points of a lie in the hull of the corners x with product 0. All closest points of b lie in the
// hull of the corners y with product 0. So a guess is the result under three conditions: these
// corners are exactly the corners of F and of G; p and q are inside F and G; F or G is a corner, or
// both are edges that are not parallel. Otherwise the features of these corners are tried in order,
// until two features have points as near as p and q.
//
// Doubles only choose which features to try, and exclude features that are provably not closest. So
// only the final rounding affects the result.

namespace {

using closest::corners_of;
using closest::dot;
using closest::find;
using closest::Found;
using Integer = mpz_class;
using Vector = closest::Vector<Integer>;
using Corners = Scaled::Corners;

constexpr unsigned kAll = 7;

constexpr std::array<Feature, 7> kFeatures = {{{FeatureKind::vertex, 0},
                                               {FeatureKind::vertex, 1},
                                               {FeatureKind::vertex, 2},
                                               {FeatureKind::edge, 0},
                                               {FeatureKind::edge, 1},
                                               {FeatureKind::edge, 2},
                                               {FeatureKind::face, 0}}};

/// The result before rounding.
struct Answer {
  Feature of_a, of_b;
  Found<Integer> found;
};

/// Returns a set of corners of t: bit i is set if d.(x - p) is 0, where x is corner i of t and p is
/// a corner of the feature of t. Returns 8 if the product is above 0 for some corner. back: true
/// replaces d by -d.
unsigned touching(const Corners& t, const Feature& feature, const Vector& d, bool back) {
  constexpr unsigned kBeyond = 8;
  const unsigned own = corners_of(feature);
  unsigned out = own;
  if (own == kAll) return out;
  const Integer level = dot(d, t[feature.index]);
  for (unsigned i = 0; i < 3; ++i) {
    if ((own >> i & 1) != 0) continue;
    const int side = cmp(dot(d, t[i]), level);
    if (side == 0) out |= 1u << i;
    if (back ? side < 0 : side > 0) return kBeyond;
  }
  return out;
}

/// Finds the first pair of features that has points at the same distance as `least`. Tries only
/// features with corners in the sets in_a and in_b (bits). Returns false if there is no such pair.
bool first_as_near(const Scaled& pair, unsigned in_a, unsigned in_b, const Found<Integer>& least,
                   Answer& answer) {
  for (const Feature& f : kFeatures) {
    if ((corners_of(f) & ~in_a) != 0) continue;
    for (const Feature& g : kFeatures) {
      if ((corners_of(g) & ~in_b) != 0) continue;
      if (!find(pair.a, f, pair.b, g, answer.found) ||
          answer.found.num * least.den != least.num * answer.found.den)
        continue;
      answer.of_a = f;
      answer.of_b = g;
      return true;
    }
  }
  return false;
}

using Boxes = std::array<Box, 7>;

/// Returns the boxes of the features of a triangle, in the order of kFeatures.
Boxes boxes_of(const std::array<Vec3, 3>& t) {
  Boxes out;
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    out[i] = Box::empty();
    for (unsigned k = 0; k < 3; ++k) {
      if ((corners_of(kFeatures[i]) >> k & 1) != 0) out[i].add(t[k]);
    }
  }
  return out;
}

/// True only if the boxes are more than `most` apart along an axis. Rounding is monotone: if a
/// rounded difference is above `most`, so is the exact difference.
bool farther(const Box& a, const Box& b, double most) {
  return (b.lo - a.hi).maxCoeff() > most || (a.lo - b.hi).maxCoeff() > most;
}

/// Tries all pairs of features in order. Returns the first pair with the least distance.
Answer search(const Scaled& pair, const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const double most =
      filter_planes(a, b) == Triage::yes ? 0 : filters::distance_bounds<FilterBounds>(a, b).upper;
  const Boxes a_boxes = boxes_of(a), b_boxes = boxes_of(b);
  Answer best;
  Found<Integer> found;
  bool any = false;
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    for (std::size_t j = 0; j < kFeatures.size(); ++j) {
      if (farther(a_boxes[i], b_boxes[j], most)) continue;
      if (!find(pair.a, kFeatures[i], pair.b, kFeatures[j], found)) continue;
      if (any && found.num * best.found.den >= best.found.num * found.den) continue;
      any = true;
      std::swap(best.found, found);
      best.of_a = kFeatures[i];
      best.of_b = kFeatures[j];
      if (best.found.num == 0) return best;
    }
  }
  if (!any) throw std::logic_error("closest_points: no features are closest");
  return best;
}

/// Returns true only if the guess proves the closest points. Then writes the result to `answer`.
bool proved(const Scaled& pair, const closest::Guess& guess, Answer& answer) {
  answer.of_a = guess.of_a;
  answer.of_b = guess.of_b;
  if (!find(pair.a, guess.of_a, pair.b, guess.of_b, answer.found)) return false;
  if (answer.found.num == 0) return false;
  const unsigned in_a = touching(pair.a, guess.of_a, answer.found.direction, false);
  if (in_a > kAll) return false;
  const unsigned in_b = touching(pair.b, guess.of_b, answer.found.direction, true);
  if (in_b > kAll) return false;
  if (answer.found.inside && in_a == corners_of(guess.of_a) && in_b == corners_of(guess.of_b))
    return true;
  const Found<Integer> least = answer.found;
  return first_as_near(pair, in_a, in_b, least, answer);
}

Answer solve(const Scaled& pair, const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  Answer answer;
  return proved(pair, closest::guess_features(a, b), answer) ? answer : search(pair, a, b);
}

SquaredDistance squared(const Scaled& pair, const Found<Integer>& found) {
  return SquaredDistance(std::make_shared<SquaredDistance::Value>(
      SquaredDistance::Value{found.num, found.den, 2L * pair.exponent}));
}

/// True if m * 2^exponent is a double.
bool is_double(const Integer& m, long exponent) {
  if (m == 0) return true;
  const long first = bits_of(m) + exponent;
  const long last = static_cast<long>(mpz_scan1(m.get_mpz_t(), 0)) + exponent;
  return first - last <= 53 && last >= -1074 && first <= 1024;
}

}  // namespace

std::string to_string(const Feature& feature) {
  if (feature.kind == FeatureKind::face) return "face";
  return (feature.kind == FeatureKind::vertex ? "vertex " : "edge ") +
         std::to_string(feature.index);
}

Closest closest_points(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const Scaled pair(a, b);
  const Answer answer = solve(pair, a, b);
  Closest out;
  out.squared = squared(pair, answer.found);
  out.distance = out.squared.root();
  out.features = {answer.of_a, answer.of_b};
  const auto point = [&](int side) -> Vec3 {
    const Feature& f = out.features[side];
    // + 0.0 turns -0.0 into 0.0.
    if (f.kind == FeatureKind::vertex) return (side == 0 ? a : b)[f.index].array() + 0.0;
    return rounded_point(point_of(side == 0 ? pair.a : pair.b, f, answer.found, side),
                         answer.found.below, pair.exponent);
  };
  // If an edge crosses a face, both features have the same point, which is computed once.
  const bool passes = out.features[0].kind != FeatureKind::vertex &&
                      out.features[1].kind != FeatureKind::vertex &&
                      out.features[0].kind != out.features[1].kind;
  const int first = passes && out.features[0].kind == FeatureKind::face ? 1 : 0;
  out.points[first] = point(first);
  out.points[1 - first] = passes ? out.points[first] : point(1 - first);
  return out;
}

SquaredDistance squared_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const Scaled pair(a, b);
  return squared(pair, solve(pair, a, b).found);
}

struct PlanesBetween::Planes {
  Vector direction;
  std::array<Vec3, 2> on;  // a corner of a on the first plane, and of b on the second plane
  long exponent = 0;       // reach and start are scaled by 2^exponent, to avoid overflow
};

PlanesBetween::PlanesBetween(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const Scaled pair(a, b);
  const Answer answer = solve(pair, a, b);
  if (answer.found.num == 0) throw std::logic_error("PlanesBetween: the triangles meet");
  auto planes = std::make_shared<Planes>();
  planes->direction = answer.found.direction;
  // The direction is perpendicular to both features, so all corners of a feature are on its plane.
  planes->on = {a[answer.of_a.index], b[answer.of_b.index]};
  planes->exponent = -most_bits(planes->direction) - 4;
  planes_ = std::move(planes);
}

// Returns reach (side 0) or start (side 1) of t. For each corner, computes in integers the scalar
// product of the direction and (corner - origin). Rounds a reach up and a start down.
double PlanesBetween::place(const std::array<Vec3, 3>& t, int side) const {
  const Vec3& origin = planes_->on[side];
  double out = 0;
  for (int i = 0; i < 3; ++i) {
    int least = 2000;
    for (int k = 0; k < 3; ++k) {
      if (t[i][k] == origin[k]) continue;
      for (const double x : {t[i][k], origin[k]}) {
        if (x != 0) least = std::min(least, lowest_bit(x));
      }
    }
    Integer sum = 0;
    for (int k = 0; k < 3; ++k) {
      if (t[i][k] == origin[k] || planes_->direction[k] == 0) continue;
      sum += planes_->direction[k] * (integer_of(t[i][k], least) - integer_of(origin[k], least));
    }
    const long exponent = least + planes_->exponent;
    double place = rounded(sum, exponent);
    if (!is_double(sum, exponent)) place = std::nextafter(place, side == 0 ? HUGE_VAL : -HUGE_VAL);
    if (i == 0 || (side == 0 ? place > out : place < out)) out = place;
  }
  return out;
}

}  // namespace farcull
