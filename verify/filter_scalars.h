// The filters (verify/filter.h) on scalars, and the derivations of their error bounds. The bounds
// are a template parameter.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/scene/scene.h"
#include "verify/rounding.h"

namespace farcull {

/// An order of the corners of a and of b, by number. One corner of each triangle lies alone on its
/// side of the other's plane. The two edges from this corner cross the common line of the planes;
/// the triangle covers the segment between the crossings. The other two corners are ordered so that
/// the other triangle's lone corner is on the positive side of this triangle's plane. So the order
/// of a segment's ends on the line is known, and two determinants compare the segments (Guigue,
/// Devillers: Fast and robust triangle-triangle overlap test using orientation predicates, 2003).
struct CornerOrder {
  std::array<std::uint8_t, 3> a, b;  // the lone corner comes first
};

/// a_above: bit i is set if corner i of a is on the positive side of the plane of b. b_above:
/// likewise for corners of b. Precondition: one or two bits of each are set.
constexpr CornerOrder corner_order(unsigned a_above, unsigned b_above) {
  // The corner that is alone on its side. Index: the set of corners on the positive side.
  constexpr std::array<std::uint8_t, 8> kAlone = {0, 0, 1, 2, 2, 1, 0, 0};
  const auto from = [](std::uint8_t alone) {
    return std::array<std::uint8_t, 3>{alone, static_cast<std::uint8_t>((alone + 1) % 3),
                                       static_cast<std::uint8_t>((alone + 2) % 3)};
  };
  CornerOrder order{from(kAlone[a_above]), from(kAlone[b_above])};
  if ((a_above >> order.a[0] & 1) == 0) std::swap(order.b[1], order.b[2]);
  if ((b_above >> order.b[0] & 1) == 0) std::swap(order.a[1], order.a[2]);
  return order;
}

/// Table of corner_order(), indexed by a_above (bits 0 to 2) and b_above (bits 3 to 5).
inline constexpr std::array<CornerOrder, 64> kCornerOrders = [] {
  std::array<CornerOrder, 64> orders{};
  for (unsigned bits = 0; bits < 64; ++bits) orders[bits] = corner_order(bits & 7, bits >> 3);
  return orders;
}();

}  // namespace farcull

