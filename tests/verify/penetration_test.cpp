// Bounds of the penetration depth against closed forms, and against the convex hull of all
// differences of corners (CGAL, exact).
#include "verify/penetration.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include "tests/lab/parts.h"
#include "verify/inside.h"

namespace farcull {
namespace {

using lab::Parts;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Hull = CGAL::Surface_mesh<Kernel::Point_3>;

Hull hull_of(const std::vector<Kernel::Point_3>& points) {
  Hull out;
  CGAL::convex_hull_3(points.begin(), points.end(), out);
  return out;
}

/// The convex hull of some points as an object, and its corners.
std::vector<Vec3> add_hull(Parts& parts, const std::vector<Vec3>& points) {
  std::vector<Kernel::Point_3> in;
  for (const Vec3& p : points) in.emplace_back(p.x(), p.y(), p.z());
  const Hull hull = hull_of(in);
  const std::uint32_t first = parts.next();
  std::vector<Vec3> corners;
  for (const auto v : hull.vertices()) {
    const auto& p = hull.point(v);
    corners.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
    parts.vertex(corners.back().x(), corners.back().y(), corners.back().z());
  }
  for (const auto f : hull.faces()) {
    std::vector<std::uint32_t> v;
    for (const auto h : CGAL::vertices_around_face(hull.halfedge(f), hull))
      v.push_back(first + static_cast<std::uint32_t>(h));
    parts.triangle(v[0], v[1], v[2]);
  }
  parts.end("hull");
  return corners;
}

/// The squared depth of convex objects with these corners: the origin's least distance from the
/// planes of the hull of all differences. Negative if the origin is outside.
double squared_depth(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  std::vector<Kernel::Point_3> differences;
  for (const Vec3& p : a) {
    for (const Vec3& q : b)
      differences.emplace_back(Kernel::FT(p.x()) - q.x(), Kernel::FT(p.y()) - q.y(),
                               Kernel::FT(p.z()) - q.z());
  }
  const Hull hull = hull_of(differences);
  const Kernel::Point_3 origin(0, 0, 0);
  std::optional<Kernel::FT> least;
  for (const auto f : hull.faces()) {
    const auto h = hull.halfedge(f);
    const Kernel::Plane_3 plane(hull.point(hull.source(h)), hull.point(hull.target(h)),
                                hull.point(hull.target(hull.next(h))));
    if (!plane.has_on_negative_side(origin)) return -1;
    const Kernel::FT squared = CGAL::squared_distance(plane, origin);
    if (!least || squared < *least) least = squared;
  }
  return CGAL::to_double(*least);
}

/// The bounds hold of the depth, and the translation separates.
void expect_bounds(const Scene& scene, const Penetration& found, double depth) {
  EXPECT_LE(found.lo, depth * (1 + 1e-14));
  EXPECT_GE(found.hi, depth * (1 - 1e-14));
  EXPECT_LE(found.translation.norm(), found.hi);
  EXPECT_TRUE(separates(scene, {0, 1}, found.direction, found.translation));
  // A forged one, shorter than the depth, is refused.
  EXPECT_FALSE(separates(scene, {0, 1}, found.direction, 0.999 * found.translation));
}

TEST(Penetration, OfBoxesIsKnown) {
  RandomNumbers random(test_seed(3));
  for (int k = 0; k < trials(40); ++k) {
    std::array<std::array<Vec3, 2>, 2> boxes;
    for (auto& [lo, hi] : boxes) {
      for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = random.between(0, 1);
        hi[axis] = lo[axis] + random.between(1, 3);
      }
    }
    Parts parts;
    parts.add_box("a", boxes[0][0], boxes[0][1]);
    parts.add_box("b", boxes[1][0], boxes[1][1]);
    double depth = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      depth = std::min(
          {depth, boxes[0][1][axis] - boxes[1][0][axis], boxes[1][1][axis] - boxes[0][0][axis]});
    }
    const std::vector<Vec3> starts = {0.5 * (boxes[0][0] + boxes[1][1])};
    const Penetration found = penetration(parts.scene, {0, 1}, starts);
    expect_bounds(parts.scene, found, depth);
    EXPECT_LT(found.hi, found.lo * (1 + 1e-8));
  }
}

