// The reliability lemmas on the real rasterizer.
#include "tests/lab/gl.h"
#include "tests/lab/lemmas.h"

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

TEST(GlLemma, ABufferHoldsTheSamplesUnderTheDepthMap) {
  const Window w = lab::window(64, 100);
  const std::vector<Patch> patches = {lab::patch({{-20, -20, -60}, {20, -10, 30}, {0, 25, 80}}),
                                      lab::patch({{-5, 0, 2}, {28, 3, 9}, {10, 30, -99}})};
  const Fattener fattener = obb_fattener();
  for (const DepthFormat format : {DepthFormat::float32, DepthFormat::fixed24}) {
    const std::unique_ptr<Canvas> canvas =
        canvases({.depth_format = format, .query = QueryMode::occlusion})(fattener);
    const Drawables drawables = lab::fattened(w, fattener, 0.72, patches);
    canvas->begin(w, drawables);
    const std::vector<Draw> draws = {{0, 0}, {1, 0}};
    for (const Verb verb : {Verb::store, Verb::ask}) {
      const std::vector<float> px = canvas->samples(verb, draws),
                               held = canvas->depths(verb, draws);
      int covered = 0;
      for (std::size_t i = 0; i < px.size(); ++i) {
        if (std::isnan(px[i])) {
          EXPECT_EQ(held[i], verb == Verb::store ? 1 : 0);
          continue;
        }
        ++covered;
        const bool ask = verb == Verb::ask;
        const double map =
            0.5 + static_cast<double>(px[i]) * depth_scale(w) + (ask ? kAskedBehind : 0);
        // Adding the slack rounds once more where it crosses 1/2.
        EXPECT_LE(std::abs(held[i] - map) * 0x1p24,
                  depth_rounding(canvas->limits().depth_bits) + (ask ? 1 : 0));
      }
      EXPECT_GT(covered, 500);
    }
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
