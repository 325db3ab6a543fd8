#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "experiments/builtin_parts.h"
#include "experiments/builtin_shapes.h"
#include "experiments/scene_build.h"

namespace farcull {

using namespace shapes;

namespace {

// About the z axis; `around` steps along the ring, `across` around the tube, 2 * around * across
// triangles.
Mesh torus(double ring, double tube, std::uint32_t around, std::uint32_t across) {
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = kTurn * i / around;
      const double v = kTurn * j / across;
      const double r = ring + tube * std::cos(v);
      vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
      const std::uint32_t next_i = (i + 1) % around;
      const std::uint32_t next_j = (j + 1) % across;
      const std::uint32_t a = i * across + j;
      const std::uint32_t b = next_i * across + j;
      const std::uint32_t c = next_i * across + next_j;
      const std::uint32_t d = i * across + next_j;
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
}

Mesh tetrahedron() {
  return finished({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                  {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
}

Placement moved(const Vec3& by) { return {.scale = {}, .rotate = {}, .translate = by}; }

// A triangle of length 1 and the given width, its long axis in any direction.
Corners needle(Random& random, double width) {
  const Vec3 along = random.direction();
  Vec3 across = along.cross(random.direction());
  while (across.norm() < 0.1) across = along.cross(random.direction());
  across *= width / across.norm();
  const Vec3 start = -0.5 * along;
  return {start, start + along, start + random.between(0.2, 0.8) * along + across};
}

}  // namespace

std::array<Vec3, 4> corners(const Square& square) {
  const double h = square.side / 2;
  const Vec3& c = square.centre;
  return {Vec3(c + Vec3(-h, -h, 0)), Vec3(c + Vec3(h, -h, 0)), Vec3(c + Vec3(h, h, 0)),
          Vec3(c + Vec3(-h, h, 0))};
}

Scene make_two_spheres() {
  const Mesh mesh = sphere(4);
  SceneBuilder scene("two-spheres", "two-spheres");
  scene.add(mesh, "first", Split::kNone, {});
  scene.add(mesh, "second", Split::kNone,
            {.scale = {},
             .rotate = Placement::Rotation{Vec3(1, 2, 3), 0.4},
             .translate = Vec3(1.1, 0.37, 0.23)});
  return scene.finish();
}

Scene make_two_tori() {
  // Moved by 1.5, the second ring passes within 0.5 of the first: linked, and tubes of radius 0.35
  // cross.
  const Mesh mesh = torus(1, 0.35, 100, 50);
  SceneBuilder scene("two-tori", "two-tori");
  scene.add(mesh, "first", Split::kNone, {});
  scene.add(mesh, "second", Split::kNone,
            {.scale = {},
             .rotate = Placement::Rotation{Vec3(1, 0.1, 0.05), std::numbers::pi / 2},
             .translate = Vec3(1.5, 0.02, 0.03)});
  return scene.finish();
}

Scene make_random_soup(std::uint64_t seed) {
  Random random(seed);
  SceneBuilder scene("random-soup", "random-soup");
  for (int object = 0; object < 8; ++object) {
    std::vector<Corners> list(500);
    for (Corners& corners : list) {
      const Vec3 centre = random.in_cube(1);
      const double size = random.over_octaves(10);
      for (Vec3& p : corners) p = centre + size * random.in_ball();
    }
    scene.add(soup(list), "soup" + std::to_string(object), Split::kNone, {});
  }
  return scene.finish();
}

Scene make_needles(std::uint64_t seed) {
  Random random(seed);
  std::vector<Corners> first;
  std::vector<Corners> second;
  for (int i = 0; i < 400; ++i) {
    const double width = random.over_octaves(20);
    first.push_back(shifted(needle(random, width), random.in_cube(1)));
    // One in four stands anywhere. The others cross the needle of the first object or pass it
    // within their width.
    const double other_width = random.over_octaves(20);
    const Corners other = needle(random, other_width);
    if (i % 4 == 3) {
      second.push_back(shifted(other, random.in_cube(1)));
      continue;
    }
    const Vec3 from = inner_point(other, random);
    Vec3 to = inner_point(first.back(), random);
    if (i % 4 == 2) to += 2 * std::min(width, other_width) * random.direction();
    second.push_back(shifted(other, to - from));
  }
  SceneBuilder scene("needles", "needles");
  scene.add(soup(first), "first", Split::kNone, {});
  scene.add(soup(second), "second", Split::kNone, {});
  return scene.finish();
}

Scene make_degenerate() {
  constexpr double kHair = 0x1p-40;
  const Corners face = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  // Every pair touches or crosses, by integers, in the way that is said beside it.
  const std::vector<std::pair<Corners, Corners>> cases = {
      {face, {Vec3(1, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 0)}},  // point in face
      {face, {Vec3(2, 0, 0), Vec3(2, 0, 0), Vec3(2, 0, 0)}},  // point on edge
      {face, {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)}},  // point at vertex
      {{Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)},
       {Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)}},  // point at point
      {{Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)},
       {Vec3(0, 0, 0), Vec3(2, 2, 2), Vec3(2, 2, 2)}},         // point on segment
      {face, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 1)}},  // segment through face
      {face, {Vec3(1, 1, 0), Vec3(1, 1, 2), Vec3(1, 1, 0)}},   // segment ends on face
      {face, {Vec3(-1, 1, 0), Vec3(5, 1, 0), Vec3(2, 1, 0)}},  // segment in plane
      {{Vec3(0, 0, 0), Vec3(4, 4, 0), Vec3(2, 2, 0)},
       {Vec3(0, 4, 0), Vec3(4, 0, 0), Vec3(4, 0, 0)}},  // segment across segment
      {{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(4, 0, 0)},
       {Vec3(2, 0, 0), Vec3(5, 0, 0), Vec3(5, 0, 0)}},                 // segment along segment
      {face, {Vec3(0, 0, 0), Vec3(-4, 0, 2), Vec3(0, -4, 2)}},         // vertex at vertex
      {face, {Vec3(2, 0, 0), Vec3(0, -4, 1), Vec3(4, -4, -1)}},        // vertex on edge
      {face, {Vec3(1, 1, 0), Vec3(0, 1, 3), Vec3(2, 1, 3)}},           // vertex on face
      {face, {Vec3(2, -1, -1), Vec3(2, 1, 1), Vec3(2, -3, 3)}},        // edge across edge
      {face, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 1, 3)}},           // edge in face
      {face, {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(2, -3, 2)}},          // edge along edge
      {face, {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(2, -4, 0)}},          // coplanar, edge along edge
      {face, {Vec3(4, 0, 0), Vec3(6, 1, 0), Vec3(6, -1, 0)}},          // coplanar, vertex at vertex
      {face, {Vec3(1, 1, 0), Vec3(5, 1, 0), Vec3(1, 5, 0)}},           // coplanar, overlapping
      {face, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)}},           // coplanar, inside
      {face, face},                                                    // the same triangle
      {face, {Vec3(1, 1, -2), Vec3(1, 1, 2), Vec3(1 + kHair, 1, 2)}},  // sliver through face
      {face, {Vec3(1, 1, 0), Vec3(1, 3, 4), Vec3(1 + kHair, 3, 4)}},   // sliver, vertex on face
  };
  // Each three times in a grid of cells: as it is, and with the second triangle a hair higher and
  // lower. Cells are apart by integers and a hair is far above an ulp there, so every coordinate is
  // exact.
  std::vector<Corners> first;
  std::vector<Corners> second;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto row = static_cast<double>(i);
    for (int lift = -1; lift <= 1; ++lift) {
      const Vec3 cell(16 * row, 16.0 * lift, 0);
      first.push_back(shifted(cases[i].first, cell));
      second.push_back(shifted(cases[i].second, cell + Vec3(0, 0, lift * kHair)));
    }
  }
  SceneBuilder scene("degenerate", "degenerate");
  scene.add(soup(first), "first", Split::kNone, {});
  scene.add(soup(second), "second", Split::kNone, {});
  return scene.finish();
}

