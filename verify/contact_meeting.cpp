// Finds how two triangles meet by signs of determinants of their corners (Guigue, Devillers: Fast
// and robust triangle-triangle overlap test using orientation predicates, 2003). No point is
// constructed. Doubles decide most signs, with the error bounds of verify/filter_scalars.h. CGAL's
// kernel Epick decides the other signs. Epick is exact for determinants of input points
// (verify/exact.cpp gives the reasons).
#include "verify/contact_meeting.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <utility>

#include "verify/filter_scalars.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Exact signs of determinants of the corners of two triangles. Corners 0 to 2 are those of a,
/// corners 3 to 5 those of b. Doubles decide most signs. If each term of a determinant has a factor
/// 0, as often with axis-aligned faces, the determinant is 0. CGAL decides the other signs.
class Signs {
 public:
  Signs(const Corners& a, const Corners& b) : a_(a), b_(b) {}

  const Vec3& corner(int k) const { return k < 3 ? a_[k] : b_[k - 3]; }

  /// Returns the sign of det(q - p, r - p, s - p).
  int side(int p, int q, int r, int s) const {
    const auto e = from(p, q), f = from(p, r), w = from(p, s);
    const int sign = filters::side_of<FilterBounds>(filters::normal_of(e, f), w);
    if (sign != 0) return sign;
    // The difference of two different doubles is never rounded to 0, since subnormals are kept.
    const bool terms = (w.x != 0 && ((e.y != 0 && f.z != 0) || (e.z != 0 && f.y != 0))) ||
                       (w.y != 0 && ((e.z != 0 && f.x != 0) || (e.x != 0 && f.z != 0))) ||
                       (w.z != 0 && ((e.x != 0 && f.y != 0) || (e.y != 0 && f.x != 0)));
    if (!terms || corner(s) == corner(q) || corner(s) == corner(r) || corner(q) == corner(r))
      return 0;
    return CGAL::orientation(point(p), point(q), point(r), point(s));
  }

  /// Returns the sign of the component of (q - p) x (r - p) along an axis.
  int turn(int axis, int p, int q, int r) const {
    const Vec3 e = corner(q) - corner(p), f = corner(r) - corner(p);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double first = e[u] * f[v], second = e[v] * f[u];
    const int sign =
        filters::sign(first - second, FilterBounds::side * (std::abs(first) + std::abs(second)) +
                                          FilterBounds::absolute);
    if (sign != 0) return sign;
    const bool terms = (e[u] != 0 && f[v] != 0) || (e[v] != 0 && f[u] != 0);
    if (!terms || corner(q) == corner(r)) return 0;
    return CGAL::orientation(point(p, u, v), point(q, u, v), point(r, u, v));
  }

  /// Returns the lowest axis along which the normal of a triangle is not 0; none if the triangle is
  /// a segment or a point. first: the number of the triangle's first corner.
  std::optional<int> axis_of(int first) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (turn(axis, first, first + 1, first + 2) != 0) return axis;
    }
    return std::nullopt;
  }

  /// True if corner k lies in the closed triangle whose first corner is `first`. Preconditions: the
  /// corner lies in the triangle's plane; the plane's normal is not 0 along `axis`.
  bool holds(int first, int axis, int k) const {
    int least = 0, most = 0;
    for (int i = 0; i < 3; ++i) {
      const int sign = turn(axis, first + i, first + (i + 1) % 3, k);
      least = std::min(least, sign);
      most = std::max(most, sign);
    }
    return least == 0 || most == 0;
  }

 private:
  filters::Triple from(int p, int q) const { return filters::difference(corner(q), corner(p)); }
  Kernel::Point_3 point(int k) const { return {corner(k).x(), corner(k).y(), corner(k).z()}; }
  Kernel::Point_2 point(int k, int u, int v) const { return {corner(k)[u], corner(k)[v]}; }

  const Corners& a_;
  const Corners& b_;
};

