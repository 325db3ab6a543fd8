// Bounds of the penetration depth against closed forms, and against the convex hull of all
// differences of corners (CGAL, exact).
#include "verify/penetration.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <Eigen/Geometry>
#include <climits>

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
    const Penetration found = bounds_of(parts.scene, depth, 0.5 * (boxes[0][0] + boxes[1][1]));
    EXPECT_LT(found.hi, found.lo * (1 + 1e-8));
  }
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

/// Turns all vertices of a scene.
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

/// The wall between two prisms of n sides.
void add_washer(Parts& parts, double inner, double outer, int n) {
  const std::uint32_t first = parts.next();
  for (const double z : {0.0, 1.0}) {
    for (const double r : {outer, inner}) {
      for (int i = 0; i < n; ++i)
        parts.vertex(r * std::cos(2 * M_PI * i / n), r * std::sin(2 * M_PI * i / n), z);
    }
  }
  const auto m = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i < m; ++i) {
    const std::uint32_t j = (i + 1) % m;
    parts.quad(first, {j, i, m + i, m + j});
    parts.quad(first, {2 * m + i, 2 * m + j, 3 * m + j, 3 * m + i});
    parts.quad(first, {i, j, 2 * m + j, 2 * m + i});
    parts.quad(first, {m + j, m + i, 3 * m + i, 3 * m + j});
  }
  parts.end("washer");
}

/// A prism of n sides, from z = -1 to z = 2, moved along x.
void add_pin(Parts& parts, double radius, int n, double x) {
  const std::uint32_t first = parts.next();
  const auto m = static_cast<std::uint32_t>(n);
  for (const double z : {-1.0, 2.0}) {
    for (int i = 0; i < n; ++i)
      parts.vertex(x + radius * std::cos(2 * M_PI * i / n), radius * std::sin(2 * M_PI * i / n), z);
  }
  for (std::uint32_t i = 0; i < m; ++i) {
    parts.quad(first, {i, (i + 1) % m, m + (i + 1) % m, m + i});
    if (i < 2) continue;
    parts.triangle(first, first + i, first + i - 1);
    parts.triangle(first + m, first + m + i - 1, first + m + i);
  }
  parts.end("pin");
}

// A plate or a washer, 1 thick, with a hole, and a peg from 1 below to 1 above it. A press fit has
// to leave along z, by 2, however little it is too wide. A loose peg goes back.
TEST(Penetration, OfPegsInHolesIsKnown) {
  RandomNumbers random(test_seed(12));
  for (const bool turned : {false, true}) {
    const auto expect_depth = [&](Parts parts, double depth, Vec3 start, const char* what) {
      parts.vertex(start.x(), start.y(), start.z());
      if (turned) turn(parts.scene, random);
      const Penetration found = bounds_of(parts.scene, depth, parts.scene.vertices.back());
      EXPECT_LT(found.hi, 1.1 * found.lo) << what;
    };
    for (const double wide : {0.2, 0.005, 1e-4}) {
      Parts plate, washer;
      plate.add_ring("plate", {0, 0, 0}, {4, 4, 1}, {1, 1, 0}, {3, 3, 1});
      plate.add_box("peg", Vec3(1 - wide, 1 - wide, -1), Vec3(3 + wide, 3 + wide, 2));
      expect_depth(plate, 2, {1 - wide / 2, 2, 0.5}, "press fit");
      add_washer(washer, 1, 2, 16);
      add_pin(washer, 1 + wide, 16, 0);
      expect_depth(washer, 2, {(1 + wide / 2) * 0.99, 0.1, 0.5}, "press fit in a washer");
    }
    Parts off, turned_pin;
    off.add_ring("plate", {0, 0, 0}, {4, 4, 1}, {1, 1, 0}, {3, 3, 1});
    off.add_box("peg", {0.99, 1.2, -1}, {2.5, 2.8, 2});
    expect_depth(off, 0.01, {0.995, 2, 0.5}, "one wall");
    // The corner at (0.6 + 0.45, 0) is beyond the corner of the hole at (1, 0).
    add_washer(turned_pin, 1, 2, 4);
    add_pin(turned_pin, 0.6, 4, 0.45);
    expect_depth(turned_pin, 0.05, {1.02, 0, 0.5}, "a corner in a corner");
  }
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
    // The box leaves upwards; the surface is highest at the edge of its lower face. Its twin, the
    // bound of the convex hull alone, is 0.5, which is too much.
    const Penetration found = bounds_of(parts.scene, size * (0.5 - 0.8 * dent), middle);
    if (size == 1) {
      EXPECT_LT(found.hi, 1.05 * found.lo) << dent;
    }
  }
}

}  // namespace
}  // namespace farcull
