// The reliability lemmas on the real rasterizer.
#include "tests/lab/gl.h"
#include "tests/lab/lemmas.h"

namespace farcull {
namespace {

using lab::canvases;

TEST(GlLemma, Lemmas1And2HoldAtTheBudgetRadius) { lab::expect_lemmas(canvases(), trials(100'000)); }

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

LemmaSettings stored_settings(const std::string& generator, bool published) {
  LemmaSettings settings;
  settings.points = 400 * lemma_generators().size();
  settings.seed = lab::kSeed;
  settings.generator = generator;
  settings.stored = true;
  settings.radius = [published](const Budget& budget, double step) {
    return published ? published_radius(step) : budget.radius();
  };
  return settings;
}

// What the buffer holds, in either format and in windows as deep as they come.
TEST(GlLemma, DepthBuffersBoundAtTheBudgetRadius) {
  for (const DepthFormat format : {DepthFormat::float32, DepthFormat::fixed24}) {
    const lab::MakeCanvas make = canvases({.depth_format = format, .query = QueryMode::occlusion});
    for (const double depth : {128.0, 0x1p19}) {
      LemmaSettings settings = stored_settings("", false);
      settings.side = 508;
      settings.depth = depth;
      for (const LemmaRow& row : lemma_experiment(*make(obb_fattener()), obb_fattener(), settings))
        EXPECT_EQ(row.violations(), 0u) << row.generator;
      settings.radius = [](const Budget& budget, double) { return 0.9 * budget.radius(); };
      EXPECT_GT(lemma_total(lemma_experiment(*make(obb_fattener()), obb_fattener(), settings))
                    .violations(),
                0u)
          << "the twin at nine tenths of the budget must fail";
    }
  }
}

TEST(GlLemma, InterpolatedDepthFailsOnSteepEdgesAtThePublishedRadius) {
  for (const DepthFormat format : {DepthFormat::float32, DepthFormat::fixed24}) {
    const lab::MakeCanvas make = canvases({.depth_format = format, .query = QueryMode::occlusion});
    const Fattener surface = obb_surface_fattener();
    const LemmaSettings settings = stored_settings("steep at pixel corners", true);
    const LemmaRow row = lemma_experiment(*make(surface), surface, settings)[0];
    EXPECT_GT(row.not_bounding, 0u);
    EXPECT_GT(row.largest_steps, 100 * depth_rounding(24));
    // Computed in the fragment program it bounds wherever there is a sample.
    const LemmaRow computed = lemma_experiment(*make(obb_fattener()), obb_fattener(), settings)[0];
    EXPECT_EQ(computed.not_bounding, 0u);
  }
}

// Adding the slack rounds once more where it crosses 1/2.
TEST(GlLemma, ABufferHoldsTheSamplesUnderTheDepthMap) {
  const Fattener fattener = obb_fattener();
  for (const DepthFormat format : {DepthFormat::float32, DepthFormat::fixed24}) {
    const std::unique_ptr<Canvas> canvas =
        canvases({.depth_format = format, .query = QueryMode::occlusion})(fattener);
    lab::expect_held_under_map(*canvas, fattener, canvas->limits().depth_bits, kAskedBehind);
  }
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
