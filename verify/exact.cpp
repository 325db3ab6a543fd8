// The only translation unit that includes CGAL, which compiles slowly.
//
// Why Epick decides exactly here, read from the headers of CGAL 5.5.1 (the tests hold it against
// integer arithmetic):
// - do_intersect of triangle/triangle (the coplanar case too) and triangle/segment asks only
// orientation_3 and
//   coplanar_orientation_3 about input points (Guigue, Devillers: Fast and robust triangle-triangle
//   overlap test using orientation predicates, 2003). Both have preconditions on degeneracy, hence
//   the sorting into shapes first.
// - The others (segment/segment constructs supporting lines) are one Filtered_predicate each: it
// runs the whole function,
//   constructions and all, over intervals and, where that leaves a doubt, over rationals. Nothing
//   is rounded in between.
// - Overflow: static filters stand aside where a difference of coordinates exceeds 1e102 (1e153 for
// collinearity) and where
//   products could underflow; intervals round outward to infinity, and 0 * infinity widens. CGAL's
//   intersection() is never called: with inexact constructions it misses intersections (CGAL issue
//   6384).
#include "verify/exact.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <tuple>
#include <variant>

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Hull = std::variant<Point, Kernel::Segment_3, Kernel::Triangle_3>;  // in the order of Shape

using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

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

/// Calls visit(const JoinBox*, const JoinBox*) once for each two boxes of different owners that
/// overlap.
template <typename Visit>
void join(const Scene& scene, Visit visit) {
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<JoinBox> join_boxes(boxes.size());
  for (std::uint32_t t = 0; t < boxes.size(); ++t) join_boxes[t] = {boxes[t], t, owner[t]};
  std::vector<const JoinBox*> all(boxes.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) all[t] = &join_boxes[t];

  const auto with_triangles = std::count_if(scene.objects.begin(), scene.objects.end(),
                                            [](const Object& o) { return o.triangle_count > 0; });
  if (with_triangles < 2) return;
  if (with_triangles == 2) {
    // Objects are contiguous: the second one starts where the owner changes.
    const auto second = std::find_if(all.begin(), all.end(), [&](const JoinBox* b) {
      return b->owner != join_boxes.front().owner;
    });
    CGAL::box_intersection_d(all.begin(), second, second, all.end(), visit, kCutoff,
                             CGAL::Box_intersection_d::CLOSED, CGAL::Box_intersection_d::BIPARTITE);
    return;
  }
  CGAL::box_self_intersection_d(
      all.begin(), all.end(),
      [&visit](const JoinBox* a, const JoinBox* b) {
        if (a->owner != b->owner) visit(a, b);
      },
      kCutoff, CGAL::Box_intersection_d::CLOSED);
}

}  // namespace

Shape shape(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  if (a == b && b == c) return Shape::point;
  return CGAL::collinear(point(a), point(b), point(c)) ? Shape::segment : Shape::triangle;
}

bool intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return std::visit([](const auto& p, const auto& q) { return CGAL::do_intersect(p, q); }, hull(a),
                    hull(b));
}

std::uint64_t degenerate_triangles(const Scene& scene) {
  std::uint64_t count = 0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (shape(scene.corners(t)) != Shape::triangle) ++count;
  }
  return count;
}

std::vector<TrianglePair> colliding_pairs(const Scene& scene,
                                          std::span<const TrianglePair> candidates,
                                          unsigned threads) {
  for (const TrianglePair& pair : candidates) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size()) {
      throw std::logic_error("colliding_pairs: a candidate names a triangle that the scene lacks");
    }
  }
  constexpr std::size_t kBlock =
      1024;  // enough work to pay for the shared counter, small enough to balance
  std::vector<std::uint8_t> collides(candidates.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (;;) {
      const std::size_t begin = next.fetch_add(kBlock);
      if (begin >= candidates.size()) return;
      const std::size_t end = std::min(begin + kBlock, candidates.size());
      for (std::size_t i = begin; i < end; ++i) {
        collides[i] = intersects(scene.corners(candidates[i].a), scene.corners(candidates[i].b));
      }
    }
  };
  const std::size_t blocks = (candidates.size() + kBlock - 1) / kBlock;
  std::vector<std::future<void>> helpers;  // futures, so that what a thread throws is thrown here
  for (std::size_t i = 1; i < std::min<std::size_t>(threads, blocks); ++i) {
    helpers.push_back(std::async(std::launch::async, work));
  }
  work();
  for (auto& helper : helpers) helper.get();

  std::vector<TrianglePair> result;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (collides[i]) result.push_back(candidates[i]);
  }
  return result;
}

ExactResult all_colliding_pairs(const Scene& scene, unsigned threads) {
  constexpr std::size_t kChunk =
      1 << 18;  // pairs decided at a time: tens of millions of candidates are never stored
  ExactResult result;
  std::vector<TrianglePair> chunk;
  const auto decide = [&] {
    const auto start = Clock::now();
    const std::vector<TrianglePair> found = colliding_pairs(scene, chunk, threads);
    result.pairs.insert(result.pairs.end(), found.begin(), found.end());
    result.box_pairs += chunk.size();
    chunk.clear();
    result.predicates_ms += ms_since(start);
  };
  const auto start = Clock::now();
  join(scene, [&](const JoinBox* a, const JoinBox* b) {
    chunk.push_back({std::min(a->triangle, b->triangle), std::max(a->triangle, b->triangle)});
    if (chunk.size() == kChunk) decide();
  });
  decide();
  result.join_ms = ms_since(start) - result.predicates_ms;
  std::sort(result.pairs.begin(), result.pairs.end());
  return result;
}

}  // namespace farcull
