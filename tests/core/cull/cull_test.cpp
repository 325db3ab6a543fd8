// Culling on a canvas without errors, judged by the independent accounting: whatever was culled
// must be harmless.
#include "core/cull/cull.h"

#include "core/boxes/join.h"
#include "experiments/record/stage_words.h"
#include "offsets/offsets.h"
#include "tests/lab/canvas.h"
#include "tests/lab/rational.h"
#include "tests/lab/reference.h"
#include "verify/accounting.h"

namespace farcull {
namespace {

using rational::Random, reference::Triangle;
using Objects = std::vector<std::vector<Triangle>>;
using Indices = std::vector<std::uint32_t>;

CullSettings settings_for(const std::string& views, int resolution, bool economy = true) {
  CullSettings settings;
  settings.views = parse_views(views);
  settings.resolution = resolution;
  settings.fattener = obb_fattener();
  settings.quick = economy;
  return settings;
}

CullResult cull_ideally(const Scene& scene, const CullSettings& settings,
                        CanvasFault fault = CanvasFault::none) {
  IdealCanvas canvas(settings.fattener.solid, fault);
  return cull(scene, find_regions(scene), settings, canvas);
}

Accounting accounting_of(const Scene& scene, const Indices& live) {
  return account(scene, box_join(triangle_boxes(scene), owners(scene), live));
}

std::uint64_t missed(const Scene& scene, const CullSettings& settings,
                     CanvasFault fault = CanvasFault::none) {
  return accounting_of(scene, cull_ideally(scene, settings, fault).live).false_negatives;
}

/// Objects of small triangles that touch, cross, pass closely, or do not meet.
Objects random_objects(Random& random) {
  Objects objects(2 + random.below(4));
  const bool grid = random.coin();
  const double spread = random.uniform(0.3, 3);
  for (auto& triangles : objects) {
    triangles.resize(random.below(12));
    const Vec3 at = random.cube(spread);
    for (Triangle& t : triangles) {
      const Vec3 base = at + random.cube(1);
      const double size = std::exp2(random.uniform(-6, 1));
      for (Vec3& p : t) {
        p = base + random.cube(size);
        if (grid) p = (p * 4).array().round() / 4;  // shared corners, coplanar overlaps
      }
      if (random.below(8) == 0) t[2] = t[1];
      if (random.below(16) == 0) t[0] = t[1] = t[2];
      if (random.below(12) == 0) t[0] += random.cube(20);  // needle
    }
  }
  // Contacts that hold exactly: a corner of one on a corner of another, which is then half a pixel
  // or less away at every resolution.
  for (std::size_t o = 1; o < objects.size(); ++o)
    if (!objects[o].empty() && !objects[o - 1].empty() && random.coin())
      objects[o][0][random.below(3)] = objects[o - 1].back()[random.below(3)];
  return objects;
}

constexpr const char* kViews[] = {"z", "x", "-y", "x,y,z", "z,-z", "1:1:1", "1:-2:0.5,y", "3:4:0"};

TEST(Cull, NothingThatCollidesIsCulled) {
  Random random(601);
  std::uint64_t colliding = 0, culled = 0;
  for (int n = 0; n < 1500; ++n) {
    const Objects objects = random_objects(random);
    const Scene scene = reference::scene_of(objects);
    const std::string views = kViews[random.below(8)];
    const int resolution = random.below(3) == 0 ? 1 + random.below(4) : 1 + random.below(64);
    const CullSettings settings = settings_for(views, resolution, random.coin());
    const CullResult result = cull_ideally(scene, settings);
    const Accounting accounting = accounting_of(scene, result.live);
    ASSERT_TRUE(accounting.adds_up());
    ASSERT_EQ(accounting.false_negatives, 0u)
        << "scene " << n << ", views " << views << " at " << resolution;
    ASSERT_TRUE(std::ranges::is_sorted(result.live));
    colliding += accounting_of(scene, {}).false_negatives;
    culled += scene.triangles.size() - result.live.size();
  }
  EXPECT_GT(colliding, 2000u);
  EXPECT_GT(culled, 5000u);
  std::cout << colliding << " colliding pairs kept, " << culled << " triangles culled\n";
}

// ---- items beyond the budget ----

/// A triangle 1e20 times the region through the origin, and small ones: one through it, one apart.
Objects with_undrawable() {
  const Triangle huge = {Vec3(-1e20, -1e20, 0), Vec3(1e20, -1e20, 0), Vec3(0, 1e20, 0)};
  const Triangle through = {Vec3(0, 0, -1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  return {{huge}, {through}};
}

TEST(Cull, AnUndrawableItemKeepsItsPartner) {
  for (const char* views : {"z", "-z", "x", "1:1:1", "x,y,z"}) {
    for (const bool economy : {true, false}) {
      for (const int resolution : {1, 8, 64}) {
        Objects objects = with_undrawable();
        for (int order = 0; order < 2; ++order) {
          const CullResult result =
              cull_ideally(reference::scene_of(objects), settings_for(views, resolution, economy));
          ASSERT_EQ(result.live, (Indices{0, 1})) << views << " at " << resolution;
          std::ranges::reverse(objects);
        }
      }
    }
  }
}

// ---- twins that must fail: the oracle sees what each rule of the canvas is for ----

// In the middle of a region that is 2^26 px deep, the floats of the depth map are 8 px apart: two
// triangles in one plane are then seen by "at or behind" only. The points span the region.
Scene deep_scene(double z) {
  const auto flat = [z](double x) {
    return Triangle{Vec3(x, 0.4, z), Vec3(x + 0.1, 0.4, z), Vec3(x, 0.5, z)};
  };
  const auto point = [](const Vec3& p) { return Triangle{p, p, p}; };
  constexpr double kFar = 0x1p19;
  return reference::scene_of({{flat(0.4), point({0, 0, -kFar}), point({1, 1, kFar})},
                              {flat(0.42), point({0, 1, -kFar}), point({1, 0, kFar})}});
}

TEST(Cull, GreaterInsteadOfGreaterOrEqualMisses) {
  std::uint64_t lost = 0;
  for (int n = 0; n < 64; ++n) {
    const Scene scene = deep_scene(0.01 * n);
    EXPECT_EQ(missed(scene, settings_for("z", 64)), 0u);
    lost += missed(scene, settings_for("z", 64), CanvasFault::greater);
  }
  EXPECT_GT(lost, 0u);
}

TEST(Cull, ALostStoreMisses) {
  const Scene scene = reference::scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                                           {{Vec3(0, 0, 0), Vec3(1, 0, 1), Vec3(0, 1, 1)}}});
  EXPECT_EQ(missed(scene, settings_for("z", 16)), 0u);
  EXPECT_EQ(missed(scene, settings_for("z", 16), CanvasFault::drops_first_store), 1u);
}

TEST(Cull, ForgettingUndrawableItemsMisses) {
  Objects objects = with_undrawable();
  for (int order = 0; order < 2; ++order) {
    const Scene scene = reference::scene_of(objects);
    EXPECT_EQ(missed(scene, settings_for("z", 16)), 0u);
    EXPECT_EQ(missed(scene, settings_for("z", 16), CanvasFault::nothing_everywhere), 1u);
    std::ranges::reverse(objects);
  }
}

// Without fattening, contacts between pixel centres are lost: the oracle sees that, too.
TEST(Cull, ATenthOfTheRadiusMisses) {
  Random random(607);
  std::uint64_t lost = 0;
  for (int n = 0; n < 300; ++n) {
    const Scene scene = reference::scene_of(random_objects(random));
    CullSettings settings = settings_for("z", 12);
    EXPECT_EQ(missed(scene, settings), 0u);
    settings.radius.factor = 0.1;
    lost += missed(scene, settings);
  }
  EXPECT_GT(lost, 10u);
}

// ---- what is left out, and why ----

TEST(Cull, RefusesAResolutionBeyondTheDevice) {
  const Scene scene = reference::scene_of(with_undrawable());
  EXPECT_THROW(cull_ideally(scene, settings_for("z", 0)), Error);
  EXPECT_THROW(cull_ideally(scene, settings_for("z", -5)), Error);
  EXPECT_THROW(cull_ideally(scene, settings_for("z", 4097)), Error);
}

TEST(Cull, AViewThatDoublesCannotResolveCullsNothing) {
  const double far = DBL_MAX;
  const Triangle a = {Vec3(-far, -far, -far), Vec3(far, far, far), Vec3(far, -far, 0)};
  const Scene scene = reference::scene_of({{a}, {a}});
  const CullResult result = cull_ideally(scene, settings_for("z,1:1:1", 8));
  EXPECT_EQ(result.live, (Indices{0, 1}));
  for (const ViewReport& view : result.views) EXPECT_FALSE(view.drawn);
  ASSERT_EQ(result.stages.size(), 2u);
  EXPECT_TRUE(has_text(reason_of(result.stages[0]), "nothing is culled"));
}

TEST(Cull, ReportsWhatItDrew) {
  const Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0.1, 0.5)};
  const Triangle high = {Vec3(0, 0, 0.5), Vec3(1, 0, 9), Vec3(0, 0.1, 9)};
  CullSettings settings = settings_for("z", 32);
  const Scene scene = reference::scene_of({{t}, {high}});
  const CullResult result = cull_ideally(scene, settings);
  ASSERT_EQ(result.views.size(), 1u);
  const ViewReport& view = result.views[0];
  EXPECT_TRUE(view.drawn);
  EXPECT_GT(view.width, 32);
  EXPECT_EQ(view.radius_px, view.budget.radius());
  ASSERT_GT(view.width, 2 * view.height);  // the budget is that of the longer side
  const RasterLimits limits{.subpixel_bits = 8, .depth_bits = 32, .max_resolution = 4096};
  EXPECT_EQ(view.radius_px, budget_for(limits, viewport_side(view.width)).radius());
  EXPECT_GT(view.depth_step_px, 0);
  ASSERT_GE(result.stages.size(), 3u);
  EXPECT_EQ(name_of(result.stages[0]), "fatten z, round 1");
  EXPECT_EQ(name_of(result.stages[1]), "cull objects z, round 1");
  EXPECT_EQ(name_of(result.stages[2]), "cull triangles z, round 1");
  EXPECT_GT(result.stages[1].queries, 0u);
  settings.radius = {.published = true, .factor = 1};
  EXPECT_EQ(cull_ideally(scene, settings).views[0].radius_px, published_radius(view.depth_step_px));
}

}  // namespace
}  // namespace farcull