TEST(Penetration, OfConvexObjectsIsThatOfTheHullOfDifferences) {
  // FARCULL_PAIRS=10000 for the campaign.
  const char* const wish = std::getenv("FARCULL_PAIRS");
  const int count = wish != nullptr ? std::atoi(wish) : trials(100);
  RandomNumbers random(test_seed(4));
  int tested = 0;
  double worst = 1;
  for (int k = 0; more_cases(k, 0, tested == count, 20 * count); ++k) {
    Parts parts;
    std::array<std::vector<Vec3>, 2> corners;
    for (auto& of : corners) {
      const Vec3 at(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      const double flat = std::exp2(random.between(-4, 0));
      std::vector<Vec3> points;
      const int size = 4 + random.below(12);
      for (int i = 0; i < size; ++i) {
        points.push_back(
            at + Vec3(random.between(-1, 1), random.between(-1, 1), flat * random.between(-1, 1)));
      }
      of = add_hull(parts, points);
    }
    const double squared = squared_depth(corners[0], corners[1]);
    if (!(squared > 0)) continue;
    ++tested;
    const Penetration found = penetration(parts.scene, {0, 1}, corners[0]);
    expect_bounds(parts.scene, found, std::sqrt(squared));
    worst = std::max(worst, found.hi / found.lo);
  }
  EXPECT_LT(worst, 1.1);
}

TEST(Penetration, OfObjectsThatAreNotConvexHasBoundsByBalls) {
  // A peg in a plate, wider than the hole by 0.2 on each side. It has to leave along z, by 1.5 at
  // least; some common point is as far inside as the balls say.
  Parts parts;
  parts.add_ring("plate", {0, 0, 0}, {4, 4, 1}, {1, 1, 0}, {3, 3, 1});
  parts.add_box("peg", {0.8, 0.8, -1}, {3.2, 3.2, 2});
  const Penetration found = penetration(parts.scene, {0, 1}, std::vector<Vec3>{{0.9, 2, 0.5}});
  EXPECT_GE(found.hi, 2);
  EXPECT_LT(found.hi, 2 + 1e-9);
  EXPECT_GT(found.lo, 0.19);
  EXPECT_LE(found.lo, 2);
}

// A dent does not make the bound of nearly convex objects wrong: it is less by the dent.
TEST(Penetration, OfDentedBoxesIsBoundedByTheDent) {
  for (const auto& [size, dent] : {std::pair(1.0, 1e-15),
                                   {1.0, 1e-9},
                                   {1.0, 1e-3},
                                   {1.0, 0.3},
                                   {0x1p255, 0.3},
                                   {0x1p256, 0.3}}) {
    Parts parts;
    const std::uint32_t first = parts.next();
    for (int k = 0; k < 8; ++k) parts.vertex(k & 1, (k & 2) / 2, (k & 4) / 4);
    parts.vertex(0.5, 0.5, 1 - dent);
    for (const auto& q : {std::array{0u, 2u, 3u, 1u},
                          {0u, 1u, 5u, 4u},
                          {2u, 6u, 7u, 3u},
                          {0u, 4u, 6u, 2u},
                          {1u, 3u, 7u, 5u}})
      parts.quad(first, q);
    for (const auto& [p, q] : {std::pair(4u, 5u), {5u, 7u}, {7u, 6u}, {6u, 4u}})
      parts.triangle(first + p, first + q, first + 8);
    parts.end("dented");
    parts.add_box("b", {0.4, 0.4, 0.5}, {0.6, 0.6, 2});
    for (Vec3& p : parts.scene.vertices) p *= size;
    const Vec3 middle = Vec3::Constant(0.5 * size);
    const Penetration found = penetration(parts.scene, {0, 1}, std::vector<Vec3>{middle});
    // The box leaves upwards; the surface is highest at the edge of its lower face. Its twin, the
    // bound of the convex hull alone, is 0.5, which is too much.
    const double depth = size * (0.5 - 0.8 * dent);
    EXPECT_LE(found.lo, depth) << dent;
    EXPECT_GE(found.hi, depth) << dent;
    if (size == 1) {
      EXPECT_GT(found.lo, dent < 1e-8 ? 0.499 : 0.1) << dent;
    }
    EXPECT_TRUE(separates(parts.scene, {0, 1}, found.direction, found.translation));
  }
}

TEST(Penetration, DistanceBelowIsClose) {
  Parts parts;
  parts.add_box("a", {0, 0, 0}, {1, 2, 3});
  const double found = distance_below(parts.scene, 0, {0.25, 1, 1});
  EXPECT_LE(found, 0.25);
  EXPECT_GT(found, 0.25 - 1e-8);
}

}  // namespace
}  // namespace farcull
