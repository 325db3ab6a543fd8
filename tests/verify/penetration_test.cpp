// Bounds of the penetration depth against closed forms, and against the convex hull of all
// differences of corners (CGAL, exact).
#include "verify/penetration.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <Eigen/Geometry>

#include "tests/lab/parts.h"

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

/// An object of the scene. Each corner counts as a piece, which is right, if slow.
ClosedObject closed_object(const Scene& scene, std::uint32_t object) {
  std::vector<Vec3> corners;
  const Object& o = scene.objects.at(object);
  for (std::uint32_t k = 0; k < o.triangle_count; ++k) {
    for (const Vec3& p : scene.corners(o.first_triangle + k)) corners.push_back(p);
  }
  return {scene, object, doubted_surface_of(scene, object), corners};
}

/// The bounds, which must hold of the depth. The translation must separate, and its twin, which is
/// shorter than the depth, must not.
Penetration bounds_of(const Scene& scene, double depth, const Vec3& start) {
  const ClosedObject a = closed_object(scene, 0), b = closed_object(scene, 1);
  const Penetration found = penetration(a, b, std::vector<Vec3>{start});
  EXPECT_LE(found.lo, depth * (1 + 1e-12));
  EXPECT_GE(found.hi, depth * (1 - 1e-12));
  EXPECT_LE(found.translation.norm(), found.hi);
  EXPECT_TRUE(separates(a, b, found.translation));
  EXPECT_FALSE(separates(a, b, 0.999 * depth / found.hi * found.translation));
  return found;
}

TEST(Penetration, OfConvexObjectsIsThatOfTheHullOfDifferences) {
  // FARCULL_PAIRS=10000 for the campaign.
  const char* const wish = std::getenv("FARCULL_PAIRS");
  const int count = wish != nullptr ? std::atoi(wish) : trials(100);
  ASSERT_GT(count, 0);
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
    const Penetration found = bounds_of(parts.scene, std::sqrt(squared), corners[0][0]);
    worst = std::max(worst, found.hi / found.lo);
  }
  EXPECT_LT(worst, 1.1);
}

// ---- objects that are not convex ----

using Cubes = std::set<std::array<int, 3>>;

/// The squared depth of two solids of unit cubes: a whole number. Translations after which they do
/// not overlap are those that are in no open cube with edges of 2 around the difference of two
/// places. So each corner, and the inside of each edge, square and cube of the grid, is free or is
/// not; in the search even numbers stand for whole coordinates, odd ones for what lies between.
long squared_depth(const Cubes& a, const Cubes& b) {
  constexpr int kMost = 16;
  long least = LONG_MAX;
  for (int x = -kMost; x <= kMost; ++x) {
    for (int y = -kMost; y <= kMost; ++y) {
      for (int z = -kMost; z <= kMost; ++z) {
        const std::array at = {x, y, z};
        long squared = 0;
        for (const int c : at) squared += long{std::abs(c) / 2} * (std::abs(c) / 2);
        if (squared >= least) continue;
        const bool held = std::ranges::any_of(a, [&](const auto& p) {
          return std::ranges::any_of(b, [&](const auto& q) {
            bool in = true;
            for (int k = 0; k < 3; ++k) in = in && std::abs(at[k] - 2 * (q[k] - p[k])) < 2;
            return in;
          });
        });
        if (!held) least = squared;
      }
    }
  }
  return least;
}

void turn(Scene& scene, RandomNumbers& random) {
  const Vec3 axis(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  const Eigen::AngleAxisd by(random.between(0, 3), axis.normalized());
  for (Vec3& p : scene.vertices) p = by * p + Vec3(1, 2, 3);
}

// Blocks, L, U, rings and other solids of cubes, half of them turned.
TEST(Penetration, OfSolidsOfCubesIsKnown) {
  const int count = trials(240);
  RandomNumbers random(test_seed(11));
  std::vector<double> ratios;
  int above = 0;
  while (std::ssize(ratios) < count) {
    std::array<Cubes, 2> cubes;
    std::array<int, 3> common{};
    for (Cubes& of : cubes) {
      std::array<int, 3> at = {random.below(3), random.below(3), random.below(3)};
      for (int size = 1 + random.below(9); size > 0;
           --size) {  // a walk, so that they hang together
        of.insert(at);
        int& c = at[random.below(3)];
        c = std::clamp(c + 2 * random.below(2) - 1, 0, 2);
      }
    }
    const auto at =
        std::ranges::find_if(cubes[0], [&](const auto& cube) { return cubes[1].contains(cube); });
    if (at == cubes[0].end()) continue;
    common = *at;
    Parts parts;
    parts.add_cubes("a", cubes[0], random);
    parts.add_cubes("b", cubes[1], random);
    parts.vertex(common[0] + 0.4, common[1] + 0.5, common[2] + 0.6);  // a start
    if (ratios.size() % 2 == 1) turn(parts.scene, random);
    const double depth = std::sqrt(squared_depth(cubes[0], cubes[1]));
    const Penetration found = bounds_of(parts.scene, depth, parts.scene.vertices.back());
    ratios.push_back(found.hi / found.lo);
    above += found.lo > 0;
  }
  std::ranges::sort(ratios);
  std::printf("%d pairs: lo is above 0 of %d; hi / lo is %.4g in the middle, %.4g at most\n", count,
              above, ratios[count / 2], ratios.back());
  EXPECT_GE(above, 0.95 * count);
  EXPECT_LE(ratios[count / 2], 1.5);
}

}  // namespace
}  // namespace farcull