/// Returns how two triangles in one plane meet. Each corner of their common part is a corner of a
/// triangle, or a point where two edges cross at inner points of both. If there is a crossing, the
/// common part is a polygon. If the common part is a segment, its only corners are its two ends.
Meeting meeting_in_plane(const Signs& signs, int axis) {
  constexpr int kFirst[] = {0, 3};
  int turns[2][3][3];  // [t][i][k]: side of edge i of triangle t for corner k of triangle 1 - t
  for (int t = 0; t < 2; ++t) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k)
        turns[t][i][k] =
            signs.turn(axis, kFirst[t] + i, kFirst[t] + (i + 1) % 3, kFirst[1 - t] + k);
    }
  }
  Meeting out;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const int end = 3 + (k + 1) % 3;
      if (turns[0][i][k] * turns[0][i][(k + 1) % 3] < 0 &&
          turns[1][k][i] * turns[1][k][(i + 1) % 3] < 0)
        out.places[out.count++] = {i, (i + 1) % 3, {3 + k, end, end}, axis, 1u << i | 8u << k};
    }
  }
  std::array<int, 2> held = {0, 0};
  for (int t = 0; t < 2; ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto [least, most] = std::minmax({turns[t][0][k], turns[t][1][k], turns[t][2][k], 0});
      if (least < 0 && most > 0) continue;
      ++held[t];
      const int corner = kFirst[1 - t] + k;
      unsigned lines = (1u << k | 1u << (k + 2) % 3) << kFirst[1 - t];
      for (int i = 0; i < 3; ++i) lines |= (turns[t][i][k] == 0 ? 1u << i : 0u) << kFirst[t];
      int same = 0;
      while (same < out.count && (out.places[same].from != out.places[same].to ||
                                  signs.corner(out.places[same].from) != signs.corner(corner)))
        ++same;
      if (same == out.count) out.places[out.count++] = {corner, corner};
      out.places[same].lines |= lines;
    }
  }
  out.dimension = std::min(out.count, 3) - 1;
  if (out.count == 1) out.kind = ContactKind::touch_vertex;
  if (out.count > 1)
    out.kind = held[0] == 3 && held[1] == 3 ? ContactKind::equal : ContactKind::coplanar;
  return out;
}

}  // namespace

