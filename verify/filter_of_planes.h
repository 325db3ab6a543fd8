// The bounds (Higham, Accuracy and Stability of Numerical Algorithms, 2002, chapter 3; Shewchuk,
// Adaptive Precision Floating-Point Arithmetic, 1997, for the same determinant). u = 2^-53; without
// underflow and overflow every operation multiplies its exact result by some 1 + d, |d| <= u.
//
// Side of a plane. With e = p - o, f = q - o, w = x - o, the determinant is the sum over k of
// n_k w_k, n = e x f: six terms e_i f_j w_k. A term meets at most 8 roundings: one in each of its
// three differences, e_i f_j, the difference in n_k, n_k w_k, and two sums. So the computed D
// differs from the exact one by at most ((1 + u)^8 - 1) P, where P is the sum of the six exact
// |e_i f_j w_k|. The permanent is computed by the same operations on magnitudes, with at most 8
// roundings a term, hence P <= (1 - u)^-8 times the computed one, and larger |w_k| only enlarge it.
// The bound itself takes two more roundings. ((1 + u)^8 - 1) (1 - u)^-10 < 8 u + 150 u^2 < 9 u.
//
// Product of two normals n.m: a normal's terms meet 4 roundings each, the products and sums 3 more:
// 11, and the bound 13 more at most: (1 + u)^11 - 1 over (1 - u)^13 is below 12 u.
//
// Projection of w = x - o onto a direction d that is given (however it was found, its doubles are
// what is meant): one difference, one product, two sums: 4, and the bound 6 more: below 5 u. The 9
// u of sides serve.
//
// Underflow. Differences and sums of doubles are exact where they are subnormal. A product is off
// by at most 2^-1075 more. In D: two in each n_k, times w_k, and one in each n_k w_k, which makes
// at most 2^-1073 (|w|_1 + 2) with all later roundings; in n.m, 2^-1073 (|n|_1 + |m|_1 + 2), also
// with |n|_1 as computed from magnitudes; in a projection 2^-1073. The same happens to the
// permanent, times 12 u. `absolute` is 2^70 times that and more, since 2^-1000 and its products
// with what is at least 1 are normal numbers, on which every processor is fast.
//
// Overflow. Every operation of D has its like on magnitudes in the permanent, which is at least as
// large, for rounding is monotone. So where anything overflows the bound is infinite or not a
// number, and no comparison with it holds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/scene.h"
#include "verify/corner_order.h"
#include "verify/filter_bounds.h"

namespace farcull::filters {

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

/// About p / |p|; not finite where p is zero or products underflow or overflow.
inline Triple unit(const Triple& p) {
  const double length = std::sqrt(dot(p, p));
  return {p.x / length, p.y / length, p.z / length};
}

/// -1, 1, or 0 for a doubt.
inline int sign(double value, double bound) { return (value > bound) - (value < -bound); }

/// Bit i where the value of corner i is above 0.
inline unsigned above(const Sides& sides) {
  return (sides.value[0] > 0) + 2u * (sides.value[1] > 0) + 4u * (sides.value[2] > 0);
}

/// True where d surely divides: w1, w2 on its positive side, x1, x2 on the negative one. All are
/// differences of coordinates.
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
  // Triangles that miss each other may be within a clearance.
  if (line.apart && clearance == 0) return Triage::no;
  return line.meeting ? Triage::yes : Triage::unknown;
}

// Seen from v, with N = a1 x a2 and M = b1 x b2: A1 = M . a1 and A2 = M . a2 give the sides of b's
// plane that a's corners are on, B1 = N . b1 and B2 = N . b2 likewise. If A1 and A2 have the same
// sign, a meets b's plane in v alone; likewise b. Else each triangle meets the line of both planes
// in a segment from v, in the directions sign(A2) (a1 A2 - a2 A1) and sign(B2) (b1 B2 - b2 B1),
// since these are sums with weights above 0 and lie in the other plane. Now a1 A2 - a2 A1 = M x N
// and b1 B2 - b2 B1 = N x M, so the directions are the same iff A2 and B2 differ in sign.
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
  // Nearly in one plane: a plane through v that has one triangle on each side proves as much.
  return divides<Bounds>((unit(e1) + unit(e2)) - (unit(f1) + unit(f2)), e1, e2, f1, f2)
             ? Triage::no
             : Triage::unknown;
}

// (q - p) x (r - p) . (q - p) x (s - p) is |q - p|^2 times the product of the parts of r - p and
// s - p that are perpendicular to the edge. Where it is negative, the plane through the edge that
// is perpendicular to the first part has r on one side and s on the other: the triangles share the
// edge alone. It is at every edge of a mesh that is not folded sharply. Else s off the plane of (p,
// q, r) proves the same.
template <class Bounds>
Triage filter_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Triple e = difference(q, p);
  const Triple w = difference(s, p);
  const Normal n = normal_of(e, difference(r, p));
  const Normal m = normal_of(e, w);
  const double bound =
      Bounds::normals * dot(n.m, m.m) + Bounds::absolute * (sum(n.m) + sum(m.m) + 1);
  if (dot(n.n, m.n) < -bound) return Triage::no;
  const int off = sign(dot(n.n, w), side_bound<Bounds>(n, magnitudes(w)));
  return off != 0 ? Triage::no : Triage::unknown;
}

}  // namespace farcull::filters
