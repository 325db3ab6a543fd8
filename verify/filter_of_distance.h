// Two closest points are guessed in doubles (Ericson, Real-Time Collision Detection, 2005, sections
// 5.1.5 and 5.1.9). Either they prove the answer or there is none, however wrong the guess may be:
// the points show that the triangles come near, or the direction between them that they do not.
//
// All corners are taken relative to o = a[0]: a difference x = fl(corner - o) is off by u |x| at
// most, u = 2^-53. R is the largest |coordinate| of these.
//
// Near. p = sum of l_i x_i with weights l_i >= 0 that sum to 1 up to 4 u (two are computed, each at
// most 1, the third is 1 less the others, or 0 where that is negative by rounding), and q likewise.
// p is within (1 + 4 u) times u R (the differences) + 3 u R (products and sums) + 4 u R (weights,
// against those divided by their sum) < 9 u R per axis of a point of the triangle, and so q; their
// difference has one more rounding, of 2 u R: below 20.1 u R per axis and 35 u R in length. The
// computed length is below 4 R and off by less than 3 u of itself, and two sums follow: 20 u R. In
// all 55 u R; `point` is 64 u.
//
// Far. For any vector d the distance is at least (min d.b_j - max d.a_i) / |d|. A computed d.x is
// off by less than 5 u |d|.|x| (filter_of_planes.h), their difference by 2 u |d|.|x| more: 12 u M,
// M the product of the magnitudes of d with the largest |x| per axis. `gap` is 16 u. The computed
// length of d, times the clearance, is off by less than 4 u of itself, which the factor 1 + 8 u
// covers.
//
// Underflow: products are off by at most 2^-1075, far below `absolute`, where the length of d is
// as computed only if its square is at least 2^-900; a shorter one counts as 2^-450 at least where
// it shall be small. Overflow: as in filter_of_planes.h; infinities and what is
// not a number satisfy no comparison.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/scene/scene.h"
#include "verify/filter_bounds.h"

namespace farcull::filters {

using Corners = std::array<Vec3, 3>;

/// The best guess so far.
struct Closest {
  double squared = std::numeric_limits<double>::infinity();
  Vec3 difference = Vec3::Zero();

  void offer(const Vec3& d) {
    const double s = d.squaredNorm();
    if (s < squared) {
      squared = s;
      difference = d;
    }
  }
};

inline double clamped(double x) {
  return x > 0 ? std::min(x, 1.0) : 0;
}  // 0 for what is not a number

/// Between segments: from p + s u to q + t v, s and t in [0, 1].
inline void offer_segments(const Vec3& p, const Vec3& p_end, const Vec3& q, const Vec3& q_end,
                           Closest& closest) {
  const Vec3 u = p_end - p;
  const Vec3 v = q_end - q;
  const Vec3 w = p - q;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  double s = det > 0 ? clamped((uv * vw - vv * uw) / det) : 0;
  double t = vv > 0 ? (uv * s + vw) / vv : 0;
  if (!(t >= 0 && t <= 1)) {
    t = clamped(t);
    s = uu > 0 ? clamped((uv * t - uw) / uu) : 0;
  }
  closest.offer((q * (1 - t) + q_end * t) - (p * (1 - s) + p_end * s));
}

/// From a corner p to the face of t, where it lies over it; `sense` -1 turns the difference round.
inline void offer_face(const Vec3& p, const Corners& t, double sense, Closest& closest) {
  const Vec3 e = t[1] - t[0];
  const Vec3 f = t[2] - t[0];
  const Vec3 w = p - t[0];
  const double ee = e.dot(e), ef = e.dot(f), ff = f.dot(f), ew = e.dot(w), fw = f.dot(w);
  const double det = ee * ff - ef * ef;
  const double l = (ff * ew - ef * fw) / det;
  const double m = (ee * fw - ef * ew) / det;
  if (!(l >= 0 && m >= 0 && l + m <= 1)) return;
  const double k = std::max(1 - l - m, 0.0);
  closest.offer(sense * ((t[0] * k + t[1] * l + t[2] * m) - p));
}

/// The largest magnitude per axis.
inline Vec3 extent_of(const Corners& a, const Corners& b) {
  Vec3 most = Vec3::Zero();
  for (const Corners* t : {&a, &b}) {
    for (const Vec3& p : *t) most = most.cwiseMax(p.cwiseAbs());
  }
  return most;
}

/// Two points of the triangles, near each other, and the corners relative to a[0].
struct Near {
  Corners s, t;
  Closest closest;
};

inline Near near_points(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  Near out;
  auto& [s, t, closest] = out;
  for (int i = 0; i < 3; ++i) {
    s[i] = a[i] - a[0];
    t[i] = b[i] - a[0];
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      offer_segments(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3], closest);
    }
  }
  for (int i = 0; i < 3; ++i) {
    offer_face(s[i], t, 1, closest);
    offer_face(t[i], s, -1, closest);
  }
  return out;
}

/// By how much the projections onto the difference surely leave a gap, times its length.
template <class Bounds>
double gap_along(const Near& near, const Vec3& extent) {
  const auto& [s, t, closest] = near;
  const Vec3& d = closest.difference;
  const double s_most = std::max({d.dot(s[0]), d.dot(s[1]), d.dot(s[2])});
  const double t_least = std::min({d.dot(t[0]), d.dot(t[1]), d.dot(t[2])});
  const double doubt = Bounds::gap * d.cwiseAbs().dot(extent) + Bounds::absolute;
  return t_least - s_most - doubt;
}

template <class Bounds>
Triage filter_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  const Near near = near_points(a, b);
  const double squared = near.closest.squared;
  const Vec3 extent = extent_of(near.s, near.t);
  const double length = std::sqrt(std::max(squared, kLeastSquare));
  if (length + Bounds::point * extent.maxCoeff() + Bounds::absolute <= clearance)
    return Triage::yes;
  if (squared < kLeastSquare) return Triage::unknown;
  const double needed = clearance * length;
  return gap_along<Bounds>(near, extent) > needed + needed * kNeededRounding ? Triage::no
                                                                             : Triage::unknown;
}

/// The distance is at least `lower` and at most `upper`, which may be infinite.
struct DistanceBounds {
  double lower = 0;
  double upper = std::numeric_limits<double>::infinity();
};

/// Lower: the distance is at least the gap over |d|. The quotient is one rounding off, the computed
/// length 3 u, and the factor 1 - 8 u, itself rounded once, covers both. Nothing underflows there:
/// a gap above 0 is a multiple of the last bit of the doubt, hence above 2^-104 |d|^2 (no |d_k| is
/// more than twice the extent and a little), and |d| is at least 2^-450.
template <class Bounds>
DistanceBounds distance_bounds(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const Near near = near_points(a, b);
  const double squared = near.closest.squared;
  const Vec3 extent = extent_of(near.s, near.t);
  const double length = std::sqrt(std::max(squared, kLeastSquare));
  DistanceBounds out;
  const double upper = length + Bounds::point * extent.maxCoeff() + Bounds::absolute;
  if (upper >= 0) out.upper = upper;
  if (squared < kLeastSquare) return out;
  const double lower = gap_along<Bounds>(near, extent) / length * (1 - kNeededRounding);
  if (lower > 0) out.lower = lower;
  return out;
}

}  // namespace farcull::filters
