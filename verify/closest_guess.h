// The features that two closest points probably lie on, in doubles (Ericson, Real-Time Collision
// Detection, 2005, sections 5.1.5 and 5.1.9). Nothing is proved here: verify/closest_points.cpp
// does that.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "verify/closest.h"
#include "verify/closest_features.h"

namespace farcull::closest {

struct Guess {
  double squared = std::numeric_limits<double>::infinity();
  Feature of_a, of_b;
};

/// Edge i at parameter s: the edge, or the corner at its end.
inline Feature on_edge(int i, double s) {
  if (s <= 0) return {FeatureKind::vertex, static_cast<std::uint8_t>(i)};
  if (s >= 1) return {FeatureKind::vertex, static_cast<std::uint8_t>(edge_end(i))};
  return {FeatureKind::edge, static_cast<std::uint8_t>(i)};
}

inline double in_unit(double x) { return x > 0 ? std::min(x, 1.0) : 0; }

/// Edge i of a and edge j of b, given as corners and differences between them. Nearly parallel
/// edges are closest at an end, or nearly so.
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

/// Corner p over the face of t. True where that is nearer than the guess.
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