// Suppose that the planes of the triangles cross in a line L. A triangle does not meet L, or meets
// it in one corner, or in a segment. If it meets L in a segment, one corner is alone on its side of
// the other triangle's plane. The two edges from this corner meet L at the ends of the segment. An
// end may be a corner.
//
// Suppose that both triangles meet L in a segment. Let p1 and p2 be the lone corners, q1 and r1 the
// other corners of a, and q2 and r2 those of b. They are ordered so that p1 is on the positive side
// of (p2, q2, r2), and p2 on that of (p1, q1, r1). L meets the edges p1q1, p1r1, p2q2, p2r2 at u,
// v, s, t. An affine map that keeps orientations turns L into the x axis, the planes into z = 0 and
// y = 0, p1 into (a, y1, 0), and p2 into (b, 0, z2). Let k = y1 z2. q1 lies on the ray from p1
// through u, at u or beyond u. The same holds for the other three edges. So
//   orientation(p1, q1, p2, q2) has the sign of orientation(p1, u, p2, s) = -k (s - u),
//   orientation(p1, r1, r2, p2) has the sign of orientation(p1, v, t, p2) = k (t - v),
//   orientation(p2, s, t, p1) = -k (t - s) > 0 and orientation(p1, u, v, p2) = k (v - u) > 0.
// Let k > 0. (For k < 0 all inequalities are reversed, with the same result.) Then u < v and t < s.
// The segments share more than a point iff u < s and t < v: iff the first two orientations are
// negative. They share exactly one point iff u = s or t = v: iff one of these orientations is 0.
//
// A common segment ends at max(u, t) and at min(v, s). orientation(p1, q1, p2, r2) has the sign of
// -k (t - u). If this is positive, the first end is u, otherwise t. orientation(p1, r1, p2, q2) has
// the sign of -k (s - v). If this is positive, the second end is s, otherwise v.
std::optional<Meeting> meeting_of(const Corners& a, const Corners& b, bool places) {
  const Signs signs(a, b);
  const std::optional<int> axis_a = signs.axis_of(0), axis_b = signs.axis_of(3);
  if (!axis_a || !axis_b) return std::nullopt;
  std::array<std::array<int, 3>, 2> side{};  // per corner of a, then of b: side of the other plane
  for (const int t : {1, 0}) {
    const int plane = t == 1 ? 0 : 3;
    for (int k = 0; k < 3; ++k) side[t][k] = signs.side(plane, plane + 1, plane + 2, 3 - plane + k);
    if (side[t][0] != 0 && side[t][0] == side[t][1] && side[t][1] == side[t][2]) return Meeting{};
  }
  if (side[0] == std::array<int, 3>{}) return meeting_in_plane(signs, *axis_a);
  std::array<std::array<int, 3>, 2> order{};  // the corners, beginning with the lone corner
  for (int t = 0; t < 2; ++t) {
    int alone = -1, on = 0;
    for (int k = 0; k < 3; ++k) {
      if (side[t][k] == 0) {
        on = k;
      } else if (side[t][(k + 1) % 3] != side[t][k] && side[t][(k + 2) % 3] != side[t][k]) {
        alone = k;
      }
    }
    if (alone < 0) {  // the triangle meets the other's plane only in corner `on`
      const int corner = 3 * t + on;
      if (!signs.holds(t == 0 ? 3 : 0, t == 0 ? *axis_b : *axis_a, corner)) return Meeting{};
      return Meeting{ContactKind::touch_vertex, 0, 1, {{{corner, corner}}}};
    }
    order[t] = {alone, (alone + 1) % 3, (alone + 2) % 3};
  }
  // Orders q and r so that each lone corner is on the positive side of the other triangle's plane.
  const bool a_below = side[0][order[0][0]] < 0, b_below = side[1][order[1][0]] < 0;
  if (a_below) std::swap(order[1][1], order[1][2]);
  if (b_below) std::swap(order[0][1], order[0][2]);
  const auto& [p1, q1, r1] = order[0];
  const auto& [p2, q2, r2] = order[1];
  const int first = signs.side(p1, q1, 3 + p2, 3 + q2);
  const int second = signs.side(p1, r1, 3 + r2, 3 + p2);
  if (first > 0 || second > 0) return Meeting{};
  // Returns where the edge of triangle t from its lone corner to corner `to` meets the other plane.
  const auto place = [&](int t, int to) -> Place {
    if (side[t][to] == 0) return {3 * t + to, 3 * t + to};
    return {3 * t + order[t][0], 3 * t + to, {3 - 3 * t, 4 - 3 * t, 5 - 3 * t}};
  };
  // x and y are places of the same point. Prefers a place that is a corner.
  const auto either = [](const Place& x, const Place& y) { return y.from == y.to ? y : x; };
  const Place u = place(0, q1), v = place(0, r1), s = place(1, q2), t = place(1, r2);
  if (first == 0 || second == 0) {
    const Place at = first == 0 ? either(u, s) : either(v, t);
    return Meeting{
        at.from == at.to ? ContactKind::touch_vertex : ContactKind::touch_edge, 0, 1, {at}};
  }
  const bool edge =
      (side[0][q1] == 0 && side[0][r1] == 0) || (side[1][q2] == 0 && side[1][r2] == 0);
  Meeting out{edge ? ContactKind::touch_face : ContactKind::crossing, 1};
  if (!places) return out;
  const int begin = signs.side(p1, q1, 3 + p2, 3 + r2), end = signs.side(p1, r1, 3 + p2, 3 + q2);
  out.places[0] = begin == 0 ? either(u, t) : begin > 0 ? u : t;
  out.places[1] = end == 0 ? either(v, s) : end > 0 ? s : v;
  out.count = 2;
  return out;
}

}  // namespace farcull
