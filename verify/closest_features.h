// Finds two closest points of two features (corner, edge or face of a triangle): the points whose
// difference is perpendicular to both features. All numbers are integers, so nothing is rounded.
// verify/closest_points.cpp uses this file; other sources use only the vector functions.
//
// Corners have integer coordinates in one common scale. A point of a feature is a corner plus
// multiples of the edges from that corner. The multiples are fractions with the denominator
// Found::below.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
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

/// Returns the index of the corner where an edge ends. Edge i begins at corner i.
constexpr int edge_end(int edge) { return edge == 2 ? 0 : edge + 1; }

/// Bit i of the result is set if corner i belongs to the feature.
constexpr unsigned corners_of(const Feature& f) {
  if (f.kind == FeatureKind::vertex) return 1u << f.index;
  return f.kind == FeatureKind::edge ? 1u << f.index | 1u << edge_end(f.index) : 7u;
}

/// Two points, one of each feature, whose difference is perpendicular to both features.
template <class Integer>
struct Found {
  Integer num, den;           // the squared distance is num / den, den > 0
  Vector<Integer> direction;  // a positive multiple of (b's point - a's point)
  Integer below;              // > 0; denominator of `multiples`
  // Numerators for the point of a, then for the point of b. Edge: {t, unused}; the point is start +
  // t / below * edge. Face: {s, t}; the point is corner 0 + s / below * (corner 1 - corner 0) + t /
  // below * (corner 2 - corner 0). Vertex: not used.
  std::array<std::array<Integer, 2>, 2> multiples;
  bool inside = false;  // true: neither point is on the boundary of its feature
};

// Each of the next functions looks for two points as described at Found. If the closed features
// have exactly one such pair of points, writes the pair to `f` and returns true. Otherwise returns
// false, and `f` must not be used.

template <class Integer>
bool vertex_vertex(const Vector<Integer>& p, const Vector<Integer>& q, Found<Integer>& f) {
  f.direction = minus(q, p);
  f.num = dot(f.direction, f.direction);
  f.den = 1;
  f.below = 1;
  f.inside = true;
  return true;
}

/// Looks for the points of the corner p and the edge from q to q_end.
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

/// Looks for the closest points of the corner p and the face of t. Let e and f be the edges from
/// t0, n = e x f, and p - t0 = l e + m f + h n. Then (p - t0) x f = l n + h n x f. Since n x f is
/// perpendicular to n, the scalar product with n gives l. The same steps give m.
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

/// Looks for the closest points of the edge p to p_end and the edge q to q_end. Returns false for
/// parallel edges, which have no single closest pair.
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

/// Looks for the point where the edge from p to p_end crosses the plane of t, if there is one such
/// point and it lies in the face. The distance is then 0.
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
    // The point where the edge crosses the plane, relative to corner i, times `fall`.
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

/// Looks for the closest points of a feature of a and a feature of b. Returns false for two faces,
/// which never have a single closest pair.
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

/// Returns the point of the feature, multiplied by f.below. side: 0 for the point of a, 1 for b.
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

// Guesses in double the features on which two closest points lie (Ericson, Real-Time Collision
// Detection, 2005, sections 5.1.5 and 5.1.9). verify/closest_points.cpp proves the guess.

struct Guess {
  double squared = std::numeric_limits<double>::infinity();
  Feature of_a, of_b;
};

/// Returns the feature at parameter s of edge i: a corner if s <= 0 or s >= 1, else the edge.
inline Feature on_edge(int i, double s) {
  if (s <= 0) return {FeatureKind::vertex, static_cast<std::uint8_t>(i)};
  if (s >= 1) return {FeatureKind::vertex, static_cast<std::uint8_t>(edge_end(i))};
  return {FeatureKind::edge, static_cast<std::uint8_t>(i)};
}

inline double in_unit(double x) { return x > 0 ? std::min(x, 1.0) : 0; }

/// Improves the guess by edge i of a (from a[i] along u) and edge j of b (from b[j] along v). If
/// the edges are nearly parallel, uses an end of an edge, which is closest or nearly closest.
inline void guess_edges(const std::array<Vec3, 3>& a, const Vec3& u, int i,
                        const std::array<Vec3, 3>& b, const Vec3& v, int j, Guess& guess) {
  const Vec3 w = a[i] - b[j];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  double s = det > 0x1p-44 * uu * vv ? in_unit((uv * vw - vv * uw) / det) : 0;
  double t = vv > 0 ? (uv * s + vw) / vv : 0;
  if (!(t > 0 && t < 1)) {
    t = in_unit(t);
    s = uu > 0 ? in_unit((uv * t - uw) / uu) : 0;
  }
  const double squared = (w + u * s - v * t).squaredNorm();
  if (squared < guess.squared) guess = {squared, on_edge(i, s), on_edge(j, t)};
}

/// True if corner p lies over the face of t, with a squared distance below guess.squared. Then sets
/// guess.squared to this squared distance.
inline bool guess_face(const Vec3& p, const std::array<Vec3, 3>& t, Guess& guess) {
  const Vec3 e = t[1] - t[0], f = t[2] - t[0], w = p - t[0];
  const Vec3 n = e.cross(f);
  const double nn = n.squaredNorm(), height = n.dot(w);
  const double squared = height * height / nn;
  if (!(squared < guess.squared)) return false;
  const double l = n.dot(w.cross(f)), m = n.dot(e.cross(w));
  if (!(l > 0 && m > 0 && l + m < nn)) return false;
  guess.squared = squared;
  return true;
}

inline Guess guess_features(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  Guess guess;
  const std::array<Vec3, 3> v = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = a[edge_end(i)] - a[i];
    for (int j = 0; j < 3; ++j) guess_edges(a, u, i, b, v[j], j, guess);
  }
  const Feature face = {FeatureKind::face, 0};
  for (int i = 0; i < 3; ++i) {
    const Feature corner = {FeatureKind::vertex, static_cast<std::uint8_t>(i)};
    if (guess_face(a[i], b, guess)) guess = {guess.squared, corner, face};
    if (guess_face(b[i], a, guess)) guess = {guess.squared, face, corner};
  }
  return guess;
}

}  // namespace farcull::closest
