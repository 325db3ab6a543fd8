// The reliability lemmas, and culling end to end, on the canvas that keeps the device assumptions
// and nothing more.
#include "verify/worst_canvas.h"

#include "tests/lab/far.h"
#include "tests/lab/lemmas.h"
#include "verify/exact_point.h"

namespace farcull {
namespace {

lab::MakeCanvas canvases(const WorstCanvasOptions& options = {}) {
  return [options](const Fattener& fattener) {
    return std::make_unique<WorstCanvas>(fattener.solid, options);
  };
}

TEST(WorstLemma, Lemmas1And2HoldAtTheBudgetRadius) { lab::expect_lemmas(canvases(), 60'000); }

TEST(WorstLemma, LemmasHoldForAnySubpixelGrid) {
  for (const int bits : {4, 6, 12}) {
    const auto budget = [](const Budget& b, double) { return b.radius(); };
    const auto rows =
        lab::lemma_rows(canvases({.subpixel_bits = bits}), obb_fattener(), 20'000, true, budget);
    EXPECT_EQ(lemma_total(rows).violations(), 0u) << bits;
  }
}

TEST(WorstLemma, Lemma1FailsAtNineTenthsOfTheBudget) {
  const auto radius = [](const Budget& b, double) { return 0.9 * b.radius(); };
  EXPECT_GT(lab::violation_rate(canvases(), "pixel corners", radius), 0.5);
}

TEST(WorstLemma, Lemma1FailsAtThePublishedRadiusNearPixelCorners) {
  const auto radius = [](const Budget&, double step) { return published_radius(step); };
  EXPECT_GT(lab::violation_rate(canvases(), "pixel corners", radius), 0.9);
}

TEST(WorstLemma, LemmasFailWithoutTheSamplingTerm) {
  lab::expect_term_needed(canvases(), "sampling", 20'000);
}
TEST(WorstLemma, LemmasFailWithoutTheInputTerm) {
  lab::expect_term_needed(canvases(), "input", 100'000);
}
TEST(WorstLemma, LemmasFailWithoutTheDoubleTerm) {
  lab::expect_term_needed(canvases(), "double", 20'000);
}
TEST(WorstLemma, ErrorsThatTurnEdgesAreTried) {
  lab::expect_turned_edges_noticed(canvases(), 24'000);
}
TEST(WorstLemma, LemmasFailWithoutTheVertexTerm) {
  lab::expect_term_needed(canvases(), "vertex", 20'000);
}
TEST(WorstLemma, LemmasFailWithoutTheSnapTerm) {
  lab::expect_term_needed(canvases(), "snap", 20'000);
}

TEST(WorstLemma, Theorem1IntersectingTrianglesSeeEachOther) {
  lab::expect_theorem1(canvases(), 6);
  lab::expect_theorem1(canvases({.depth_bits = 24}), 3);
}

TEST(WorstLemma, Corollary1UnseenMeansDisjoint) { lab::expect_corollary1(canvases(), 12); }

using lab::far_on;

TEST(WorstFar, MissesNothingOnRandomScenes) {
  std::uint64_t at_risk = 0;  // lost without a radius
  for (int n = 0; more_cases(n, trials(40), at_risk > 100); ++n) {
    const std::uint64_t seed = test_seed(static_cast<std::uint64_t>(n));
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = lab::random_scene(seed);
    const std::string views = n % 4 ? "x,y,z" : "1:2:0.5,-x";
    const int resolution = 1 + n * n % 61;
    for (const Fattener& fattener : lab::fatteners()) {
      WorstCanvas canvas(fattener.solid, {.depth_bits = n % 3 ? 32 : 24});
      const auto lost = [&](const Scene& of, double factor = 1) {
        return far_on(canvas, of, fattener, views, resolution, factor).accounting.false_negatives;
      };
      lab::expect_not([&](const Scene& of) { return lost(of) > 0; }, scene,
                      "worst-" + std::to_string(seed) + "-" + fattener.name,
                      "views " + views + " resolution " + std::to_string(resolution));
      if (at_risk <= 100) at_risk += lost(scene, 0);
    }
  }
}

TEST(WorstFar, MissesNothingOnHardScenesAndTheirCopiesElsewhere) {
  for (const char* name : {"degenerate", "needles", "far-apart", "ground"}) {
    for (const char* suffix : {"", "@far", "@tiny", "@huge"}) {
      SCOPED_TRACE(std::string(name) + suffix);
      const Scene scene = make_builtin_scene(std::string(name) + suffix);
      if (find_regions(scene).triangles.empty()) continue;  // nothing to draw
      const Fattener fattener = obb_fattener();
      WorstCanvas canvas(fattener.solid);
      EXPECT_EQ(far_on(canvas, scene, fattener, "x,y,z", 48).accounting.false_negatives, 0u);
    }
  }
}

TEST(WorstFar, UndrawableItemKeepsItsSmallPartner) {
  const Fattener fattener = obb_fattener();
  WorstCanvas canvas(fattener.solid);
  EXPECT_EQ(
      far_on(canvas, lab::undrawable_scene(), fattener, "1:1:1", 64).accounting.false_negatives,
      0u);
}

TEST(WorstFar, MissesPairsNearPixelCornersAtNineTenthsOfTheRadius) {
  const Scene scene = lab::corner_scene(128);
  for (const Fattener& fattener : lab::fatteners()) {
    WorstCanvas canvas(fattener.solid);
    EXPECT_EQ(far_on(canvas, scene, fattener, "z", 128).accounting.false_negatives, 0u);
    EXPECT_GT(far_on(canvas, scene, fattener, "z", 128, 0.9).accounting.false_negatives, 100u);
  }
}

TEST(WorstTouching, IsSeenWhereItCounts) {
  const Window window = lab::window(8, 100);
  const auto triangle = [](float z) {
    return std::array<float, 12>{-4, -4, z, 0, 12, -4, z, 0, -4, 12, z, 0};
  };
  for (const int bits : {32, 24}) {
    WorstCanvas canvas(obb_fattener().solid, {.depth_bits = bits});
    const auto is_seen = [&](float stored, float asked, bool touching) {
      Drawables drawables;
      drawables.mode = DepthMode::fixed;
      drawables.first = {0, 1, 2};
      drawables.triangles = {triangle(stored), triangle(asked)};
      return lab::is_seen(canvas, window, drawables, touching);
    };
    EXPECT_TRUE(is_seen(3, 3, true)) << bits;
    EXPECT_FALSE(is_seen(3, 3, false)) << bits;
    // The twins: a quarter of a pixel before, and behind.
    EXPECT_FALSE(is_seen(3, 2.75f, true)) << bits;
    EXPECT_TRUE(is_seen(3, 3.25f, false)) << bits;
  }
}

// ---- Which pixels a point lies in: pixels are closed squares, so a border belongs to both sides.

using Places = std::vector<std::pair<int, int>>;

// The pixels of a window of 4 x 2 px, whose middle is the origin, that contain the point;
// ascending.
Places places_of(const ExactPoint& point) {
  Places out;
  for (const Pixel& pixel : pixels_containing(point, 4, 2)) out.push_back({pixel.x, pixel.y});
  std::ranges::sort(out);
  return out;
}

ExactPoint at(double x, double y) {
  const Vec3 p(x, y, 7);
  return {{p, p, p}, {1, 0, 0}};
}

TEST(ExactPixels, ABorderBelongsToBothSidesAndACornerToFourPixels) {
  EXPECT_EQ(places_of(at(0.5, 0.5)), (Places{{2, 1}}));
  EXPECT_EQ(places_of(at(1, 0.5)), (Places{{2, 1}, {3, 1}}));
  EXPECT_EQ(places_of(at(0.5, 0)), (Places{{2, 0}, {2, 1}}));
  EXPECT_EQ(places_of(at(-1, 0)), (Places{{0, 0}, {0, 1}, {1, 0}, {1, 1}}));
}

TEST(ExactPixels, TheRimOfTheWindowBelongsToItAndNothingBeyond) {
  EXPECT_EQ(places_of(at(-2, -1)), (Places{{0, 0}}));
  EXPECT_EQ(places_of(at(2, 1)), (Places{{3, 1}}));
  EXPECT_TRUE(places_of(at(std::nextafter(2, 3), 0.5)).empty());
  EXPECT_TRUE(places_of(at(0.5, std::nextafter(-1, -2))).empty());
}

TEST(ExactPixels, NothingIsRounded) {
  // A third of 3 along x, then of the double below 3.
  const auto third = [](double x) {
    return ExactPoint{{Vec3(x, 0.5, 0), Vec3(0, 0.5, 0), Vec3(0, 0.5, 0)}, {7, 7, 7}};
  };
  EXPECT_EQ(places_of(third(3)), (Places{{2, 1}, {3, 1}}));
  EXPECT_EQ(places_of(third(std::nextafter(3, 0))), (Places{{2, 1}}));
}

}  // namespace
}  // namespace farcull
