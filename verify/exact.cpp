// Only this and contact.cpp include CGAL, which compiles slowly.
//
// Why Epick decides exactly here, read from the headers of CGAL 5.5.1 (the tests hold it against
// integer arithmetic):
// - do_intersect of triangle/triangle (the coplanar case too) and triangle/segment asks only
//   orientation_3 and coplanar_orientation_3 about input points (Guigue, Devillers: Fast and robust
//   triangle-triangle overlap test using orientation predicates, 2003). Both have preconditions on
//   degeneracy, hence the sorting into shapes first.
// - The others (segment/segment constructs supporting lines) are one Filtered_predicate each: it
//   runs the whole function, constructions and all, over intervals and, where that leaves a doubt,
//   over rationals. Nothing is rounded in between.
// - Overflow: static filters stand aside where a difference of coordinates exceeds 1e102 (1e153 for
//   collinearity) and where products could underflow; intervals round outward to infinity, and
//   0 * infinity widens. CGAL's intersection() is never called: with inexact constructions it
//   misses intersections (CGAL issue 6384).
#include "verify/exact.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <variant>

#include "core/floating_point.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "verify/answers.h"
#include "verify/distance.h"
#include "verify/filter.h"

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
      // Along a line, order by coordinates is order by position: the extremes are the ends.
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

/// The parts that a degenerate triangle is made of at a corner: the segments from it to the others.
/// A triangle that is none is its own only part.
std::vector<Corners> parts_at(const Corners& t, int corner) {
  if (shape(t) == Shape::triangle) return {t};
  const Vec3& v = t[corner];
  return {{v, v, t[(corner + 1) % 3]}, {v, v, t[(corner + 2) % 3]}};
}

/// The rim of such a part: what a ray from the corner leaves it by.
Hull rim_at(const Corners& part, const Vec3& v) {
  std::array<Vec3, 2> others;
  int count = 0;
  for (const Vec3& p : part) {
    if (p != v) others.at(count++) = p;
  }
  if (count == 0) return point(v);
  return hull(others[0], others[count - 1]);
}

/// Neighbours with one shared position v. Both are unions of parts that are convex, contain v and
/// do not have v on their rims, unless a part is v itself. A common point of two parts beyond v can
/// be moved away from v until it leaves one of them, which is at a rim.
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

/// Neighbours that share the edge from p to q; r and s are the other corners of theirs, anywhere
/// (also at p or q).
bool meet_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const bool flat_a = CGAL::collinear(point(p), point(q), point(r));
  const bool flat_b = CGAL::collinear(point(p), point(q), point(s));
  if (flat_a != flat_b) return false;  // the one that is no segment meets the line in its edge
  if (!flat_a) {
    return CGAL::coplanar(point(p), point(q), point(r), point(s)) &&
           CGAL::coplanar_orientation(point(p), point(q), point(r), point(s)) == CGAL::POSITIVE;
  }
  // Segments on one line, ordered as their coordinates are: beyond the same end?
  const auto [lo, hi] = std::minmax(p, q, lexicographically_less);
  const auto below = [&](const Vec3& x) { return lexicographically_less(x, lo); };
  const auto above = [&](const Vec3& x) { return lexicographically_less(hi, x); };
  return (below(r) && below(s)) || (above(r) && above(s));
}

/// What box_intersection_d asks of a box.
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

constexpr std::ptrdiff_t kCutoff =
    2000;  // below it the join scans; the value that issues and reports quote

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

/// Grown boxes overlap wherever the difference of two coordinates, in double, does not exceed the
/// clearance D. half is at least D/2 + ulp(D)/2, so that boxes which are disjoint when grown are
/// apart by more than 2 half >= D + ulp(D), which no rounding takes back to D. What leaves the
/// range of double stops at its ends, beyond which there is nothing to lose.
Box grown(Box box, double half) {
  constexpr double kMax = std::numeric_limits<double>::max();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::max(std::nextafter(box.lo[k] - half, -kInf), -kMax);
    box.hi[k] = std::min(std::nextafter(box.hi[k] + half, kInf), kMax);
  }
  return box;
}

