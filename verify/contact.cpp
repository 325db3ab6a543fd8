// The test of Guigue, Devillers: Fast and robust triangle-triangle overlap test using orientation
// predicates (2003), but with strict signs, so that it tests relative interiors and not closed
// triangles. CGAL is used only for signs of determinants of input points, which Epick decides
// exactly (verify/exact.cpp says why). No point is constructed.
#include "verify/contact.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Points = std::array<Point, 3>;

Points points(const Corners& t) {
  const auto point = [](const Vec3& p) { return Point(p.x(), p.y(), p.z()); };
  return {point(t[0]), point(t[1]), point(t[2])};
}

/// Sign of det(q - p, r - p, s - p).
int orientation(const Point& p, const Point& q, const Point& r, const Point& s) {
  return CGAL::orientation(p, q, r, s);
}

using Sides = std::array<int, 3>;

/// The sides of the plane of `plane` on which the corners of t lie; all 0 if `plane` is degenerate.
Sides sides(const Points& plane, const Points& t) {
  const auto& [a, b, c] = plane;
  return {orientation(a, b, c, t[0]), orientation(a, b, c, t[1]), orientation(a, b, c, t[2])};
}

/// True iff corners are strictly on both sides: the relative interior meets the plane and does not
/// lie in it.
bool crosses(const Sides& s) {
  return std::min({s[0], s[1], s[2]}) < 0 && std::max({s[0], s[1], s[2]}) > 0;
}

/// A corner that is alone strictly on its side of the plane. Of the other two corners at most one
/// is on the plane, the rest on the other side. Precondition: crosses(s).
int lone(const Sides& s) {
  for (int i = 0; i < 3; ++i) {
    if (s[i] != 0 && s[(i + 1) % 3] != s[i] && s[(i + 2) % 3] != s[i]) return i;
  }
  throw std::logic_error("penetrate: no corner is alone on its side of a plane that is crossed");
}

/// Decides whether the relative interiors of two triangles meet, each of which crosses the plane of
/// the other. Let p1 and p2 be lone corners and q and r the other corners, ordered so that p1 lies
/// on the positive side of (p2, q2, r2) and p2 on that of (p1, q1, r1). The common line L of the
/// planes meets the edges p1q1, p1r1, p2q2, p2r2 at u, v, s, t, and the relative interiors in the
/// open segments uv and st, which are not empty. Take L as the x axis and the planes as z = 0 and
/// y = 0 (affine maps that keep orientations), p1 = (a, y1, 0), p2 = (b, 0, z2), k = y1 z2. Since
/// q1 lies on the ray from p1 through u, at or behind u, and likewise for the other edges:
///   orientation(p1, q1, p2, q2) has the sign of orientation(p1, u, p2, s) = -k (s - u),
///   orientation(p1, r1, r2, p2) has that of orientation(p1, v, t, p2) = k (t - v),
///   orientation(p2, s, t, p1) = -k (t - s) > 0 and orientation(p1, u, v, p2) = k (v - u) > 0.
/// For k > 0: u < v and t < s, so the open segments meet iff u < s and t < v: iff the first two
/// orientations are negative. For k < 0 all four inequalities are reversed, with the same result.
bool interiors_meet(const Points& a, int i, bool a_positive, const Points& b, int j,
                    bool b_positive) {
  const Point& p1 = a[i];
  const Point& p2 = b[j];
  const Point* q1 = &a[(i + 1) % 3];
  const Point* r1 = &a[(i + 2) % 3];
  const Point* q2 = &b[(j + 1) % 3];
  const Point* r2 = &b[(j + 2) % 3];
  if (!a_positive) std::swap(q2, r2);
  if (!b_positive) std::swap(q1, r1);
  return orientation(p1, *q1, p2, *q2) < 0 && orientation(p1, *r1, *r2, p2) < 0;
}

/// The ends of a degenerate triangle that is a segment: its lexicographically first and last
/// corner.
std::pair<int, int> ends(const Corners& t) {
  const auto less = [](const Vec3& p, const Vec3& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  const auto [first, last] = std::minmax_element(t.begin(), t.end(), less);
  return {static_cast<int>(first - t.begin()), static_cast<int>(last - t.begin())};
}

/// True iff the open segment pq meets the triangle's interior: iff the line pq passes all three
/// edges on one side. Precondition: p and q are strictly on different sides of the triangle's
/// plane.
bool pierces(const Points& triangle, const Point& p, const Point& q) {
  const auto& [a, b, c] = triangle;
  const int side = orientation(p, q, a, b);
  return side != 0 && orientation(p, q, b, c) == side && orientation(p, q, c, a) == side;
}

}  // namespace

bool penetrate(const Corners& a, const Corners& b) {
  const Points p = points(a);
  const Points q = points(b);
  const Sides of_b = sides(p, q);
  const bool b_crosses = crosses(of_b);
  const Sides of_a = sides(q, p);
  const bool a_crosses = crosses(of_a);
  bool meet = false;
  if (a_crosses && b_crosses) {
    const int i = lone(of_a);
    const int j = lone(of_b);
    meet = interiors_meet(p, i, of_a[i] > 0, q, j, of_b[j] > 0);
  } else if (b_crosses && of_a == Sides{}) {
    // All of a in the plane of b, but not all of b in that of a: b has no plane, it is a segment.
    const auto [first, last] = ends(b);
    meet = pierces(p, q[first], q[last]);
  } else if (a_crosses && of_b == Sides{}) {
    const auto [first, last] = ends(a);
    meet = pierces(q, p[first], p[last]);
  }
  return meet;
}

ContactCounts count_contacts(const Scene& scene, std::span<const TrianglePair> pairs,
                             unsigned threads) {
  for (const TrianglePair& pair : pairs) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size()) {
      throw std::logic_error("count_contacts: a pair names a triangle that the scene lacks");
    }
    if (pair.a == pair.b) throw std::logic_error("count_contacts: a pair of one triangle");
  }
  constexpr std::size_t kLeast = 1024;  // pairs per thread, enough to pay for it
  const std::size_t chunks = chunks_for(pairs.size(), kLeast, std::max(threads, 1u));
  std::vector<std::uint64_t> penetrating(chunks, 0);
  for_chunks(pairs.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::uint64_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      count += penetrate(scene.corners(pairs[i].a), scene.corners(pairs[i].b));
    }
    penetrating[chunk] = count;
  });
  ContactCounts counts;
  for (const std::uint64_t count : penetrating) counts.penetrating += count;
  counts.touching = pairs.size() - counts.penetrating;
  return counts;
}

}  // namespace farcull
