// The oriented box against rationals: obb_of() holds hull and ball, and the kernel's interval holds
// the exact one of the solid that the floats say.
#include "offsets/offsets.h"

#include <Eigen/Geometry>

#include "core/base/glsl_shim.h"
#include "tests/lab/rational.h"
#include "tests/lab/solids.h"
#include "tests/lab/test.h"

namespace farcull {
namespace glsl::obb_without_widening {
#define FAR_WIDEN 0.0f
// clang-format off
#include "offsets/slab.glsl"  // the next one needs it
#include "offsets/obb.glsl"
// clang-format on
#undef FAR_WIDEN
}  // namespace glsl::obb_without_widening

namespace {

using box_line::adversarial, box_line::exact_interval, box_line::outer_interval, rational::Q,
    rational::Random;
using Points = std::vector<Vec3>;
using Kernel = bool (*)(float cx, float cy, const Solid& solid, float& entry, float& exit);

bool without_widening(float cx, float cy, const Solid& solid, float& entry, float& exit) {
  glsl::vec4 s[5];
  for (int i = 0; i < 5; ++i) s[i] = {solid[i][0], solid[i][1], solid[i][2], solid[i][3]};
  return glsl::obb_without_widening::solid_interval({cx, cy}, s[0], s[1], s[2], s[3], s[4], entry,
                                                    exit);
}

// ---- obb_of ----

/// The ball around each point inside each slab: |a . (p - m)| + r |a| <= h; and inside the z range.
void expect_holds_balls(const Solid& solid, const Points& points, double radius) {
  const Q r(radius);
  for (const Vec3& p : points) {
    const Q d[3] = {Q(p[0]) - Q(solid[0][0]), Q(p[1]) - Q(solid[0][1]), Q(p[2]) - Q(solid[0][2])};
    for (int i = 1; i <= 3; ++i) {
      const Q a[3] = {Q(solid[i][0]), Q(solid[i][1]), Q(solid[i][2])};
      const Q rest = Q(solid[i][3]) - abs(a[0] * d[0] + a[1] * d[1] + a[2] * d[2]);
      ASSERT_GE(rest, 0) << "slab " << i;
      ASSERT_GE(rest * rest, r * r * (a[0] * a[0] + a[1] * a[1] + a[2] * a[2])) << "slab " << i;
    }
    ASSERT_LE(Q(solid[0][3]), Q(p[2]) - r);
    ASSERT_GE(Q(solid[4][0]), Q(p[2]) + r);
  }
}

Points random_points(Random& random) {
  const double reach = random.below(3) == 0 ? std::exp2(random.uniform(10, 31)) : 600;
  const Vec3 at(random.uniform(-600, 600), random.uniform(-600, 600),
                random.uniform(-1, 1) * reach);
  const auto near = [&](double lo, double hi) { return Vec3(at + random.scaled3(lo, hi)); };
  const int kind = random.below(9);
  if (kind == 0) return {near(-4, 9), near(-4, 9), near(-4, 9)};
  if (kind == 1) {  // needle, aspect 1e3 .. 1e12
    const Vec3 e = random.scaled3(0, 9);
    return {at - e, at + e, at + e * random.uniform(-1, 1) + random.scaled3(-40, -3)};
  }
  if (kind == 2) return {at, at, near(-10, 9)};  // a segment
  if (kind == 3) return {at, at, at};            // a point
  if (kind == 4) return {at};                    // one point
  if (kind == 5) return {near(-60, -20), near(-60, -20), near(-60, -20)};
  if (kind == 6) return {random.scaled3(-160, -100), random.scaled3(-160, -100), Vec3::Zero()};
  Points points;
  if (kind == 7) {  // flat along an axis: normals with exact zeros
    points = {near(0, 9), near(0, 9), near(0, 9), near(0, 9)};
    const int axis = random.below(3);
    for (Vec3& p : points) p[axis] = at[axis];
  } else {
    for (int i = 0; i < 3 + random.below(7); ++i) points.push_back(near(-2, 8));
  }
  return points;
}

TEST(ObbOf, HoldsHullAndBallOfEveryPolygon) {
  Random random(test_seed(501));
  for (int n = 0; n < trials(30'000); ++n) {
    const Points points = random_points(random);
    const double radius = random.below(4) == 0   ? 0
                          : random.below(3) == 0 ? std::abs(random.scaled(-20, 8))
                                                 : 0.715;
    const Solid solid = obb_of(points, radius);
    for (const auto& row : solid)
      for (const float x : row) ASSERT_TRUE(std::isfinite(x));
    for (int i = 1; i <= 3; ++i)
      for (int k = 0; k < 3; ++k)
        ASSERT_LE(std::abs(solid[i][k]), 1.001f);           // the kernel's |a| <= 2
    for (int k = 1; k < 4; ++k) ASSERT_EQ(solid[4][k], 0);  // the canvas's own numbers
    expect_holds_balls(solid, points, radius);
    if (HasFatalFailure()) FAIL() << "polygon " << n;
  }
}

// Any box that is large enough would pass above. A triangle in general position is held by a box
// that is at most the ball thicker than the triangle.
TEST(ObbOf, IsTightAroundTriangles) {
  Random random(502);
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 at = random.cube(500);
    const Points points{at + random.cube(20), at + random.cube(20), at + random.cube(20)};
    const Vec3 cross = (points[1] - points[0]).cross(points[2] - points[0]);
    double longest = 0;
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, (points[(i + 1) % 3] - points[i]).norm());
    const Solid solid = obb_of(points, 0.75);
    // Half sizes: along the longest edge, across it (half the height), and along the normal.
    const double half[3] = {0.5 * longest + 0.75, 0.5 * cross.norm() / longest + 0.75, 0.75};
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(solid[1 + i][3], half[i], 1e-4) << "slab " << i;
    const auto [lo, hi] = std::minmax({points[0][2], points[1][2], points[2][2]});
    ASSERT_NEAR(solid[0][3], lo - 0.75, 1e-4);
    ASSERT_NEAR(solid[4][0], hi + 0.75, 1e-4);
  }
}

// ---- the kernel ----

struct Tally {
  long hits = 0, misses = 0, exact = 0, violations = 0;
};

/// True where the kernel's answer holds the exact interval. The double interval decides nearly
/// always, since the widening is by 2^-20; where it does not, rationals do.
void count(Kernel kernel, float cx, float cy, const Solid& solid, Tally& tally) {
  float entry = 0, exit = 0;
  const bool hit = kernel(cx, cy, solid, entry, exit);
  const auto outer = outer_interval(cx, cy, solid);
  ++(outer ? tally.hits : tally.misses);
  if (!outer || (hit && entry <= outer->lo && exit >= outer->hi)) return;
  ++tally.exact;
  const auto truth = exact_interval(cx, cy, solid);
  if (truth && !(hit && Q(entry) <= truth->lo && Q(exit) >= truth->hi)) ++tally.violations;
}

TEST(ObbKernel, TheFilterInDoubleHoldsTheExactInterval) {
  Random random(test_seed(508));
  int hits = 0;
  for (int n = 0; more_cases(n, trials(100'000), hits > 1000); ++n) {
    const auto [cx, cy, solid] = adversarial(random);
    const auto outer = outer_interval(cx, cy, solid);
    const auto truth = exact_interval(cx, cy, solid);
    if (!truth) continue;
    ++hits;
    ASSERT_TRUE(outer) << "case " << n;
    ASSERT_LE(Q(outer->lo), truth->lo) << "case " << n;
    ASSERT_GE(Q(outer->hi), truth->hi) << "case " << n;
  }
}

void expect_holds_adversarial(Kernel kernel, int cases) {
  Random random(test_seed(503));
  Tally tally;
  for (int n = 0; more_cases(n, cases, tally.hits > 1000 && tally.misses > 1000); ++n) {
    const auto [cx, cy, solid] = adversarial(random);
    count(kernel, cx, cy, solid, tally);
    if (tally.violations != 0) {
      for (const auto& row : solid) std::printf("%a %a %a %a\n", row[0], row[1], row[2], row[3]);
      FAIL() << "case " << n << " at " << cx << ", " << cy;
    }
  }
  std::cout << tally.hits << " lines hit, " << tally.exact << " decided with rationals\n";
}

TEST(ObbKernel, HoldsTheExactIntervalOfAdversarialFloats) {
  expect_holds_adversarial(obb_fattener().solid.interval, trials(4'000'000));
}

// The latest entry and the earliest exit of all roundings that GLSL allows.
TEST(ObbKernel, HoldsTheExactIntervalOnTheWorstDevice) {
  expect_holds_adversarial(obb_fattener().solid.interval_worst, trials(1'000'000));
}

TEST(ObbKernel, WithoutWideningAdversarialFloatsAreMissed) {
  Random random(test_seed(503));
  Tally tally;
  for (int n = 0; more_cases(n, 0, tally.violations > 100, 200'000); ++n) {
    const auto [cx, cy, solid] = adversarial(random);
    count(without_widening, cx, cy, solid, tally);
  }
  std::cout << tally.violations << " of " << tally.hits << " lines violated\n";
}

/// Pixel centres in and around a polygon's box.
template <typename Visit>
void for_pixels(const Points& points, int most, Random& random, Visit visit) {
  Vec3 lo = points[0], hi = points[0];
  for (const Vec3& p : points) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
  for (int k = 0; k < most; ++k) {
    visit(static_cast<float>(std::floor(random.uniform(lo[0] - 3, hi[0] + 3)) + 0.5),
          static_cast<float>(std::floor(random.uniform(lo[1] - 3, hi[1] + 3)) + 0.5));
  }
}

TEST(ObbKernel, HoldsTheExactIntervalOfRealBoxes) {
  Random random(test_seed(504));
  Tally tally;
  for (int n = 0; more_cases(n, trials(60'000), tally.hits > 1000); ++n) {
    const Points points = random_points(random);
    const Solid solid = obb_of(points, 0.715);
    for_pixels(points, 12, random, [&](float cx, float cy) {
      count(obb_fattener().solid.interval, cx, cy, solid, tally);
    });
    ASSERT_EQ(tally.violations, 0) << "polygon " << n;
  }
}

// A kernel that always answers [zlo, zhi] would pass all of the above.
TEST(ObbKernel, IsNotAbsurdlyLooseOnOrdinaryBoxes) {
  Random random(506);
  std::vector<double> excess, relative;
  long hits = 0, sure_misses = 0, false_hits = 0;
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 at = random.cube(500);
    const Points points{at + random.cube(20), at + random.cube(20), at + random.cube(20)};
    const Solid solid = obb_of(points, 0.715);
    for_pixels(points, 20, random, [&](float cx, float cy) {
      float entry, exit;
      const bool hit = obb_fattener().solid.interval(cx, cy, solid, entry, exit);
      const auto outer = outer_interval(cx, cy, solid);
      if (!outer) {
        ++sure_misses;
        false_hits += hit;
        return;
      }
      ++hits;
      ASSERT_TRUE(hit);
      const double more = std::max(outer->lo - entry, exit - outer->hi);
      excess.push_back(more);
      relative.push_back(more / (outer->hi - outer->lo));
    });
  }
  const auto rank = [](std::vector<double>& values, double part) {
    const auto at = values.begin() + static_cast<long>(part * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  std::printf(
      "excess over the exact interval (px): median %.3g, 99.9%% %.3g, most %.3g; relative "
      "to its length: median %.3g\n%ld lines hit; %ld miss, %ld of them reported as hits\n",
      rank(excess, 0.5), rank(excess, 0.999), rank(excess, 1), rank(relative, 0.5), hits,
      sure_misses, false_hits);
  EXPECT_LT(rank(excess, 0.5), 1e-3);
  EXPECT_LT(rank(excess, 0.999), 0.1);
  EXPECT_GT(sure_misses, 50'000);
  EXPECT_LT(false_hits, sure_misses / 1000);
}

TEST(ObbSurface, IsAClosedSurfaceOfTwelveTriangles) {
  Random random(507);
  for (int n = 0; n < 500; ++n) {
    Patch patch;
    patch.count = 3;
    for (int i = 0; i < 3; ++i) patch.corners[i] = random.cube(100);
    Drawables out;
    out.mode = DepthMode::fixed;
    obb_surface_fattener().fatten(patch, 0.7072, {200, 200}, out);
    ASSERT_EQ(out.triangles.size(), 12u);
    // Every edge belongs to two triangles.
    std::vector<std::array<float, 6>> edges;
    for (const auto& t : out.triangles) {
      for (int i = 0; i < 3; ++i) {
        std::array<float, 3> a{t[4 * i], t[4 * i + 1], t[4 * i + 2]};
        const int j = (i + 1) % 3;
        std::array<float, 3> b{t[4 * j], t[4 * j + 1], t[4 * j + 2]};
        if (b < a) std::swap(a, b);
        edges.push_back({a[0], a[1], a[2], b[0], b[1], b[2]});
      }
    }
    std::ranges::sort(edges);
    ASSERT_EQ(edges.size(), 36u);
    for (std::size_t i = 0; i < 36; i += 2) ASSERT_EQ(edges[i], edges[i + 1]);
    ASSERT_EQ(std::unique(edges.begin(), edges.end()) - edges.begin(), 18);
  }
}

}  // namespace
}  // namespace farcull
