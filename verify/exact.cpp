// The predicates about two triangles by CGAL, and the method `exact` by CGAL's box join. Only this
// and contact.cpp include CGAL, which compiles slowly.
//
// Epick decides exactly here, for these reasons, read from the headers of CGAL 5.5.1 (the tests
// compare it with integer arithmetic):
// - do_intersect of triangle/triangle (the coplanar case too) and triangle/segment asks only
//   orientation_3 and coplanar_orientation_3 about input points (Guigue, Devillers: Fast and robust
//   triangle-triangle overlap test using orientation predicates, 2003). Both have preconditions on
//   degeneracy, hence the sorting into shapes first.
// - Each other do_intersect (segment/segment constructs supporting lines) is one
//   Filtered_predicate. It runs the whole function, with its constructions, over intervals and, if
//   that leaves a doubt, over rationals. Nothing is rounded in between.
// - Overflow: static filters do not decide if a difference of coordinates exceeds 1e102 (1e153 for
//   collinearity) or if products could underflow. Intervals round outward to infinity, and
//   0 * infinity widens them.
// CGAL's intersection() is never called: with inexact constructions it misses intersections (CGAL
// issue 6384).
#include "verify/exact.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <variant>

#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/scene/scene.h"
#include "verify/within.h"

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Hull = std::variant<Point, Kernel::Segment_3, Kernel::Triangle_3>;  // in the order of Shape

Point point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

Hull hull(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  switch (shape(corners)) {
    case Shape::triangle:
      return Kernel::Triangle_3(point(a), point(b), point(c));
    case Shape::segment: {
      // Collinear points are in lexicographic order along their line, so the extremes are the ends.
      const auto [lo, hi] = std::minmax({a, b, c}, lexicographically_less);
      return Kernel::Segment_3(point(lo), point(hi));
    }
    case Shape::point:
      break;
  }
  return point(a);
}

using Corners = std::array<Vec3, 3>;

bool hulls_meet(const Hull& p, const Hull& q) {
  return std::visit([](const auto& x, const auto& y) { return CGAL::do_intersect(x, y); }, p, q);
}

Hull hull(const Vec3& p, const Vec3& q) {
  if (p == q) return point(p);
  return Kernel::Segment_3(point(p), point(q));
}

/// Divides a degenerate triangle into the segments from a corner to the other two corners. A
/// triangle that is not degenerate is its own only part.
std::vector<Corners> parts_at(const Corners& t, int corner) {
  if (shape(t) == Shape::triangle) return {t};
  const Vec3& v = t[corner];
  return {{v, v, t[(corner + 1) % 3]}, {v, v, t[(corner + 2) % 3]}};
}

/// The rim of such a part: where a ray from the corner v leaves the part.
Hull rim_at(const Corners& part, const Vec3& v) {
  std::array<Vec3, 2> others;
  int count = 0;
  for (const Vec3& p : part) {
    if (p != v) others.at(count++) = p;
  }
  if (count == 0) return point(v);
  return hull(others[0], others[count - 1]);
}

/// Decides about neighbours with one shared position v. Both triangles are unions of parts that are
/// convex, contain v and do not have v on their rims, unless a part is v itself. If two parts have
/// a common point other than v, the point can be moved away from v until it leaves one of them.
/// There it is on the rim of that part, so a rim meets the other part.
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
/// may lie anywhere (also at p or q).
bool meet_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const bool flat_a = CGAL::collinear(point(p), point(q), point(r));
  const bool flat_b = CGAL::collinear(point(p), point(q), point(s));
  if (flat_a != flat_b) return false;  // a proper triangle meets the line of p and q in its edge
  if (!flat_a) {
    return CGAL::coplanar(point(p), point(q), point(r), point(s)) &&
           CGAL::coplanar_orientation(point(p), point(q), point(r), point(s)) == CGAL::POSITIVE;
  }
  // Both are segments on the line of p and q. Do they reach beyond the same end of the edge?
  const auto ends = std::minmax(p, q, lexicographically_less);
  const auto below = [&](const Vec3& x) { return lexicographically_less(x, ends.first); };
  const auto above = [&](const Vec3& x) { return lexicographically_less(ends.second, x); };
  return (below(r) && below(s)) || (above(r) && above(s));
}

/// A box as box_intersection_d wants it.
struct JoinBox {
  using NT = double;
  using ID = std::uint32_t;
  Box box;
  std::uint32_t triangle;
  std::uint32_t owner;

  static int dimension() { return 3; }
  double min_coord(int axis) const { return box.lo[axis]; }
  double max_coord(int axis) const { return box.hi[axis]; }
  ID id() const { return triangle; }
};

// Below this number of boxes, CGAL's join scans.
constexpr std::ptrdiff_t kCutoff = 2000;