Scene make_ground(std::uint64_t seed) {
  Random random(seed);
  SceneBuilder scene("ground", "ground");
  for (int i = 0; i < 5; ++i) {
    // Centres lie about one radius above the ground: some blobs are sunk into it, some touch
    // nothing.
    const Vec3 at(1.6 * i - 3.2, random.between(-1, 1), random.between(0.7, 1.5));
    const Mesh mesh = blob(3, random);
    scene.add(mesh, "blob" + std::to_string(i), Split::kNone, random.anywhere(at));
  }
  const std::array<Vec3, 4> square = corners({Vec3::Zero(), 10000});
  scene.add(finished({square.begin(), square.end()}, {{0, 1, 2}, {0, 2, 3}}), "ground",
            Split::kNone, {});
  return scene.finish();
}

Scene make_crowd(std::uint64_t seed) {
  Random random(seed);
  SceneBuilder scene("crowd", "crowd");
  for (int i = 0; i < 400; ++i) {
    const bool is_blob = i % 4 == 3;
    const Mesh mesh = is_blob ? blob(1, random) : tetrahedron();
    Placement placement = random.anywhere(random.in_cube(6));
    placement.scale = Vec3::Constant(random.between(0.2, 0.6));
    scene.add(mesh, (is_blob ? "blob" : "tetrahedron") + std::to_string(i), Split::kNone,
              placement);
  }
  return scene.finish();
}

Scene make_far_apart() {
  const Mesh mesh = sphere(3);
  SceneBuilder scene("far-apart", "far-apart");
  scene.add(mesh, "first", Split::kNone, {});
  scene.add(mesh, "second", Split::kNone, moved(Vec3(100, 30, -20)));
  return scene.finish();
}

}  // namespace farcull
