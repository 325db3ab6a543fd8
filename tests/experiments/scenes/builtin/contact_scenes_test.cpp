// The scenes of things in contact: their sizes, the shapes of their triangles, and what collides in
// them, decided exactly.
#include <gmpxx.h>
#include <Eigen/Geometry>

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Make = BuiltScene (*)(const SceneParameters&, std::uint64_t);

Scene of(Make make, std::uint64_t size, std::uint64_t seed) {
  return make({.size = size}, seed).scene;
}

double longest_side(const std::array<Vec3, 3>& t) {
  return std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
}

// Height over the longest side.
double thickness(const std::array<Vec3, 3>& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).norm() / (longest_side(t) * longest_side(t));
}

TEST(ContactScenes, HaveTheSizeOfTheirNameAndFollowTheirSeed) {
  const std::map<std::string, Make> makers = {{"crumpled", make_crumpled},
                                              {"spheres", make_spheres},
                                              {"cad-cut", make_cad_cut},
                                              {"funnel", make_funnel}};
  for (const auto& [name, make] : makers) {
    const BuiltinScene& entry = *find_builtin_scene(name);
    for (const std::uint64_t size :
         {entry.size->least, std::uint64_t{12'000}, std::uint64_t{50'000}}) {
      SCOPED_TRACE(name + ":" + std::to_string(size));
      const Scene scene = of(make, size, *entry.seed);
      EXPECT_NO_THROW(validate(scene, name));
      EXPECT_NEAR(static_cast<double>(scene.triangles.size()), static_cast<double>(size),
                  0.1 * static_cast<double>(size));
      EXPECT_EQ(scene_hash(scene),
                scene_hash(make_builtin_scene(name + ":" + std::to_string(size))));
      EXPECT_NE(scene_hash(scene), scene_hash(of(make, size, 1)));
      double thinnest = 1;
      for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
        thinnest = std::min(thinnest, thickness(scene.corners(t)));
      EXPECT_GT(thinnest, 1e-6) << "degenerate";
    }
  }
}

// ---- The scenes that go to an extreme by a number are what their number says, measured.

// Where the coordinates are below 2, the nearest doubles to a triangle are within 2^-53 in each,
// and an operation or two before them may double that: its height is within 8 * 2^-52 of what was
// meant.
constexpr double kHeightError = 8 * 0x1p-52;

TEST(ExtremeScenes, SliversHaveTheAspectOfTheirName) {
  for (const double aspect : {2.0, 1e3, 1e6, 1e9, 1e12}) {
    const Scene scene = make_slivers({.size = 50, .second = aspect}, 14).scene;
    EXPECT_EQ(scene.triangles.size(), 100u);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const auto c = scene.corners(t);
      const double side = longest_side(c);
      const double height = (c[1] - c[0]).cross(c[2] - c[0]).norm() / side;
      EXPECT_NEAR(side, 1, kHeightError);
      EXPECT_NEAR(height, 1 / aspect, kHeightError) << aspect;
    }
    // Three in four were made to cross.
    const std::size_t colliding = all_colliding_pairs(scene, {}).pairs.size();
    EXPECT_GE(colliding, 30u) << aspect;
  }
  // The twin: another aspect is told from the one that was asked for.
  const Scene other = make_slivers({.size = 1, .second = 1000}, 14).scene;
  const auto c = other.corners(0);
  EXPECT_GT(std::abs((c[1] - c[0]).cross(c[2] - c[0]).norm() - 1 / 1001.0), kHeightError);
}

TEST(ExtremeScenes, StacksAreExactTranslatesByTheirGap) {
  for (const double wanted : {0.1, 1e-3, 1e-9, 1e-14}) {
    const double gap = stack_gap(wanted);
    EXPECT_LE(std::abs(std::log2(gap / wanted)), 0.5 + 1e-9);
    const Scene scene = make_stack({.size = 1000, .second = wanted}).scene;
    const std::size_t each = scene.vertices.size() / 1000;
    std::size_t exact = 0;
    for (std::size_t s = 1; s < 1000; ++s) {
      for (std::size_t v = 0; v < each; ++v) {
        const Vec3& above = scene.vertices[s * each + v];
        const Vec3& below = scene.vertices[(s - 1) * each + v];
        ASSERT_EQ(above.x(), below.x());
        ASSERT_EQ(above.y(), below.y());
        if (s % 4 == 3 || (s - 1) % 4 == 3) continue;
        ASSERT_EQ(mpq_class(above.z()) - mpq_class(below.z()), mpq_class(gap)) << wanted;
        ++exact;
      }
    }
    EXPECT_EQ(exact, 500 * each);  // two in four are next to a crossing one, below or above
  }
}