namespace farcull::filters {

// ---- against planes ----
//
// Gappa proves the constants (docs/proofs.md, `filter.*`). The reasons follow, with the methods of
// Higham, Accuracy and Stability of Numerical Algorithms, 2002, chapter 3. Shewchuk, Adaptive
// Precision Floating-Point Arithmetic, 1997, bounds the same determinant. u = 2^-53.
//
// Side of a plane. With e = p - o, f = q - o and w = x - o, the determinant is a sum of six terms
// e_i f_j w_k. A term has at most 8 roundings: three differences, e_i f_j, the difference in n_k,
// n_k w_k, and two sums. So the computed determinant is off by at most ((1 + u)^8 - 1) P, where the
// permanent P is the sum of the exact |e_i f_j w_k|. P is computed by the same operations on
// magnitudes. Larger |w_k| only make P larger. With two more roundings for the bound, 9 u suffice.
//
// Product of two normals: the product has 11 roundings, its bound has 13, and 12 u suffice.
// Projection of w = x - o onto a direction whose doubles count as exact: the projection has 4
// roundings, its bound has 6, and the 9 u for sides of planes suffice.
//
// Underflow. Differences and sums of doubles are exact if they are subnormal. A product that
// underflows is off by up to 2^-1075 more. In the determinant, these errors sum to at most
// 2^-1073 (|w|_1 + 2), and likewise in other products. `absolute` is more than 2^70 times larger.
// So `absolute` and its products with numbers >= 1 are normal numbers, which are fast.
//
// Overflow. For every operation of the determinant, the permanent has the same operation on
// magnitudes. Its result is at least as large, since rounding is monotone. So if anything
// overflows, the bound is infinite or not a number, and every comparison with the bound is false.

using PlainReal = double;
using Real = double;
using Truth = bool;
using Point = Vec3;
using std::abs;
using std::max;
using std::min;
using std::sqrt;
inline bool of_all(bool answer) { return answer; }
#define FAR_FILTER inline
#include "verify/filter_planes.inl"
#undef FAR_FILTER

inline Triple operator+(const Triple& p, const Triple& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}
inline Triple operator-(const Triple& p, const Triple& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

/// Returns approximately p / |p|; not finite if p is zero or if products underflow or overflow.
inline Triple unit(const Triple& p) {
  const double length = std::sqrt(dot(p, p));
  return {p.x / length, p.y / length, p.z / length};
}

/// Returns the sign of a value with error at most `bound`: -1 or 1, or 0 if the sign is in doubt.
inline int sign(double value, double bound) { return (value > bound) - (value < -bound); }

/// Returns the sign of dot(normal.n, w), or 0 if the sign is in doubt.
template <class Bounds>
int side_of(const Normal& normal, const Triple& w) {
  return sign(dot(normal.n, w), side_bound<Bounds>(normal, magnitudes(w)));
}

/// Bit i of the result is set if the value of corner i is above 0.
inline unsigned above(const Sides& sides) {
  return (sides.value[0] > 0) + 2u * (sides.value[1] > 0) + 4u * (sides.value[2] > 0);
}

/// True only if w1 and w2 are on the positive side of the plane through 0 with normal d, and x1 and
/// x2 on its negative side. All four are differences of corners.
template <class Bounds>
bool divides(const Triple& d, const Triple& w1, const Triple& w2, const Triple& x1,
             const Triple& x2) {
  const Triple most = largest(largest(w1, w2), largest(x1, x2));
  const double bound = Bounds::side * dot(magnitudes(d), most) + Bounds::absolute;
  return dot(d, w1) > bound && dot(d, w2) > bound && dot(d, x1) < -bound && dot(d, x2) < -bound;
}

template <class Bounds>
Triage filter_planes(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  const AgainstPlanes planes = against_planes<Bounds>(a.data(), b.data(), clearance);
  if (planes.apart) return Triage::no;
  if (!planes.crossing) return Triage::unknown;
  const auto& [i, j] = kCornerOrders[above(planes.a) + 8 * above(planes.b)];
  const OnLine line = compare_on_line<Bounds>(a[i[0]], a[i[1]], a[i[2]], b[j[0]], b[j[1]], b[j[2]]);
  // Triangles that miss each other may still be within a clearance > 0.
  if (line.apart && clearance == 0) return Triage::no;
  return line.meeting ? Triage::yes : Triage::unknown;
}

// Corners are relative to v; N = a1 x a2 and M = b1 x b2. The signs of A1 = M . a1 and A2 = M . a2
// are the sides of b's plane on which a's corners lie. The signs of B1 = N . b1 and B2 = N . b2 are
// the sides of a's plane on which b's corners lie. If A1 and A2 have the same sign, a meets b's
// plane only in v. The same holds for B1, B2 and b. Otherwise each triangle meets the line of both
// planes in a segment from v. The segment of a has the direction sign(A2) (a1 A2 - a2 A1), that of
// b has sign(B2) (b1 B2 - b2 B1). Now a1 A2 - a2 A1 = M x N and b1 B2 - b2 B1 = N x M. So the
// directions are the same iff A2 and B2 differ in sign.
template <class Bounds>
Triage filter_beyond_vertex(const Vec3& v, const Vec3& a1, const Vec3& a2, const Vec3& b1,
                            const Vec3& b2) {
  const Triple e1 = difference(a1, v);
  const Triple e2 = difference(a2, v);
  const Triple f1 = difference(b1, v);
  const Triple f2 = difference(b2, v);
  const Normal n = normal_of(e1, e2);
  const double b_bound = side_bound<Bounds>(n, largest(f1, f2));
  const int b1_side = sign(dot(n.n, f1), b_bound);
  const int b2_side = sign(dot(n.n, f2), b_bound);
  if (b1_side * b2_side > 0) return Triage::no;
  const Normal m = normal_of(f1, f2);
  const double a_bound = side_bound<Bounds>(m, largest(e1, e2));
  const int a1_side = sign(dot(m.n, e1), a_bound);
  const int a2_side = sign(dot(m.n, e2), a_bound);
  if (a1_side * a2_side > 0) return Triage::no;
  if (a1_side * a2_side * b1_side * b2_side != 0)
    return a2_side * b2_side < 0 ? Triage::yes : Triage::no;
  // Nearly in one plane: if a plane through v separates the triangles, they share only v.
  return divides<Bounds>((unit(e1) + unit(e2)) - (unit(f1) + unit(f2)), e1, e2, f1, f2)
             ? Triage::no
             : Triage::unknown;
}

// The scalar product of (q - p) x (r - p) and (q - p) x (s - p) is |q - p|^2 times the scalar
// product of the parts of r - p and s - p perpendicular to the edge. If it is negative, the plane
// through the edge that is perpendicular to the first part has r on one side and s on the other.
// Then the triangles share only the edge. In a mesh, the product is negative at every edge not
// folded sharply. The triangles also share only the edge if s is off the plane of (p, q, r).
template <class Bounds>
Triage filter_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Triple e = difference(q, p);
  const Triple w = difference(s, p);
  const Normal n = normal_of(e, difference(r, p));
  const Normal m = normal_of(e, w);
  const double bound =
      Bounds::normals * dot(n.m, m.m) + Bounds::absolute * (sum(n.m) + sum(m.m) + 1);
  if (dot(n.n, m.n) < -bound) return Triage::no;
  return side_of<Bounds>(n, w) != 0 ? Triage::no : Triage::unknown;
}

// ---- by distance ----
//
// Two closest points are guessed in doubles (Ericson, Real-Time Collision Detection, 2005, sections
// 5.1.5 and 5.1.9). The points can prove that the triangles are near, and the direction between the
// points can prove that the triangles are far. If neither is proved, the answer is `unknown`. So a
// wrong guess never gives a wrong answer. Gappa proves the constants (docs/proofs.md,
// `distance.*`). The reasons follow.
//
// All corners are taken relative to o = a[0]. A rounded difference x = corner - o is off by at most
// u |x|. R is the largest |coordinate| of these differences.
//
// Near. The guessed point p of a is a sum of corners x_i with weights >= 0. Two weights are
// computed; the third is 1 minus the others, or 0 if rounding makes that negative. So the sum of
// the weights is 1 up to 4 u. Per axis, p is off from a point of a by less than 9 u R. The same
// holds for q and b. q - p is off by less than 35 u R in length. The roundings of its length and
// two sums give 55 u R in all; `point` is 64 u.
//
// Far. For any vector d the distance is at least (min d.b_j - max d.a_i) / |d|. The computed
// difference is off by less than 12 u M. Here M is the sum of |d_k| times the largest |x_k| over
// the axes k. `gap` is 16 u. The computed length of d, times the clearance, is off by less than 4 u
// of itself; the factor 1 + 8 u covers this.
//
// Underflow: products are off by at most 2^-1075, far below `absolute`. The computed length of d is
// accurate only if its square is at least 2^-900. For a smaller square, "near" uses the length
// 2^-450, and "far" answers `unknown`. Overflow: as for planes.

using Corners = std::array<Vec3, 3>;

/// Codes for the place of a point: i (0 to 2) for the edge from corner i to the next corner,
/// kCorner + i for corner i, and kFace for the face.
constexpr int kCorner = 3, kFace = 6;

struct Closest {
  double squared = std::numeric_limits<double>::infinity();
  Vec3 difference = Vec3::Zero();
  int of_a = kCorner, of_b = kCorner;  // the places of the two points
  double s = 0, t = 0;  // edges: fractions along a's and b's edge; face: weights of corners 1 and 2

