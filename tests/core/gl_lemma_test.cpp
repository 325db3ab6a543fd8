// The reliability lemmas on the real rasterizer.
#include "tests/core/gl_lab.h"
#include "tests/core/lemma_suite.h"

namespace farcull {
namespace {

lab::MakeCanvas canvases(const GlCanvasOptions& options = {}) {
  return [options](const Fattener& fattener) {
    return std::make_unique<GlCanvas>(lab::context(), fattener.mode, fattener.solid, options);
  };
}

TEST(GlLemma, Lemmas1And2HoldAtTheBudgetRadius) { lab::expect_lemmas(canvases(), 100'000); }

TEST(GlLemma, Lemma1FailsAtNineTenthsOfTheBudget) {
  const auto radius = [](const Budget& b, double) { return 0.9 * b.radius(); };
  EXPECT_GT(lab::violation_rate(canvases(), "pixel corners", radius), 0.5);
}

TEST(GlLemma, Lemma1FailsAtThePublishedRadiusNearPixelCorners) {
  const auto radius = [](const Budget&, double step) { return published_radius(step); };
  EXPECT_GT(lab::violation_rate(canvases(), "pixel corners", radius), 0.05);
}

TEST(GlLemma, LemmasFailWithoutTheSamplingTerm) {
  lab::expect_term_needed(canvases(), "sampling", 20'000);
}

TEST(GlLemma, LemmasFailWithoutTheSnapTerm) {
  lab::expect_term_needed(canvases(), "snap", 100'000);
}

TEST(GlLemma, Theorem1IntersectingTrianglesSeeEachOther) {
  lab::expect_theorem1(canvases(), 20);
  lab::expect_theorem1(canvases({.query = QueryMode::occlusion}), 5);
  lab::expect_theorem1(
      canvases({.depth_format = DepthFormat::fixed24, .query = QueryMode::occlusion}), 5);
}

TEST(GlLemma, Corollary1UnseenMeansDisjoint) { lab::expect_corollary1(canvases(), 40); }

}  // namespace
}  // namespace farcull