/// Calls visit(const JoinBox*, const JoinBox*) once for each two boxes that overlap and whose
/// triangles make a pair that counts.
template <typename Visit>
void join(const Scene& scene, std::vector<JoinBox>& boxes, Visit visit) {
  std::vector<const JoinBox*> all(boxes.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) all[t] = &boxes[t];
  std::size_t with_triangles = 0;
  bool self = false;
  for (const Object& object : scene.objects) {
    with_triangles += object.triangle_count > 0;
    self = self || (object.self && object.triangle_count > 1);
  }
  if (with_triangles < 2 && !self) return;
  if (with_triangles == 2 && !self) {
    // Objects are contiguous: the second one starts where the owner changes.
    const auto second = std::find_if(
        all.begin(), all.end(), [&](const JoinBox* b) { return b->owner != boxes.front().owner; });
    CGAL::box_intersection_d(all.begin(), second, second, all.end(), visit, kCutoff,
                             CGAL::Box_intersection_d::CLOSED, CGAL::Box_intersection_d::BIPARTITE);
    return;
  }
  CGAL::box_self_intersection_d(
      all.begin(), all.end(),
      [&](const JoinBox* a, const JoinBox* b) {
        if (a->owner != b->owner || scene.objects[a->owner].self) visit(a, b);
      },
      kCutoff, CGAL::Box_intersection_d::CLOSED);
}

/// Grows a box so that two grown boxes overlap if along no axis the gap of the original boxes,
/// computed in double, exceeds the clearance D. half is at least D/2 + ulp(D)/2. So if grown boxes
/// are disjoint, the original boxes are apart by more than 2 half >= D + ulp(D), which rounding
/// cannot bring down to D. Coordinates that leave the range of double are set to its ends; no
/// coordinate lies beyond them.
Box grown(Box box, double half) {
  constexpr double kMax = std::numeric_limits<double>::max();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::max(std::nextafter(box.lo[k] - half, -kInf), -kMax);
    box.hi[k] = std::min(std::nextafter(box.hi[k] + half, kInf), kMax);
  }
  return box;
}

/// Rounding is monotone: if a rounded difference is above the clearance, so is the exact one.
bool farther_along_an_axis(const Box& a, const Box& b, double clearance) {
  for (int k = 0; k < 3; ++k) {
    if (b.lo[k] - a.hi[k] > clearance || a.lo[k] - b.hi[k] > clearance) return true;
  }
  return false;
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
  return clearance > 0 && disjoint_within(a, b, clearance);
}

bool intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return is_within(a, b, 0);
}

bool within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  require_clearance("within", clearance);
  return is_within(a, b, clearance);
}

bool share_position(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  for (const Vec3& p : a) {
    for (const Vec3& q : b) {
      if (p == q) return true;
    }
  }
  return false;
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
  switch (count) {
    case 0:
      return intersects(a, b);
    case 1:
      return meet_beyond_vertex(a, in_a[0], b, in_b[0]);
    case 2:
      return meet_beyond_edge(a[in_a[0]], a[in_a[1]], a[3 - in_a[0] - in_a[1]],
                              b[3 - in_b[0] - in_b[1]]);
    default:
      return shape(a) == Shape::triangle;
  }
}

std::uint64_t degenerate_triangles(const Scene& scene) {
  const FloatingPointGuard guard;
  std::uint64_t count = 0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (shape(scene.corners(t)) != Shape::triangle) ++count;
  }
  return count;
}

ExactResult all_colliding_pairs(const Scene& scene, const ExactQuestion& question,
                                std::span<const ObjectPair> ignored) {
  const FloatingPointGuard guard;
  require_clearance("all_colliding_pairs", question.clearance);
  constexpr std::size_t kChunk =
      1 << 18;  // pairs decided at a time: tens of millions of candidates are never stored
  ExactResult result;
  std::vector<TrianglePair> chunk;
  const IgnoredObjects is_ignored(scene, ignored);
  const auto decide_chunk = [&] {
    const Stopwatch start;
    result.append(decide(scene, chunk, question));
    result.box_pairs += chunk.size();
    chunk.clear();
    result.predicates_ms += start.ms();
  };
  const Stopwatch start;
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<std::uint32_t> owner = owners(scene);
  const double half = std::nextafter(question.clearance / 2, std::numeric_limits<double>::max());
  std::vector<JoinBox> join_boxes(boxes.size());
  for (std::uint32_t t = 0; t < boxes.size(); ++t) {
    join_boxes[t] = {question.clearance > 0 ? grown(boxes[t], half) : boxes[t], t, owner[t]};
  }
  join(scene, join_boxes, [&](const JoinBox* a, const JoinBox* b) {
    if (question.clearance > 0 &&
        farther_along_an_axis(boxes[a->triangle], boxes[b->triangle], question.clearance)) {
      return;
    }
    const TrianglePair pair = {std::min(a->triangle, b->triangle),
                               std::max(a->triangle, b->triangle)};
    if (is_ignored(pair)) {
      ++result.ignored;
      return;
    }
    chunk.push_back(pair);
    if (chunk.size() == kChunk) decide_chunk();
  });
  decide_chunk();
  result.join_ms = start.ms() - result.predicates_ms;
  std::sort(result.pairs.begin(), result.pairs.end());
  std::sort(result.neighbour_pairs.begin(), result.neighbour_pairs.end());
  return result;
}

}  // namespace farcull