/// Differences round monotonously, so that one above the clearance proves the same of the exact
/// one.
bool farther_along_an_axis(const Box& a, const Box& b, double clearance) {
  for (int k = 0; k < 3; ++k) {
    if (b.lo[k] - a.hi[k] > clearance || a.lo[k] - b.hi[k] > clearance) return true;
  }
  return false;
}

void check_clearance(const char* where, double clearance) {
  if (!(clearance >= 0 && std::isfinite(clearance))) {
    throw std::logic_error(std::string(where) + ": a clearance must be finite and not negative");
  }
}

bool is_within(const Corners& a, const Corners& b, double clearance) {
  Triage triage = filter_planes(a, b, clearance);
  if (triage == Triage::unknown && clearance > 0) triage = filter_within(a, b, clearance);
  if (triage != Triage::unknown) return triage == Triage::yes;
  if (hulls_meet(hull(a), hull(b))) return true;
  return clearance > 0 && disjoint_within(a, b, clearance);
}

/// Which corners of two triangles are at equal positions: bit 3 i + j for corner i of a and j of b.
/// Equal indices are known to be, without a look at the positions.
unsigned equal_corners(const std::array<std::uint32_t, 3>& a_index, const Corners& a,
                       const std::array<std::uint32_t, 3>& b_index, const Corners& b) {
  unsigned equal = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (a_index[i] == b_index[j] ||
          (a[i].x() == b[j].x() && a[i].y() == b[j].y() && a[i].z() == b[j].z())) {
        equal |= 1u << (3 * i + j);
      }
    }
  }
  return equal;
}

/// Neighbours decided without exact arithmetic, where that can be.
Triage filter_neighbours(unsigned equal, const Corners& a, const Corners& b) {
  const auto lowest = [](unsigned bits) { return std::countr_zero(bits); };
  const int i = lowest(equal) / 3;
  const int j = lowest(equal) % 3;
  const unsigned rest = equal & (equal - 1);
  if (rest == 0) {
    return filter_beyond_vertex(a[i], a[(i + 1) % 3], a[(i + 2) % 3], b[(j + 1) % 3],
                                b[(j + 2) % 3]);
  }
  const int k = lowest(rest) / 3;
  const int l = lowest(rest) % 3;
  // Else more than an edge is shared, or a corner stands twice in a triangle.
  if ((rest & (rest - 1)) != 0 || i == k || j == l) return Triage::unknown;
  return filter_beyond_edge(a[i], a[k], a[3 - i - k], b[3 - j - l]);
}

// Pairs whose second corners are fetched ahead; the first ones are mostly those of the pair before.
constexpr std::size_t kAhead = 8;

/// A triangle with its corners at hand.
struct Gathered {
  std::uint32_t triangle;
  Corners corners;

  Gathered(const Scene& scene, std::uint32_t t) { gather(scene, t); }
  void gather(const Scene& scene, std::uint32_t t) {
    triangle = t;
    const auto& [i, j, k] = scene.triangles[t];
    corners = {scene.vertices[i], scene.vertices[j], scene.vertices[k]};
  }
};

PairAnswer answer(const Scene& scene, const Gathered& a, const Gathered& b, bool one_object,
                  const ExactQuestion& question) {
  if (one_object) {
    const unsigned equal = equal_corners(scene.triangles[a.triangle], a.corners,
                                         scene.triangles[b.triangle], b.corners);
    if (equal != 0) {
      if (!question.neighbours) return PairAnswer::neighbours_unasked;
      const Triage triage = filter_neighbours(equal, a.corners, b.corners);
      const bool beyond = triage == Triage::unknown ? intersects_beyond_shared(a.corners, b.corners)
                                                    : triage == Triage::yes;
      return beyond ? PairAnswer::neighbours_colliding : PairAnswer::neighbours_apart;
    }
  }
  return is_within(a.corners, b.corners, question.clearance) ? PairAnswer::colliding
                                                             : PairAnswer::apart;
}

