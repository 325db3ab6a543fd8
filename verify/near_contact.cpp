// Finds contacts. The contact of near triangles comes from the two points of the distance filter
// (verify/filter_scalars.h). The contact of crossing triangles is a point where an edge passes
// through a face. Exact arithmetic decides the other pairs.
#include "verify/near_contact.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "verify/closest_features.h"
#include "verify/filter_scalars.h"
#include "verify/squared_distance.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

// ---- in doubles
//
// Distance. distance_bounds() gives two bounds of the exact distance D. The length L of the
// difference of two computed points lies between them. The bounds are accepted if they differ by at
// most 2^-33 of the lower bound. So L is off by at most 2^-32 D. Between 2^-33 and 2^-32, there is
// room for the roundings of that comparison.
//
// Normal. Let w be the exact difference of nearest points, so |w| = D. Let x be the exact
// difference of the points that have the computed weights (divided by the sum of the weights).
// - The computed difference is off from x by at most the difference of the bounds, so
//   |x| <= D (1 + 2^-32).
// - All differences of a point of b and a point of a form a convex set. w is its point nearest to
//   0, and x is in it, so (x - w) . w >= 0. Hence |x - w|^2 <= |x|^2 - |w|^2 < 2^-30.9 D^2.
// - Together the computed difference is off from w by less than 2^-15.4 D. So the angle between
//   them has a sine below 2^-15.4, and the unit vectors differ by less than 2^-15.3. The roundings
//   of the quotient add a few u.
//
// Points. With weights l_1, l_2 and corners c_0 to c_2 the point is
// c_0 + ((c_1 - c_0) l_1 + (c_2 - c_0) l_2). The differences are off by u R. Products and sums add
// 3 u R, as the weights sum to at most 1 + u. If rounding makes the weight of c_0 negative, it is
// set to 0, which moves the point by 2 u R. All this is below 8 u R. The last rounding is that of
// the sum with c_0.

/// Returns the feature on which the point with these weights lies.
Feature feature_of(const Vec3& weights) {
  const unsigned corners = (weights[0] != 0) + 2u * (weights[1] != 0) + 4u * (weights[2] != 0);
  constexpr std::array<Feature, 8> kOf = {{{FeatureKind::face, 0},
                                           {FeatureKind::vertex, 0},
                                           {FeatureKind::vertex, 1},
                                           {FeatureKind::edge, 0},
                                           {FeatureKind::vertex, 2},
                                           {FeatureKind::edge, 2},
                                           {FeatureKind::edge, 1},
                                           {FeatureKind::face, 0}}};
  return kOf[corners];
}

Vec3 edge_weights(int edge, double along) {
  Vec3 out = Vec3::Zero();
  out[edge] = 1 - along;
  out[(edge + 1) % 3] = along;
  return out;
}

/// Returns the weights of a point. on: its place, as in filters::Closest. along: how far along an
/// edge. l, m: the weights of corners 1 and 2 of a face.
Vec3 weights_of(int on, double along, double l, double m) {
  if (on == filters::kFace) return {std::max(1 - l - m, 0.0), l, m};
  return on < filters::kCorner ? edge_weights(on, along) : edge_weights(on - filters::kCorner, 0);
}

/// Returns the weighted mean of the corners. + 0.0 turns -0.0 into 0.0.
Vec3 mean(const Corners& t, const Vec3& weights) {
  for (int i = 0; i < 3; ++i) {
    if (weights[i] == 1) return t[i].array() + 0.0;
  }
  return t[0] + ((t[1] - t[0]) * weights[1] + (t[2] - t[0]) * weights[2]);
}

NearContact contact_at(const Corners& a, const Corners& b, const std::array<Vec3, 2>& weights) {
  return {.points = {mean(a, weights[0]), mean(b, weights[1])},
          .weights = weights,
          .features = {feature_of(weights[0]), feature_of(weights[1])}};
}

/// An edge of one triangle that passes through the face of the other one.
struct Passing {
  double least = -HUGE_VAL;  // least of the three weights of the point in the face
  std::array<Vec3, 2> weights = {Vec3::Zero(), Vec3::Zero()};  // of the point on a, then on b
  int side = 0;                                                // 0: the edge is one of a; 1: of b
  double gap = HUGE_VAL;                                       // L1 distance of the two points
};