TEST(ExtremeScenes, OfAStackOnlyTheCrossingSheetsCollide) {
  for (const char* name : {"stack:8:0.1", "stack:8:1e-6", "stack:8:1e-14"}) {
    const Scene scene = make_builtin_scene(name);
    const std::vector<std::uint32_t> owner = owners(scene);
    const auto pairs = all_colliding_pairs(scene, {}).pairs;
    EXPECT_GT(pairs.size(), 50u) << name;
    for (const TrianglePair& pair : pairs) {
      const std::uint32_t a = owner[pair.a], b = owner[pair.b];
      EXPECT_TRUE(a % 4 == 3 || b % 4 == 3) << name;
      EXPECT_EQ(std::max(a, b) - std::min(a, b), 1u) << name;
    }
  }
}

TEST(ExtremeScenes, MixedSizesHaveTheRatioOfTheirName) {
  for (const double ratio : {1.0, 1e3, 1e6, 1e12}) {
    const Scene scene = make_mixed({.size = 20, .second = ratio}, 15).scene;
    ASSERT_EQ(scene.objects.size(), 2u);
    const Object& small = scene.objects[1];
    EXPECT_EQ(small.triangle_count, 160u);
    for (std::uint32_t t = 0; t < small.triangle_count; ++t) {
      EXPECT_NEAR(longest_side(scene.corners(small.first_triangle + t)), 1 / ratio, kHeightError);
      EXPECT_NEAR(longest_side(scene.corners(t % 20)), 1, kHeightError);
    }
    // Every other small one is pierced; at a ratio of 1 they meet others by chance.
    const std::size_t colliding = all_colliding_pairs(scene, {}).pairs.size();
    if (ratio >= 1e3) {
      EXPECT_GE(colliding, 75u) << ratio;
      EXPECT_LE(colliding, 85u) << ratio;
    }
  }
}

// By exact rationals: how far the upper triangle of a pair stands above the lower one, in ulps.
mpq_class ulps_between(const Scene& scene, std::uint32_t pair) {
  const std::uint32_t count = scene.objects[0].triangle_count;
  const auto lower = scene.corners(pair), upper = scene.corners(count + pair);
  const int axis = static_cast<int>(pair % 3);
  // Less the slope: a quarter and an eighth of the way from the corner of its cell, 1/16 wide.
  const auto height = [axis](const Vec3& p) -> mpq_class {
    const auto way = [&p](int k) -> mpq_class {
      return mpq_class(p[k] - 0.5) - mpq_class(std::floor((p[k] - 0.5) * 16) / 16);
    };
    return mpq_class(mpq_class(p[axis]) - way((axis + 1) % 3) / 4 - way((axis + 2) % 3) / 8);
  };
  mpq_class top = height(lower[0]), bottom = height(upper[0]);
  for (const Vec3& p : lower) top = std::max(top, height(p));
  for (const Vec3& p : upper) bottom = std::min(bottom, height(p));
  return (bottom - top) * mpq_class(mpz_class(1) << 53);
}

TEST(ExtremeScenes, GapsAreTheirNumberOfUlpsAndCollideFromNoneOn) {
  for (const double ulps : {1.0, 2.0, 1e6, 1e12, 1e13, 0.0, -1.0, -3.0, -1e6, -1e13}) {
    const Scene scene = make_gap({.size = 216, .second = ulps}).scene;
    EXPECT_NO_THROW(validate(scene, "gap"));
    for (const Vec3& p : scene.vertices) {
      EXPECT_GE(p.minCoeff(), 0.5);
      EXPECT_LT(p.maxCoeff(), 1);
    }
    for (std::uint32_t i = 0; i < 216; ++i) ASSERT_EQ(ulps_between(scene, i), mpq_class(ulps));
    const auto pairs = all_colliding_pairs(scene, {}).pairs;
    EXPECT_EQ(pairs.size(), ulps > 0 ? 0u : 216u) << ulps;
    for (const TrianglePair& pair : pairs) EXPECT_EQ(pair.b, pair.a + 216);
  }
  // The largest as well: pairs in 16^3 cells, as far apart as the number goes.
  EXPECT_EQ(all_colliding_pairs(make_gap({.size = 4096, .second = -1e13}).scene, {}).pairs.size(),
            4096u);
  EXPECT_EQ(all_colliding_pairs(make_gap({.size = 4096, .second = 1e13}).scene, {}).pairs.size(),
            0u);
}

}  // namespace
}  // namespace farcull