/// Which object triangles are of, for pairs whose first members mostly ascend.
class SameObject {
 public:
  explicit SameObject(const Scene& scene) : objects_(scene.objects) {}

  bool operator()(const TrianglePair& pair) {
    if (pair.a < first_ || pair.a >= end_) {
      const auto after = std::upper_bound(
          objects_.begin(), objects_.end(), pair.a,
          [](std::uint32_t t, const Object& object) { return t < object.first_triangle; });
      // The last one that starts at or before a; empty ones that start there come earlier.
      first_ = std::prev(after)->first_triangle;
      end_ = std::uint64_t{first_} + std::prev(after)->triangle_count;
    }
    return pair.b >= first_ && pair.b < end_;
  }

 private:
  const std::vector<Object>& objects_;
  std::uint32_t first_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace

Shape shape(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  if (a == b && b == c) return Shape::point;
  return CGAL::collinear(point(a), point(b), point(c)) ? Shape::segment : Shape::triangle;
}

bool intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return is_within(a, b, 0);
}

bool within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  check_clearance("within", clearance);
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

Collisions decide(const Scene& scene, std::span<const TrianglePair> candidates,
                  const ExactQuestion& question) {
  const FloatingPointGuard guard;
  check_clearance("decide", question.clearance);
  for (const TrianglePair& pair : candidates) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size()) {
      throw std::logic_error("decide: a candidate names a triangle that the scene lacks");
    }
    if (pair.a == pair.b) throw std::logic_error("decide: a candidate of one triangle");
  }
  constexpr std::size_t kBlock =
      1024;  // enough work to pay for the shared counter, small enough to balance
  std::vector<PairAnswer> answers(candidates.size(), PairAnswer::undecided);
  std::atomic<std::size_t> next = 0;
  const auto work = [&](std::size_t, std::size_t, std::size_t) {
    SameObject same_object(scene);
    for (;;) {
      const std::size_t begin = next.fetch_add(kBlock);
      if (begin >= candidates.size()) return;
      const std::size_t end = std::min(begin + kBlock, candidates.size());
      Gathered a(scene, candidates[begin].a);
      Gathered b(scene, candidates[begin].b);
      for (std::size_t i = begin; i < end; ++i) {
        const TrianglePair& pair = candidates[i];
        prefetch(scene, candidates[std::min(i + kAhead, end - 1)].b);
        if (pair.a != a.triangle) a.gather(scene, pair.a);  // mostly as before, in sorted lists
        b.gather(scene, pair.b);
        answers[i] = answer(scene, a, b, same_object(pair), question);
      }
    }
  };
  const std::size_t blocks = (candidates.size() + kBlock - 1) / kBlock;
  const std::size_t threads =
      std::clamp<std::size_t>(question.threads, 1, std::max<std::size_t>(blocks, 1));
  for_chunks(threads, threads, work);

  return count_answers(candidates, answers);
}

ExactResult all_colliding_pairs(const Scene& scene, const ExactQuestion& question) {
  const FloatingPointGuard guard;
  check_clearance("all_colliding_pairs", question.clearance);
  constexpr std::size_t kChunk =
      1 << 18;  // pairs decided at a time: tens of millions of candidates are never stored
  ExactResult result;
  std::vector<TrianglePair> chunk;
  const auto decide_chunk = [&] {
    const Stopwatch start;
    const Collisions found = decide(scene, chunk, question);
    const auto append = [](std::vector<TrianglePair>& to, const std::vector<TrianglePair>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(result.pairs, found.pairs);
    append(result.neighbour_pairs, found.neighbour_pairs);
    result.neighbours += found.neighbours;
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
    chunk.push_back({std::min(a->triangle, b->triangle), std::max(a->triangle, b->triangle)});
    if (chunk.size() == kChunk) decide_chunk();
  });
  decide_chunk();
  result.join_ms = start.ms() - result.predicates_ms;
  std::sort(result.pairs.begin(), result.pairs.end());
  std::sort(result.neighbour_pairs.begin(), result.neighbour_pairs.end());
  return result;
}

}  // namespace farcull
