// FAR as a property on the real rasterizer.
#include "tests/core/cull/far_properties.h"
#include "tests/core/gl/gl_lab.h"

namespace farcull {
namespace {

lab::MakeCanvas canvases(const GlCanvasOptions& options = {}) {
  return [options](const Fattener& fattener) {
    return std::make_unique<GlCanvas>(lab::context(), fattener.mode, fattener.solid, options);
  };
}

TEST(GlFarProperty, NoFamilyOfExtremeScenesLosesAPair) {
  lab::expect_far_survives_all_families(canvases(),
                                        {.canvas = "gl", .fixed = 30, .of_the_day = 30});
}

TEST(GlFarProperty, NorWithOcclusionQueriesOn24BitDepth) {
  lab::expect_far_survives_all_families(
      canvases({.depth_format = DepthFormat::fixed24, .query = QueryMode::occlusion}),
      {.canvas = "gl24", .fixed = 8, .of_the_day = 4});
}

TEST(GlFarProperty, KeptCasesStayMended) { EXPECT_GT(lab::replay_cases(canvases()), 0); }

}  // namespace
}  // namespace farcull