/// Sets `best` to the edge of x that passes deepest inside y, if it is deeper than `best`. Depth is
/// the least weight (negative outside y). side: 0 if x is a, 1 if x is b.
void offer_passing(const Corners& x, const Corners& y, int side, Passing& best) {
  const Vec3 e = y[1] - y[0], f = y[2] - y[0], n = e.cross(f);
  const double nn = n.squaredNorm();
  const std::array<double, 3> height = {n.dot(x[0] - y[0]), n.dot(x[1] - y[0]), n.dot(x[2] - y[0])};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if ((height[i] > 0) == (height[j] > 0)) continue;
    const double along = height[i] / (height[i] - height[j]);
    const Vec3 at = x[i] * (1 - along) + x[j] * along, w = at - y[0];
    double l = n.dot(w.cross(f)) / nn, m = n.dot(e.cross(w)) / nn;
    const double least = std::min({l, m, 1 - l - m});
    if (!(least > best.least)) continue;
    l = std::max(l, 0.0);
    m = std::max(m, 0.0);
    const double sum = std::max(l + m, 1.0);
    const Vec3 in_face = weights_of(filters::kFace, 0, l / sum, m / sum);
    best = {.least = least, .side = side};
    best.weights[side] = edge_weights(i, along);
    best.weights[1 - side] = in_face;
    best.gap = (y[0] * in_face[0] + y[1] * in_face[1] + y[2] * in_face[2] - at).cwiseAbs().sum();
  }
}

/// Returns the contact of triangles that cross: the point where an edge of one meets the other.
/// Empty if that point is not certainly near enough to the other triangle.
std::optional<NearContact> crossing_contact(const Corners& a, const Corners& b) {
  const Corners s = filters::relative_to(a[0], a), t = filters::relative_to(a[0], b);
  Passing best;
  offer_passing(s, t, 0, best);
  offer_passing(t, s, 1, best);
  const double bound = FilterBounds::point * filters::extent_of(s, t).maxCoeff();
  if (!(best.gap < bound && bound < HUGE_VAL)) return {};
  NearContact out = contact_at(a, b, best.weights);
  out.points[1 - best.side] = out.points[best.side];
  if (!out.points[0].allFinite()) return {};
  return out;
}

}  // namespace

NearContact exact_contact(const Corners& a, const Corners& b, const Closest& closest) {
  NearContact out{
      .distance = closest.distance, .points = closest.points, .features = closest.features};
  const Scaled pair(a, b);
  closest::Found<mpz_class> found;
  const auto& [of_a, of_b] = closest.features;
  if (!closest::find(pair.a, of_a, pair.b, of_b, found))
    throw std::logic_error("exact_contact: these are no closest features");
  for (int side = 0; side < 2; ++side) {
    const Feature& feature = closest.features[side];
    const Feature& other = closest.features[1 - side];
    Vec3& weights = out.weights[side];
    weights = edge_weights(feature.index, 0);
    if (feature.kind == FeatureKind::vertex) continue;
    auto [l, m] = found.multiples[side];
    mpz_class below = found.below;
    if (feature.kind == FeatureKind::edge) {
      weights[feature.index] = rounded_quotient(below - l, below, 0);
      weights[closest::edge_end(feature.index)] = rounded_quotient(l, below, 0);
      continue;
    }
    if (other.kind == FeatureKind::edge) {  // computes multiples for the point in the face
      const Scaled::Corners& face = side == 0 ? pair.a : pair.b;
      const auto e = closest::minus(face[1], face[0]), f = closest::minus(face[2], face[0]);
      const auto n = closest::cross(e, f);
      auto w = closest::point_of(side == 0 ? pair.b : pair.a, other, found, 1 - side);
      for (int k = 0; k < 3; ++k) w[k] -= face[0][k] * below;
      l = closest::dot(n, closest::cross(w, f));
      m = closest::dot(n, closest::cross(e, w));
      below *= closest::dot(n, n);
    }
    weights = {rounded_quotient(below - l - m, below, 0), rounded_quotient(l, below, 0),
               rounded_quotient(m, below, 0)};
  }
  if (closest.squared.is_zero()) return out;
  // Each coordinate is rounded once to a double of at most 1, and the length has 4 roundings more.
  const long bits = most_bits(found.direction);
  for (int k = 0; k < 3; ++k) out.normal[k] = rounded(found.direction[k], -bits);
  out.normal /= out.normal.norm();
  return out;
}

std::optional<NearContact> contact_within(const Corners& a, const Corners& b, double within,
                                          Triage planes, double tolerance) {
  if (planes == Triage::no) return {};
  if (planes == Triage::yes) {
    if (auto crossing = crossing_contact(a, b)) return crossing;
  } else {
    const filters::Near near = filters::near_points(a, b);
    const filters::DistanceBounds bounds = filters::distance_bounds<FilterBounds>(near);
    if (bounds.lower > within) return {};
    if (bounds.upper <= within && bounds.upper - bounds.lower <= tolerance * bounds.lower) {
      const auto& [squared, difference, of_a, of_b, s, t] = near.closest;
      NearContact out = contact_at(a, b, {weights_of(of_a, s, s, t), weights_of(of_b, t, s, t)});
      out.distance = std::sqrt(squared);
      out.normal = (difference / out.distance).array() + 0.0;  // never -0.0
      if (out.points[0].allFinite() && out.points[1].allFinite()) return out;
    }
  }
  const Closest closest = closest_points(a, b);
  if (closest.squared > SquaredDistance::of(within)) return {};
  return exact_contact(a, b, closest);
}

}  // namespace farcull
