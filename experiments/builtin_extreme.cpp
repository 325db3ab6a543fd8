// Scenes that go to an extreme by a number: slivers of any aspect, gaps of any number of ulps,
// stacks of sheets at any distance, triangles of any ratio of sizes.
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "experiments/builtin_parts.h"
#include "experiments/builtin_shapes.h"
#include "experiments/scene_build.h"

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

BuiltScene two_soups(const std::string& name, const char* first, const std::vector<Corners>& one,
                     const char* second, const std::vector<Corners>& other) {
  SceneBuilder scene(name, name);
  scene.add(soup(one), first, Split::kNone, {});
  scene.add(soup(other), second, Split::kNone, {});
  return {scene.finish(), {}};
}

// A sheet of the stack: 8 by 8 cells of two triangles over the unit square, z of a vertex its steps
// above the sheet's own place.
constexpr std::uint32_t kStackCells = 8;

Mesh flat_sheet() {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i <= kStackCells; ++i) {
    for (std::uint32_t j = 0; j <= kStackCells; ++j)
      vertices.emplace_back(static_cast<double>(i) / kStackCells,
                            static_cast<double>(j) / kStackCells, 0);
  }
  for (std::uint32_t i = 0; i < kStackCells; ++i) {
    for (std::uint32_t j = 0; j < kStackCells; ++j) {
      const std::uint32_t a = i * (kStackCells + 1) + j, b = a + kStackCells + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
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
  return two_soups("slivers", "first", first, "second", second);
}

BuiltScene make_mixed(const SceneParameters& parameters, std::uint64_t seed) {
  const double small = 1 / parameters.second;
  Random random(seed);
  std::vector<Corners> large, little;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    large.push_back(shifted(equilateral(1, random), random.in_cube(1)));
    // Of eight small ones at each, every other is pierced, the others stand off by two of their
    // sides.
    for (int k = 0; k < 8; ++k) {
      Vec3 at = inner_point(large.back(), random);
      if (k % 2 == 1) at += 2 * small * normal_of(large.back());
      little.push_back(shifted(equilateral(small, random), at));
    }
  }
  return two_soups("mixed", "large", large, "small", little);
}

// The sheets lie in the slope z = x/4 + y/8, and their places and tilts are multiples of an eighth
// of the gap, a power of two from 2^-47 to 2^-3: of at most 2^10 sheets every sum is exact in
// double.
BuiltScene make_stack(const SceneParameters& parameters) {
  const double gap = stack_gap(parameters.second);
  const Mesh shape = flat_sheet();
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
  return two_soups("gap", "lower", lower, "upper", upper);
}

}  // namespace farcull
