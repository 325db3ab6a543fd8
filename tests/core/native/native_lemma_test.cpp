// The reliability lemmas, and FAR as a property, on the canvas on the cores of the CPU; and on the
// worst canvas that keeps the same promises.
#include "core/native/canvas.h"

#include "tests/lab/far.h"
#include "tests/lab/lanes.h"
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

TEST(NativeLemma, AndOnTheWorstCanvasThatKeepsItsPromises) {
  lab::expect_lemmas(worst(), trials(60'000));
}

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
  lab::expect_far_survives_all_families(canvases(), {.canvas = "native", .scenes = trials(90, 12)});
}
TEST(NativeFarProperty, NorOn24BitDepth) {
  lab::expect_far_survives_all_families(canvases({.depth_bits = 24}),
                                        {.canvas = "native24", .scenes = trials(20, 6)});
}
TEST(NativeFarProperty, KeptCasesStayMended) { EXPECT_GT(lab::replay_cases(canvases()), 0); }

// ---- What the canvas on the cores of the CPU does at the very borders: depths that are equal,
// depths of 24 bits, and corners that doubles know too badly.

/// A box over the whole window with these ends in depth (px), which are floats.
Proxy slice(float near, float far) {
  Proxy out{};
  out.corners = {-20, -20, 20, -20, 20, 20, -20, 20};
  out.solid = {{{0, 0, 0, near}, {1, 0, 0, 100}, {0, 1, 0, 100}, {0, 0, 1, 100}, {far, 0, 0, 0}}};
  return out;
}

// Two solids that share a depth and no more touch. FAR asks for that, since such triangles may
// meet.
TEST(NativeDepth, SolidsThatTouchAreSeenWhereTouchingCounts) {
  const Window window = lab::window(40, 100);
  Drawables drawables;
  drawables.first = {0, 1, 2};
  on_every_target([&] {
    for (const int bits : {32, 24}) {
      NativeCanvas canvas(DepthMode::fragment, obb_fattener().solid, {.depth_bits = bits});
      drawables.proxies = {slice(3, 9), slice(-5, 3)};
      EXPECT_TRUE(lab::is_seen(canvas, window, drawables, true)) << bits;
      EXPECT_FALSE(lab::is_seen(canvas, window, drawables, false)) << bits;
      // The twins: a quarter of a pixel less, or more.
      drawables.proxies[1] = slice(-5, 2.75f);
      EXPECT_FALSE(lab::is_seen(canvas, window, drawables, true)) << bits;
      drawables.proxies[1] = slice(-5, 3.25f);
      EXPECT_TRUE(lab::is_seen(canvas, window, drawables, false)) << bits;
    }
  });
}

// depth_rounding() (core/canvas/canvas.h) counts half a step for it.
TEST(NativeDepth, TwentyFourBitsHoldTheNearestStep) {
  const Window window = lab::window(40, 100);
  const Fattener raw = raw_triangles();
  const Drawables drawables = lab::fattened(
      window, raw, 0, {{lab::patch({Vec3(-19, -18, -71), Vec3(19, -17, 23), Vec3(1, 19, 88)})}});
  constexpr float kTop = 0x1p24f - 1;
  on_every_target([&] {
    const auto depths = [&](int bits) {
      NativeCanvas canvas(DepthMode::fixed, {}, {.depth_bits = bits});
      canvas.begin(window, drawables);
      return canvas.depths(Verb::store, {{0, 0}});
    };
    const std::vector<float> fine = depths(32), held = depths(24);
    int covered = 0, cut_differs = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      if (fine[i] == 1) continue;
      ++covered;
      EXPECT_EQ(held[i], std::nearbyint(fine[i] * kTop) / kTop);
      cut_differs += held[i] != std::floor(fine[i] * kTop) / kTop;
    }
    EXPECT_GT(covered, 500);
    EXPECT_GT(cut_differs, 30) << "the twin: steps that are cut off";
  });
}

// A corner may lie inside the region of a window although its image is known too badly to be drawn.
// Then the lanes leave its triangle to the scalar text, which says that it cannot be drawn.
TEST(NativeDepth, LanesLeaveOutWhatDoublesKnowTooBadly) {
  Window window = lab::window(40, 100);
  window.view = parse_view("1:1:0");
  window.map = window.view.rows;
  const Vec3 right = window.view.rows.row(0), up = window.view.rows.row(1),
             depth = window.view.rows.row(2);
  // A triangle of a pixel's size whose image lies at (reach, reach, reach), in px.
  const auto scene_at = [&](double reach) {
    Scene scene;
    const Vec3 far = reach * (right + up + depth);
    scene.vertices = {far, far + right, far + up};
    scene.triangles = {{0, 1, 2}};
    scene.objects = {{.name = "far", .first_triangle = 0, .triangle_count = 1}};
    return scene;
  };
  window.lo = Vec3::Constant(-0x1p50);
  window.hi = Vec3::Constant(0x1p50);
  on_every_target([&] {
    for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
      const auto undrawable = [&](double reach) {
        FattenCounts counts;
        const std::vector<std::uint32_t> items = {0};
        const Drawables out = fatten(scene_at(reach), items, window, fattener, 0.72, counts);
        EXPECT_EQ(out.undrawable.size() + out.proxies.size(), 1u);
        return !out.undrawable.empty();
      };
      // The error is 2^-50 of the terms, the limit 2^-10 px.
      EXPECT_TRUE(undrawable(0x1p44));
      EXPECT_FALSE(undrawable(0x1p34)) << "the twin: known well enough";
    }
  });
}

}  // namespace
}  // namespace farcull