  void offer(const Vec3& d, int on_a, int on_b, double along_a, double along_b) {
    const double square = d.squaredNorm();
    if (square < squared) *this = {square, d, on_a, on_b, along_a, along_b};
  }
};

inline double clamped(double x) { return x > 0 ? std::min(x, 1.0) : 0; }  // returns 0 for NaN

/// Offers two points to `closest`: p + s u of edge i of a and q + t v of edge j of b, with s and t
/// in [0, 1]. They are the closest points of these edges except for rounding.
inline void offer_segments(const Corners& a, int i, const Corners& b, int j, Closest& closest) {
  const Vec3 &p = a[i], &p_end = a[(i + 1) % 3], &q = b[j], &q_end = b[(j + 1) % 3];
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
  closest.offer((q * (1 - t) + q_end * t) - (p * (1 - s) + p_end * s), i, j, s, t);
}

/// If corner i of triangle `of` projects into the face of t, offers the difference from the corner
/// to the face. sense: 1 if `of` is a; -1 if `of` is b, and the opposite vector is offered.
inline void offer_face(const Corners& of, int i, const Corners& t, double sense, Closest& closest) {
  const Vec3& p = of[i];
  const Vec3 e = t[1] - t[0];
  const Vec3 f = t[2] - t[0];
  const Vec3 w = p - t[0];
  const double ee = e.dot(e), ef = e.dot(f), ff = f.dot(f), ew = e.dot(w), fw = f.dot(w);
  const double det = ee * ff - ef * ef;
  const double l = (ff * ew - ef * fw) / det;
  const double m = (ee * fw - ef * ew) / det;
  if (!(l >= 0 && m >= 0 && l + m <= 1)) return;
  const double k = std::max(1 - l - m, 0.0);
  const int corner = kCorner + i;
  closest.offer(sense * ((t[0] * k + t[1] * l + t[2] * m) - p), sense > 0 ? corner : kFace,
                sense > 0 ? kFace : corner, l, m);
}

/// Returns the largest |coordinate| of all corners, per axis.
inline Vec3 extent_of(const Corners& a, const Corners& b) {
  Vec3 most = Vec3::Zero();
  for (const Corners* t : {&a, &b}) {
    for (const Vec3& p : *t) most = most.cwiseMax(p.cwiseAbs());
  }
  return most;
}

inline Corners relative_to(const Vec3& origin, const Corners& t) {
  return {t[0] - origin, t[1] - origin, t[2] - origin};
}

/// The corners relative to a[0], and two points of the triangles near each other.
struct Near {
  Corners s, t;
  Closest closest;
};

inline Near near_points(const Corners& a, const Corners& b) {
  Near out{relative_to(a[0], a), relative_to(a[0], b), {}};
  auto& [s, t, closest] = out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) offer_segments(s, i, t, j, closest);
  }
  for (int i = 0; i < 3; ++i) {
    offer_face(s, i, t, 1, closest);
    offer_face(t, i, s, -1, closest);
  }
  return out;
}

/// Let d be the difference of the closest points. Returns a lower bound of |d| times the gap
/// between the projections of the triangles onto d.
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
Triage filter_within(const Corners& a, const Corners& b, double clearance) {
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

/// Lower bound: the distance is at least gap_along() / |d|. The quotient has one rounding, and the
/// computed length is off by 3 u. The factor 1 - 8 u, itself rounded once, covers both. The
/// quotient does not underflow: |d| is at least 2^-450, and a gap above 0 is a multiple of the last
/// bit of `doubt`, hence above 2^-104 |d|^2 (no |d_k| is much more than twice the extent).
template <class Bounds>
DistanceBounds distance_bounds(const Near& near) {
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

template <class Bounds>
DistanceBounds distance_bounds(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return distance_bounds<Bounds>(near_points(a, b));
}

}  // namespace farcull::filters
