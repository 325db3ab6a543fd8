// Two closest points of two features, by the condition that their difference is perpendicular to
// both: in integers, nothing rounded. For verify/closest_points.cpp, which derives how the answer
// for triangles follows.
//
// Corners are integers of one scale. A point of a feature is a corner plus multiples of edges from
// it, the multiples fractions with one denominator for both points (Found::below).
#pragma once

#include <array>
#include <utility>

#include "verify/closest.h"

namespace farcull::closest {

template <class Integer>
using Vector = std::array<Integer, 3>;
template <class Integer>
using Corners = std::array<Vector<Integer>, 3>;

template <class Integer>
Vector<Integer> minus(const Vector<Integer>& x, const Vector<Integer>& y) {
  return {Integer(x[0] - y[0]), Integer(x[1] - y[1]), Integer(x[2] - y[2])};
}

template <class Integer>
Integer dot(const Vector<Integer>& x, const Vector<Integer>& y) {
  return Integer(x[0] * y[0] + x[1] * y[1] + x[2] * y[2]);
}

template <class Integer>
Vector<Integer> cross(const Vector<Integer>& x, const Vector<Integer>& y) {
  return {Integer(x[1] * y[2] - x[2] * y[1]), Integer(x[2] * y[0] - x[0] * y[2]),
          Integer(x[0] * y[1] - x[1] * y[0])};
}

/// The two ends of an edge by number.
constexpr int edge_end(int edge) { return edge == 2 ? 0 : edge + 1; }

/// Bit i is set where corner i belongs to the feature.
constexpr unsigned corners_of(const Feature& f) {
  if (f.kind == FeatureKind::vertex) return 1u << f.index;
  return f.kind == FeatureKind::edge ? 1u << f.index | 1u << edge_end(f.index) : 7u;
}

/// A pair of points, one of each feature, that the difference of both is perpendicular to.
template <class Integer>
struct Found {
  Integer num, den;           // the squared distance is num / den, den > 0
  Vector<Integer> direction;  // a positive multiple of the difference, from a's point to b's
  Integer below;              // > 0, the denominator of the multiples
  // Per triangle, a and b. Edge: the multiple of the edge. Face: the multiples of the edges from
  // corner 0 to corners 1 and 2. Vertex: not used.
  std::array<std::array<Integer, 2>, 2> multiples;
  bool inside = false;  // neither point lies on an edge or a corner that is less than its feature
};

// Each of these looks for such a pair, and answers whether there is just one in the closed
// features. Where it is false the contents of `f` do not count.

template <class Integer>
bool vertex_vertex(const Vector<Integer>& p, const Vector<Integer>& q, Found<Integer>& f) {
  f.direction = minus(q, p);
  f.num = dot(f.direction, f.direction);
  f.den = 1;
  f.below = 1;
  f.inside = true;
  return true;
}

/// From the corner p to the edge from q to q_end.
template <class Integer>
bool vertex_edge(const Vector<Integer>& p, const Vector<Integer>& q, const Vector<Integer>& q_end,
                 Found<Integer>& f) {
  const Vector<Integer> v = minus(q_end, q);
  const Vector<Integer> x = minus(p, q);
  Integer& along = f.multiples[1][0];
  along = dot(x, v);
  if (along < 0) return false;
  f.below = dot(v, v);
  if (f.below == 0 || along > f.below) return false;
  for (int k = 0; k < 3; ++k) f.direction[k] = along * v[k] - f.below * x[k];
  f.den = f.below;
  f.num = dot(x, x) * f.below - along * along;
  f.inside = along > 0 && along < f.below;
  return true;
}

/// From the corner p to the face of t. With n = e x f and p - t0 = l e + m f + h n, it is
/// (p - t0) x f = l n + ..., and the rest is perpendicular to n; m follows in the same way.
template <class Integer>
bool vertex_face(const Vector<Integer>& p, const Corners<Integer>& t, Found<Integer>& f) {
  const Vector<Integer> to_1 = minus(t[1], t[0]);
  const Vector<Integer> to_2 = minus(t[2], t[0]);
  const Vector<Integer> x = minus(p, t[0]);
  const Vector<Integer> n = cross(to_1, to_2);
  Integer& l = f.multiples[1][0];
  Integer& m = f.multiples[1][1];
  l = dot(n, cross(x, to_2));
  if (l < 0) return false;
  m = dot(n, cross(to_1, x));
  if (m < 0) return false;
  f.below = dot(n, n);
  const Integer rest = f.below - l - m;
  if (f.below == 0 || rest < 0) return false;
  const Integer height = dot(n, x);
  for (int k = 0; k < 3; ++k) f.direction[k] = height > 0 ? Integer(-n[k]) : n[k];
  f.den = f.below;
  f.num = height * height;
  f.inside = l > 0 && m > 0 && rest > 0;
  return true;
}

/// From the edge p to p_end to the edge q to q_end. Parallel ones have no single pair.
template <class Integer>
bool edge_edge(const Vector<Integer>& p, const Vector<Integer>& p_end, const Vector<Integer>& q,
               const Vector<Integer>& q_end, Found<Integer>& f) {
  const Vector<Integer> u = minus(p_end, p);
  const Vector<Integer> v = minus(q_end, q);
  const Vector<Integer> w = minus(p, q);
  const Vector<Integer> n = cross(u, v);
  f.below = dot(n, n);
  if (f.below == 0) return false;
  const Integer uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  Integer& s = f.multiples[0][0];
  Integer& t = f.multiples[1][0];
  s = uv * vw - vv * uw;
  if (s < 0 || s > f.below) return false;
  t = uu * vw - uv * uw;
  if (t < 0 || t > f.below) return false;
  const Integer height = dot(n, w);
  for (int k = 0; k < 3; ++k) f.direction[k] = height > 0 ? Integer(-n[k]) : n[k];
  f.den = f.below;
  f.num = height * height;
  f.inside = s > 0 && s < f.below && t > 0 && t < f.below;
  return true;
}

/// True if the edge from p to p_end passes through the face of t, not along it: the distance is 0.
template <class Integer>
bool edge_face(const Vector<Integer>& p, const Vector<Integer>& p_end, const Corners<Integer>& t,
               Found<Integer>& f) {
  const Vector<Integer> u = minus(p_end, p);
  const Vector<Integer> x = minus(p, t[0]);
  const Vector<Integer> n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  Integer above = dot(n, x);
  Integer fall = -dot(n, u);
  if (fall == 0) return false;
  if (fall < 0) {
    above = -above;
    fall = -fall;
  }
  if (above < 0 || above > fall) return false;
  for (int i = 0; i < 3; ++i) {
    // The point in which the edge crosses the plane, relative to corner i, times `fall`.
    Vector<Integer> at = minus(p, t[i]);
    for (int k = 0; k < 3; ++k) at[k] = at[k] * fall + u[k] * above;
    if (dot(n, cross(minus(t[edge_end(i)], t[i]), at)) < 0) return false;
  }
  f.num = 0;
  f.den = 1;
  f.direction = {Integer(0), Integer(0), Integer(0)};
  f.below = fall;
  f.multiples[0][0] = above;
  f.inside = false;
  return true;
}

/// That of a feature of a and one of b. A face and a face have no single pair.
template <class Integer>
bool find(const Corners<Integer>& a, const Feature& of_a, const Corners<Integer>& b,
          const Feature& of_b, Found<Integer>& f) {
  if (of_a.kind > of_b.kind) {
    if (!find(b, of_b, a, of_a, f)) return false;
    for (Integer& x : f.direction) x = -x;
    std::swap(f.multiples[0], f.multiples[1]);
    return true;
  }
  const int i = of_a.index, j = of_b.index;
  if (of_a.kind == FeatureKind::vertex) {
    if (of_b.kind == FeatureKind::vertex) return vertex_vertex(a[i], b[j], f);
    if (of_b.kind == FeatureKind::edge) return vertex_edge(a[i], b[j], b[edge_end(j)], f);
    return vertex_face(a[i], b, f);
  }
  if (of_a.kind == FeatureKind::face) return false;
  if (of_b.kind == FeatureKind::edge)
    return edge_edge(a[i], a[edge_end(i)], b[j], b[edge_end(j)], f);
  return edge_face(a[i], a[edge_end(i)], b, f);
}

/// The point of the feature, times f.below.
template <class Integer>
Vector<Integer> point_of(const Corners<Integer>& t, const Feature& feature, const Found<Integer>& f,
                         int side) {
  const std::array<Integer, 2>& m = f.multiples[side];
  const Vector<Integer>& from = t[feature.kind == FeatureKind::face ? 0 : feature.index];
  Vector<Integer> out;
  for (int k = 0; k < 3; ++k) {
    out[k] = from[k] * f.below;
    if (feature.kind == FeatureKind::edge)
      out[k] += (t[edge_end(feature.index)][k] - from[k]) * m[0];
    if (feature.kind == FeatureKind::face)
      out[k] += (t[1][k] - from[k]) * m[0] + (t[2][k] - from[k]) * m[1];
  }
  return out;
}

}  // namespace farcull::closest
