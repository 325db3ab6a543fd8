// Implements the predicates about two triangles with CGAL. Only this file and contact_meeting.cpp
// include CGAL, which compiles slowly. Both include only CGAL's kernel, which is under the LGPL.
//
// CGAL's kernel Epick decides exactly here. The reasons below were read from the headers of CGAL
// 5.5.1. The tests compare Epick with integer arithmetic.
// - do_intersect of triangle/triangle (the coplanar case too) and triangle/segment calls only
//   orientation_3 and coplanar_orientation_3 of input points (Guigue, Devillers: Fast and robust
//   triangle-triangle overlap test using orientation predicates, 2003). These two overloads require
//   that triangles are not degenerate, so shape() classifies triangles first.
// - Each other do_intersect (segment/segment constructs supporting lines) is one
//   Filtered_predicate. It runs the whole function, with its constructions, over intervals. If the
//   intervals leave a doubt, it runs the function over rationals. Nothing is rounded in between.
// - Overflow: static filters do not decide if a difference of coordinates exceeds 1e102 (1e153 for
//   collinearity) or if products could underflow. Then intervals decide. They are rounded outward,
//   to infinity if necessary; a product 0 * infinity only widens an interval.
// CGAL's intersection() is never called: with inexact constructions it misses intersections (CGAL
// issue 6384).
#include "verify/exact.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <tuple>
#include <variant>

#include "core/base/floating_point.h"
#include "verify/closest.h"
#include "verify/within.h"

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<Vec3, 3>;
using Hull = std::variant<Point, Kernel::Segment_3, Kernel::Triangle_3>;  // in the order of Shape

Point point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

Hull hull(const Corners& corners) {
  const auto& [a, b, c] = corners;
  const Shape of = shape(corners);
  if (of == Shape::triangle) return Kernel::Triangle_3(point(a), point(b), point(c));
  if (of == Shape::point) return point(a);
  // Collinear points are in lexicographic order along their line, so the extremes are the ends.
  const auto [lo, hi] = std::minmax({a, b, c}, lexicographically_less);
  return Kernel::Segment_3(point(lo), point(hi));
}

bool hulls_meet(const Hull& p, const Hull& q) {
  return std::visit([](const auto& x, const auto& y) { return CGAL::do_intersect(x, y); }, p, q);
}

/// Divides a degenerate triangle into the segments from a corner to the other two corners. A
/// triangle that is not degenerate is returned as its only part.
std::vector<Corners> parts_at(const Corners& t, int corner) {
  if (shape(t) == Shape::triangle) return {t};
  const Vec3& v = t[corner];
  return {{v, v, t[(corner + 1) % 3]}, {v, v, t[(corner + 2) % 3]}};
}

/// Returns the rim of a part from parts_at(): the points where rays from the corner v leave the
/// part.
Hull rim_at(const Corners& part, const Vec3& v) {
  std::array<Vec3, 2> others;
  int count = 0;
  for (const Vec3& p : part) {
    if (p != v) others.at(count++) = p;
  }
  if (count == 0) return point(v);
  if (count == 1 || others[0] == others[1]) return point(others[0]);
  return Kernel::Segment_3(point(others[0]), point(others[1]));
}

/// Decides about neighbours with one shared position v. Both triangles are unions of convex parts
/// that contain v. The rim of a part does not contain v, unless the part is v itself. If two parts
/// share a point other than v, the ray from v through this point leaves one part, at its rim, while
/// still in the other part. So a rim meets the other part.
bool meet_beyond_vertex(const Corners& a, int i, const Corners& b, int j) {
  const Vec3& v = a[i];
  for (const Corners& s : parts_at(a, i)) {
    for (const Corners& t : parts_at(b, j)) {
      const Hull p = hull(s);
      const Hull q = hull(t);
      if (std::holds_alternative<Point>(p) || std::holds_alternative<Point>(q)) continue;
      if (hulls_meet(rim_at(s, v), q) || hulls_meet(rim_at(t, v), p)) return true;
    }
  }
  return false;
}

/// Decides about neighbours that share the edge from p to q. r and s are their third corners, which
/// may lie anywhere, even at p or q.
bool meet_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const bool flat_a = CGAL::collinear(point(p), point(q), point(r));
  const bool flat_b = CGAL::collinear(point(p), point(q), point(s));
  if (flat_a != flat_b) return false;  // one triangle meets the line of p and q only in the edge
  if (!flat_a) {
    return CGAL::coplanar(point(p), point(q), point(r), point(s)) &&
           CGAL::coplanar_orientation(point(p), point(q), point(r), point(s)) == CGAL::POSITIVE;
  }
  // Both triangles are segments on the line of p and q. They share more than the edge iff both
  // extend beyond the same end of the edge.
  const auto ends = std::minmax(p, q, lexicographically_less);
  const auto below = [&](const Vec3& x) { return lexicographically_less(x, ends.first); };
  const auto above = [&](const Vec3& x) { return lexicographically_less(ends.second, x); };
  return (below(r) && below(s)) || (above(r) && above(s));
}

}  // namespace

Shape shape(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  if (a == b && b == c) return Shape::point;
  return CGAL::collinear(point(a), point(b), point(c)) ? Shape::segment : Shape::triangle;
}

bool within_unfiltered(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                       double clearance) {
  if (hulls_meet(hull(a), hull(b))) return true;
  return clearance > 0 && squared_distance(a, b) <= SquaredDistance::of(clearance);
}

bool intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return is_within(a, b, 0);
}

bool within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  require_clearance("within", clearance);
  return is_within(a, b, clearance);
}

bool share_position(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

bool intersects_beyond_shared(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  // The shared positions, each once, as corners of a and of b.
  std::array<int, 3> in_a{};
  std::array<int, 3> in_b{};
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::find(a.begin(), a.begin() + i, a[i]) != a.begin() + i) continue;
    const auto at = std::find(b.begin(), b.end(), a[i]);
    if (at == b.end()) continue;
    in_a[count] = i;
    in_b[count++] = static_cast<int>(at - b.begin());
  }
  if (count == 0) return intersects(a, b);
  if (count == 1) return meet_beyond_vertex(a, in_a[0], b, in_b[0]);
  if (count == 3) return shape(a) == Shape::triangle;
  return meet_beyond_edge(a[in_a[0]], a[in_a[1]], a[3 - in_a[0] - in_a[1]],
                          b[3 - in_b[0] - in_b[1]]);
}

std::uint64_t degenerate_triangles(const Scene& scene) {
  const FloatingPointGuard guard;
  std::uint64_t count = 0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (shape(scene.corners(t)) != Shape::triangle) ++count;
  }
  return count;
}

}  // namespace farcull
