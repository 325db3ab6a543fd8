// The reliability lemmas, and FAR as a property, on the canvas on the cores of the CPU; and on the
// worst canvas that keeps the same promises.
#include "core/native/canvas.h"

#include "offsets/fit.h"
#include "tests/lab/far.h"
#include "tests/lab/lemmas.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

lab::MakeCanvas canvases(const NativeCanvasOptions& options = {}) {
  return [options](const Fattener& fattener) {
    return std::make_unique<NativeCanvas>(fattener.mode, fattener.solid, options);
  };
}

lab::MakeCanvas worst() {
  return [](const Fattener& fattener) {
    return std::make_unique<WorstCanvas>(fattener.solid, WorstCanvasOptions{.exact_samples = true});
  };
}

TEST(NativeLemma, Lemmas1And2HoldAtTheBudgetRadius) {
  lab::expect_lemmas(canvases(), trials(400'000));
}

TEST(NativeLemma, AndOnTheWorstCanvasThatKeepsItsPromises) { lab::expect_lemmas(worst(), 60'000); }

TEST(NativeLemma, ItsRadiusIsBelowThatOfOpenGl) {
  for (const int viewport : {64, 512, 4096, 16384}) {
    const Budget native = budget_for(native_limits(), viewport);
    const Budget gl = budget_for({.subpixel_bits = 8, .depth_bits = 32}, viewport);
    EXPECT_EQ(native.vertex, 0);
    EXPECT_EQ(native.snap, 0);
    EXPECT_LT(native.radius(), gl.radius()) << viewport;
  }
}

TEST(NativeLemma, LemmasFailWithoutTheSamplingTerm) {
  lab::expect_term_needed(canvases(), "sampling", 20'000);
  lab::expect_term_needed(worst(), "sampling", 20'000);
}
TEST(NativeLemma, LemmasFailWithoutTheDoubleTerm) {
  lab::expect_term_needed(canvases(), "double", 20'000);
  lab::expect_term_needed(worst(), "double", 20'000);
}
TEST(NativeLemma, LemmasFailWithoutTheInputTermOnTheWorstCanvas) {
  lab::expect_term_needed(worst(), "input", 400'000);
}

// Of edges from corner to corner of the window, the comparison in floats errs most: 3.01 sqrt(2) u
// M. Pixel centres whose diagonal is n / sqrt(2) px beside that of the window, and inside a
// rectangle whose edge is `inside` px farther out.
int uncovered_beside_long_edges(Canvas& canvas, double inside) {
  constexpr int kSide = 4092;
  const Window w = lab::window(kSide);
  int uncovered = 0;
  for (const int n : {1, 2, 5, 40}) {
    const double along = std::numbers::sqrt2 * (kSide / 2 - 60);
    const double across = n / std::numbers::sqrt2 + inside;
    Drawables drawables;
    Proxy proxy{};
    const double at[4][2] = {
        {-along, -across}, {along, -across}, {along, across}, {-along, across}};
    for (int i = 0; i < 4; ++i) {
      proxy.corners[2 * i] = static_cast<float>((at[i][0] - at[i][1]) / std::numbers::sqrt2);
      proxy.corners[2 * i + 1] = static_cast<float>((at[i][0] + at[i][1]) / std::numbers::sqrt2);
    }
    proxy.solid = obb_of(std::array{Vec3(-3000, -3000, 0), Vec3(3000, 3000, 0)}, 4000);
    drawables.proxies.push_back(proxy);
    drawables.first.push_back(1);
    canvas.begin(w, drawables);
    const std::vector<float> entries = canvas.samples(Verb::store, {{0, 0}});
    for (int k = 120; k + 120 < kSide; ++k) {
      uncovered += std::isnan(entries[static_cast<std::size_t>(k) * kSide + k + n]);
      uncovered += std::isnan(entries[static_cast<std::size_t>(k + n) * kSide + k]);
    }
  }
  return uncovered;
}

TEST(NativeLemma, LongEdgesCoverWhatTheInputTermAllows) {
  const double u_m = 0x1p-23 * 2048;  // of a viewport of 4096 px
  const double charged = budget_for(native_limits(), 4096).input;
  EXPECT_EQ(uncovered_beside_long_edges(*canvases()(obb_fattener()), charged), 0);
  EXPECT_EQ(uncovered_beside_long_edges(*worst()(obb_fattener()), charged), 0);
  // The twin: with the term of OpenGL, which pays for rounded corners alone.
  EXPECT_GT(uncovered_beside_long_edges(*worst()(obb_fattener()), std::numbers::sqrt2 * u_m), 100);
}

TEST(NativeLemma, Lemma1FailsAtNineTenthsOfTheBudget) {
  const auto radius = [](const Budget& b, double) { return 0.9 * b.radius(); };
  EXPECT_GT(lab::violation_rate(canvases(), "pixel corners", radius), 0.5);
}

// The published radius, 0.70711 px and a little, has the sampling term and nothing else; here
// nothing else moves a corner, so it takes the double term at its worst to break it.
TEST(NativeLemma, Lemma1FailsAtThePublishedRadiusWhereDoublesErr) {
  const auto radius = [](const Budget&, double step) { return published_radius(step); };
  const LemmaRow all =
      lemma_total(lab::lemma_rows(canvases(), obb_fattener(), 20'000, true, radius));
  EXPECT_GT(all.violations(), 0u);
}

TEST(NativeLemma, Theorem1IntersectingTrianglesSeeEachOther) {
  lab::expect_theorem1(canvases(), 20);
  lab::expect_theorem1(canvases({.depth_bits = 24}), 10);
}

TEST(NativeLemma, Corollary1UnseenMeansDisjoint) { lab::expect_corollary1(canvases(), 40); }

TEST(NativeFarProperty, NoFamilyOfExtremeScenesLosesAPair) {
  lab::expect_far_survives_all_families(
      canvases(), {.canvas = "native", .fixed = 30, .of_the_day = trials(60, 10)});
}
TEST(NativeFarProperty, NorOn24BitDepth) {
  lab::expect_far_survives_all_families(canvases({.depth_bits = 24}),
                                        {.canvas = "native24", .fixed = 12, .of_the_day = 5});
}
TEST(NativeFarProperty, KeptCasesStayMended) { EXPECT_GT(lab::replay_cases(canvases()), 0); }

}  // namespace
}  // namespace farcull
