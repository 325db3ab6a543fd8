// Scenes of spheres, tori, blobs, slivers and degenerate triangles.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

using namespace shapes;

namespace {

Mesh tetrahedron() {
  return finished({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                  {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
}

// Returns a triangle with a longest side of 1 and the given width. Its direction is random.
Corners needle(Random& random, double width) {
  const Vec3 along = random.direction();
  const Vec3 aside = across(along, width, random);
  const Vec3 start = -0.5 * along;
  return {start, start + along, start + random.between(0.2, 0.8) * along + aside};
}

Scene make_two_spheres() {
  const Mesh mesh = sphere(4);
  return two_objects("two-spheres", "first", mesh, "second", mesh,
                     {.scale = {},
                      .rotate = Placement::Rotation{Vec3(1, 2, 3), 0.4},
                      .translate = Vec3(1.1, 0.37, 0.23)});
}

Scene make_two_tori() {
  // The two rings are linked, and their centre circles are 0.5 apart. The tubes around these
  // circles have radius 0.35, so they intersect.
  const Mesh mesh = torus(1, 0.35, 100, 50);
  return two_objects("two-tori", "first", mesh, "second", mesh,
                     {.scale = {},
                      .rotate = Placement::Rotation{Vec3(1, 0.1, 0.05), std::numbers::pi / 2},
                      .translate = Vec3(1.5, 0.02, 0.03)});
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
    scene.add(soup(list), "soup" + std::to_string(object));
  }
  return scene.finish();
}

constexpr std::uint64_t kAxial = kGolden;  // seed ^ kAxial is the seed for slivers along the axes

Vec3 axis(std::uint32_t k) { return Vec3::Unit(k % 3); }

// Returns a sliver along axis k, with its width along axis k + 1.
Corners axial_needle(std::uint32_t k, double width, Random& random) {
  const Vec3 start = -0.5 * axis(k);
  return {start, start + axis(k), start + random.between(0.2, 0.8) * axis(k) + width * axis(k + 1)};
}

// Moves two of the four objects. The second object rotates. Each sliver of the fourth object slides
// along its long axis.
Motion turning_and_sliding(const Scene& scene) {
  return [rest = scene.vertices, objects = scene.objects](const Instant& now, Scene& out,
                                                          FrameNotes&) {
    const double swing = std::sin(2 * std::numbers::pi * now.time);
    const Eigen::AngleAxisd turn(0.2 * swing, Vec3(1, 1, 1).normalized());
    const Eigen::Matrix3d matrix = turn.toRotationMatrix();
    const auto corners = [&](const Object& object) {  // each triangle has three vertices of its own
      return std::pair(3 * object.first_triangle,
                       3 * (object.first_triangle + object.triangle_count));
    };
    const auto [first, last] = corners(objects[1]);
    for (std::uint32_t v = first; v < last; ++v) out.vertices[v] = matrix * rest[v];
    const auto [from, to] = corners(objects[3]);
    for (std::uint32_t v = from; v < to; ++v) {
      const std::uint32_t sliver = (v - from) / 3;
      out.vertices[v] = rest[v] + 0.4 * swing * axis(sliver + sliver / 3);
    }
  };
}

// size: number of slivers in each of the two oblique objects. A larger scene begins with the same
// slivers, bit for bit. Each of the other two objects has 3/8 as many slivers along the axes.
BuiltScene make_needles(const SceneParameters& parameters, std::uint64_t seed) {
  Random random(seed);
  std::vector<Corners> first;
  std::vector<Corners> second;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    const double width = random.over_octaves(20);
    first.push_back(shifted(needle(random, width), random.in_cube(1)));
    // Of every four slivers, three cross a sliver of the first object, and the fourth has a random
    // position. Then the third of the four is moved away by twice the smaller width.
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
  // Makes two objects with slivers along the coordinate axes. Each sliver crosses a sliver of the
  // other object. All nine combinations of two axes occur in turn.
  Random axial(seed ^ kAxial);
  std::vector<Corners> third;
  std::vector<Corners> fourth;
  for (std::uint32_t i = 0; i < 3 * (parameters.size / 8); ++i) {
    const double one_width = axial.over_octaves(20);
    const Corners one = axial_needle(i, one_width, axial);
    third.push_back(shifted(one, axial.in_cube(1)));
    const double width = axial.over_octaves(20);
    const Corners other = axial_needle(i + i / 3, width, axial);
    const Vec3 from = inner_point(other, axial);
    const Vec3 to = inner_point(third.back(), axial);
    fourth.push_back(shifted(other, to - from));
  }
  SceneBuilder scene("needles", "needles");
  scene.add(soup(first), "first");
  scene.add(soup(second), "second");
  scene.add(soup(third), "along axes");
  scene.add(soup(fourth), "along axes too");
  BuiltScene built{scene.finish(), {}};
  built.motion = turning_and_sliding(built.scene);
  return built;
}

Scene make_degenerate() {
  constexpr double kHair = 0x1p-40;
  const Corners face = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  // The comment at each pair states the kind of contact. Most coordinates are whole numbers.
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
  // Each case appears three times in a grid of cells: unchanged, with the second triangle raised by
  // kHair, and with the second triangle lowered by kHair. kHair is far above an ulp, so every
  // coordinate is exact.
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
  return two_objects("degenerate", "first", soup(first), "second", soup(second));
}

Scene make_ground(std::uint64_t seed) {
  Random random(seed);
  SceneBuilder scene("ground", "ground");
  for (int i = 0; i < 5; ++i) {
    // A blob's centre is about one radius above the ground. So some blobs intersect the ground, and
    // others touch nothing.
    const Vec3 at(1.6 * i - 3.2, random.between(-1, 1), random.between(0.7, 1.5));
    const Mesh mesh = blob(3, random);
    scene.add(mesh, "blob" + std::to_string(i), Split::kNone, random.anywhere(at));
  }
  const std::array<Vec3, 4> ground = square(Vec3::Zero(), 10000);
  scene.add(finished({ground.begin(), ground.end()}, {{0, 1, 2}, {0, 2, 3}}), "ground",
            Split::kNone, {});
  return scene.finish();
}

constexpr double kUsualCrowdDensity = 400.0 / (12 * 12 * 12);

// size: number of objects; second: objects per unit of volume.
BuiltScene make_crowd(const SceneParameters& parameters, std::uint64_t seed) {
  const double half = 6 * std::cbrt(static_cast<double>(parameters.size) / 400 *
                                    (kUsualCrowdDensity / parameters.second));
  Random random(seed);
  SceneBuilder scene("crowd", "crowd");
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    const bool is_blob = i % 4 == 3;
    const Mesh mesh = is_blob ? blob(1, random) : tetrahedron();
    Placement placement = random.anywhere(random.in_cube(half));
    placement.scale = Vec3::Constant(random.between(0.2, 0.6));
    scene.add(mesh, (is_blob ? "blob" : "tetrahedron") + std::to_string(i), Split::kNone,
              placement);
  }
  BuiltScene built{scene.finish(), {}};
  built.motion = drift(built.scene);
  return built;
}

Scene make_far_apart() {
  const Mesh mesh = sphere(3);
  return two_objects("far-apart", "first", mesh, "second", mesh,
                     {.scale = {}, .rotate = {}, .translate = Vec3(100, 30, -20)});
}

}  // namespace

std::vector<BuiltinScene> generated_scenes() {
  return {
      entry("two-spheres", 0, moved(make_two_spheres, pulse), "two interpenetrating spheres", 2,
            10240, "both breathe while waves run along them"),
      entry("two-tori", 0, make_two_tori, "two linked tori whose tubes cross", 2, 20000),
      entry("random-soup", 1, make_random_soup,
            "random triangles with sizes over three decades, many crossing", 8, 4000),
      entry("needles", 2, make_needles,
            "slivers of aspect up to 2e6 that cross or pass each other closely, oblique in two "
            "objects and along the axes in two",
            4, 1100, "one oblique object turns, one along the axes slides along them",
            {"slivers in each oblique object", 8, 1'000'000, 400}),
      entry("degenerate", 0, make_degenerate,
            "points, segments, slivers and exact contacts of every kind, also missed by 2^-40", 2,
            138),
      entry("ground", 3, make_ground,
            "bumpy blobs on a ground of two triangles a thousand times larger", 6, 6402),
      entry("crowd", 4, make_crowd, "tetrahedra and blobs in a box, some colliding", 400, 9200,
            "each object drifts by up to its diagonal and back", {"objects", 2, 1'000'000, 400},
            {"density in objects per unit of volume", 1e-3, 10, kUsualCrowdDensity}),
      entry("far-apart", 0, make_far_apart, "two spheres far from each other", 2, 2560),
  };
}

}  // namespace farcull
