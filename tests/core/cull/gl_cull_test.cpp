// The CULLIDE family on the real rasterizer: both kinds of query give the same answers with any
// primitive and either test, and Quick-CULLIDE is ahead of plain CULLIDE after every step.
#include "tests/lab/cull.h"
#include "tests/lab/gl.h"

namespace farcull {
namespace {

using lab::Drawing, lab::Trace;

Drawing on_gl(const Fattener& fattener, QueryMode query) {
  return {fattener, std::make_shared<GlCanvas>(lab::context(), fattener.mode, fattener.solid,
                                               GlCanvasOptions{.query = query})};
}

TEST(GlCull, BothKindsOfQueryGiveTheSameAnswers) {
  for (const Fattener& fattener :
       {raw_triangles(), obb_fattener(), minkowski_fattener(), obb_surface_fattener()}) {
    SCOPED_TRACE(fattener.name);
    const Drawing flags = on_gl(fattener, QueryMode::flags);
    const Drawing occlusion = on_gl(fattener, QueryMode::occlusion);
    std::size_t steps = 0;
    for (int n = 0; more_cases(n, trials(12, 6), steps > 200); ++n) {
      const bool self = n % 3 == 0;
      const Scene scene = lab::scene_of(lab::random_small(3000 + n, 60), self);
      CullSettings settings = lab::cull_settings(flags, "x,y,1:2:3", n % 2 ? 24 : 128);
      settings.self = self;
      for (const bool touching : {false, true}) {
        settings.touching = touching;
        for (const PassRule& rule : {kQuickRule, kPlainRule}) {
          const Trace a = lab::run_by(rule, scene, flags, settings);
          const Trace b = lab::run_by(rule, scene, occlusion, settings);
          ASSERT_EQ(a.steps.size(), b.steps.size());
          for (std::size_t i = 0; i < a.steps.size(); ++i)
            ASSERT_EQ(a.steps[i].bits, b.steps[i].bits) << n << ", " << a.steps[i].name;
          steps += a.steps.size();
        }
      }
    }
  }
}

// Two coplanar triangles: at one depth where they overlap, on any of the canvas's paths.
TEST(GlCull, TouchingContactsAreKeptOrIgnoredAsAsked) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (int i = 0; i < 2; ++i) {
    objects[i].push_back({Vec3(0, 0, 0.5), Vec3(1, 0.25 * i, 0.5), Vec3(0.25 * i, 1, 0.5)});
    for (const double z : {0.0, 1.0}) {
      const Vec3 corner(z, z, z);  // gives the view a depth
      objects[i].push_back({corner, corner, corner});
    }
  }
  const Scene scene = lab::scene_of(objects);
  const Fattener raw = raw_triangles();
  for (const QueryMode query : {QueryMode::flags, QueryMode::occlusion}) {
    const Drawing drawing = on_gl(raw, query);
    CullSettings settings = lab::cull_settings(drawing, "z", 64);
    EXPECT_EQ(lab::run_by(kQuickRule, scene, drawing, settings).result.live,
              (std::vector<std::uint32_t>{0, 3}));
    settings.touching = false;
    EXPECT_TRUE(lab::run_by(kQuickRule, scene, drawing, settings).result.live.empty());
  }
}

}  // namespace
}  // namespace farcull
