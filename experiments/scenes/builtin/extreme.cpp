// Scenes that go to an extreme by a number: slivers of any aspect, gaps of any number of ulps,
// stacks of sheets at any distance, triangles of any ratio of sizes.
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {

using namespace shapes;

namespace {

// Some direction across another one, of length 1.
Vec3 across(const Vec3& along, Random& random) {
  for (;;) {
    const Vec3 out = along.cross(random.direction());
    if (out.norm() > 0.1) return out / out.norm();
  }
}

// Its longest side 1 long, its height over that side 1 / aspect, in any direction.
Corners sliver(double aspect, Random& random) {
  const Vec3 along = random.direction();
  const Vec3 start = -0.5 * along;
  return {start, start + along,
          start + random.between(0.3, 0.7) * along + across(along, random) / aspect};
}

// Equilateral, about the origin, in any direction.
Corners equilateral(double side, Random& random) {
  const Vec3 along = random.direction();
  const Vec3 other = across(along, random);
  const double high = side * std::sqrt(0.75);
  return {-0.5 * side * along - high / 3 * other, 0.5 * side * along - high / 3 * other,
          2 * high / 3 * other};
}

Vec3 normal_of(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
}

}  // namespace

BuiltScene make_slivers(const SceneParameters& parameters, std::uint64_t seed) {
  const double aspect = parameters.second;
  Random random(seed);
  std::vector<Corners> first, second;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    first.push_back(shifted(sliver(aspect, random), random.in_cube(1)));
    // Three in four cross the sliver of the first object, the fourth passes it at twice its height.
    const Corners other = sliver(aspect, random);
    const Vec3 from = inner_point(other, random);
    Vec3 to = inner_point(first.back(), random);
    if (i % 4 == 3) to += 2 / aspect * random.direction();
    second.push_back(shifted(other, to - from));
  }
  return {two_objects("slivers", "first", soup(first), "second", soup(second)), {}};
}

BuiltScene make_mixed(const SceneParameters& parameters, std::uint64_t seed) {
  const double small = 1 / parameters.second;
  Random random(seed);
  std::vector<Corners> large, little;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    large.push_back(shifted(equilateral(1, random), random.in_cube(1)));
    // Eight small ones at each large one: every other crosses it, the rest stand off by two of
    // their sides.
    for (int k = 0; k < 8; ++k) {
      Vec3 at = inner_point(large.back(), random);
      if (k % 2 == 1) at += 2 * small * normal_of(large.back());
      little.push_back(shifted(equilateral(small, random), at));
    }
  }
  return {two_objects("mixed", "large", soup(large), "small", soup(little)), {}};
}

// The sheets lie in the slope z = x/4 + y/8, and their places and tilts are multiples of an eighth
// of the gap, a power of two from 2^-47 to 2^-3: of at most 2^10 sheets every sum is exact in
// double.
BuiltScene make_stack(const SceneParameters& parameters) {
  const double gap = stack_gap(parameters.second);
  constexpr std::uint32_t kCells = 8;  // of a sheet, along a side
  const Mesh shape = grid(kCells);
  SceneBuilder scene("stack", "stack");
  for (std::uint64_t s = 0; s < parameters.size; ++s) {
    const bool crosses = s % 4 == 3;
    Mesh placed = shape;
    for (Vec3& p : placed.vertices) {
      const double tilt = crosses ? 1.5 * (1 - 2 * p.x()) : 0;
      p.z() = (0.25 * p.x() + 0.125 * p.y()) + (static_cast<double>(s) + tilt) * gap;
    }
    scene.add(placed, (crosses ? "crossing" : "sheet") + std::to_string(s), Split::kNone, {});
  }
  return {scene.finish(), {}};
}

double stack_gap(double wanted) { return std::exp2(std::round(std::log2(wanted))); }

// All coordinates are in [1/2, 1), where an ulp is 2^-53, and multiples of it: every number here is
// exact.
BuiltScene make_gap(const SceneParameters& parameters) {
  const double gap = std::nearbyint(parameters.second) * 0x1p-53;
  std::uint64_t side = 1;
  while (side * side * side < parameters.size) ++side;
  const double cell = 0.5 / static_cast<double>(std::bit_ceil(side));
  std::vector<Corners> lower, upper;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    const Vec3 corner = Vec3::Constant(0.5) + cell * Vec3(static_cast<double>(i % side),
                                                          static_cast<double>(i / side % side),
                                                          static_cast<double>(i / side / side));
    // Eighths of the cell along two axes; along the third quarters of it from below its middle, in
    // a slope, since what is parallel to a view has no image in it.
    const auto axis = static_cast<int>(i % 3);
    const auto at = [&](double u, double v, double rise, double by) {
      Vec3 p = corner;
      p[(axis + 1) % 3] += u / 8 * cell;
      p[(axis + 2) % 3] += v / 8 * cell;
      p[axis] += (0.375 + rise / 4 + u / 32 + v / 64) * cell + by;
      return p;
    };
    if (i / 3 % 2 == 0) {  // a vertex over a face
      lower.push_back({at(1, 1, 0, 0), at(7, 1, 0, 0), at(1, 7, 0, 0)});
      upper.push_back({at(3, 3, 0, gap), at(6, 1, 1, gap), at(1, 6, 1, gap)});
    } else {  // an edge over an edge, across it
      lower.push_back({at(1, 4, 0, 0), at(7, 4, 0, 0), at(4, 4, -1, 0)});
      upper.push_back({at(4, 1, 0, gap), at(4, 7, 0, gap), at(4, 4, 1, gap)});
    }
  }
  return {two_objects("gap", "lower", soup(lower), "upper", soup(upper)), {}};
}

std::vector<BuiltinScene> extreme_scenes() {
  return {
      drawn({.name = "slivers",
             .description = "slivers of one aspect, most crossing another one",
             .objects = 2,
             .triangles = 400,
             .size = SceneSize{"slivers in each object", 1, 100'000, 200},
             .second = SceneSecond{"aspect, longest side over height", 2, 1e12, 1e6}},
            14, make_slivers),
      taking({.name = "stack",
              .description = "parallel sheets closely above each other, every fourth crossing its "
                             "neighbours at an angle as small",
              .objects = 16,
              .triangles = 2048,
              .size = SceneSize{"sheets", 2, 1000, 16},
              .second = SceneSecond{"distance of neighbours in their widths", 1e-14, 0.1, 1e-9}},
             make_stack),
      drawn({.name = "mixed",
             .description = "large triangles, each with small ones that pierce it or do not",
             .objects = 2,
             .triangles = 450,
             .size = SceneSize{"large triangles", 1, 10'000, 50},
             .second = SceneSecond{"ratio of their sides", 1, 1e12, 1e6}},
            15, make_mixed),
      taking({.name = "gap",
              .description = "vertices above faces and edges above edges by a number of ulps",
              .objects = 2,
              .triangles = 432,
              .size = SceneSize{"pairs", 1, 4096, 216},
              .second =
                  SceneSecond{"number of ulps; 0: they touch, below: they cross", -1e13, 1e13, 1}},
             make_gap),
  };
}

}  // namespace farcull
