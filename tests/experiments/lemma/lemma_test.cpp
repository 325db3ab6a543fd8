// What the lemma experiment measures: one generator alone, and how large a violation is.
#include "experiments/lemma/lemma.h"
#include "offsets/offsets.h"

#include "experiments/studies/run_point.h"
#include "experiments/studies/run_studies.h"
#include "tests/lab/test.h"
#include "verify/exact_point.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

LemmaSettings settings_of(double factor, std::uint64_t points) {
  LemmaSettings settings;
  settings.points = points;
  settings.seed = 7;
  settings.radius = [factor](const Budget& budget, double) { return factor * budget.radius(); };
  return settings;
}

TEST(Lemma, OneGeneratorAloneHasThePointsThatItHasAmongAll) {
  const Fattener fattener = obb_fattener();
  WorstCanvas canvas(fattener.solid);
  LemmaSettings settings = settings_of(0.9, 6000);
  const std::vector<LemmaRow> all = lemma_experiment(canvas, fattener, settings);
  ASSERT_EQ(all.size(), lemma_generators().size());
  std::uint64_t violations = 0;
  for (const LemmaRow& row : all) {
    settings.generator = row.generator;
    const std::vector<LemmaRow> alone = lemma_experiment(canvas, fattener, settings);
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(alone[0].generator, row.generator);
    EXPECT_EQ(alone[0].points, row.points);
    EXPECT_EQ(alone[0].no_sample, row.no_sample) << row.generator;
    EXPECT_EQ(alone[0].not_bounding, row.not_bounding) << row.generator;
    EXPECT_EQ(alone[0].largest_px, row.largest_px) << row.generator;
    violations += row.violations();
  }
  EXPECT_GT(violations, 0u) << "rows without violations would agree whatever the points are";
  // The twin: another seed gives another row.
  settings.generator = "needles";
  settings.seed = 8;
  settings.points = 60'000;
  const LemmaRow other = lemma_experiment(canvas, fattener, settings)[0];
  settings.seed = 7;
  const LemmaRow same = lemma_experiment(canvas, fattener, settings)[0];
  EXPECT_NE(other.no_sample, same.no_sample);
  settings.generator = "knots";
  EXPECT_THROW(lemma_experiment(canvas, fattener, settings), std::logic_error);
}

TEST(ExactPoint, SaysHowFarASampleIsOutside) {
  // The middle of (0, 0, 1) and (0, 0, 2).
  const ExactPoint point = {{Vec3(0, 0, 1), Vec3(0, 0, 2), Vec3(0, 0, 2)}, {1, 1, 0}};
  EXPECT_EQ(beyond(point, 1.75f, 2.0f), 0.25);
  EXPECT_EQ(beyond(point, 1.0f, 1.25f), 0.25);
  EXPECT_EQ(beyond(point, 1.0f, 1.75f), -0.25);
  EXPECT_EQ(beyond(point, 1.5f, 1.5f), 0);
  EXPECT_TRUE(bounded(point, 1.5f, 1.5f));
  // The depth of the map is 1/2 + 1.5 / 8 = 11/16.
  EXPECT_EQ(beyond_stored(point, 0.75f, 0.75f, 0.125f), 1.0 / 16);
  EXPECT_EQ(beyond_stored(point, 0.5f, 0.625f, 0.125f), 1.0 / 16);
  EXPECT_EQ(beyond_stored(point, 0.6875f, 0.6875f, 0.125f), 0);
  // What underflows is still outside.
  const ExactPoint tiny = {{Vec3(0, 0, 0x1p-1074), Vec3::Zero(), Vec3::Zero()}, {1, 1023, 0}};
  EXPECT_FALSE(bounded(tiny, 0, 0));
  EXPECT_GT(beyond(tiny, 0, 0), 0);
}

// Gives each pixel near an element the element's own lowest and highest depth, moved inward by a
// number of depth steps: with elements of one depth and a radius of 0 that is the violation.
class ShiftedCanvas final : public Canvas {
 public:
  ShiftedCanvas(double steps, int depth_bits) : steps_(steps) {
    limits_.subpixel_bits = 8;
    limits_.depth_bits = depth_bits;
    limits_.max_resolution = 16370;
  }
  const RasterLimits& limits() const override { return limits_; }
  void begin(const Window& window, const Drawables& drawables) override {
    window_ = window;
    drawables_ = &drawables;
  }
  std::vector<std::uint8_t> run(const Pass&) override { return {}; }
  std::vector<float> samples(Verb verb, const std::vector<Draw>& draws) override {
    const double by = steps_ * depth_step(window_, limits_.depth_bits);
    return each(verb, draws, std::numeric_limits<float>::quiet_NaN(), [&](float z, double sign) {
      // Outward, so that the shift is never more than was asked for.
      const double wanted = z + sign * by;
      const float near = static_cast<float>(wanted);
      return sign * (near - wanted) > 0 ? std::nextafter(near, static_cast<float>(-sign * HUGE_VAL))
                                        : near;
    });
  }
  std::vector<float> depths(Verb verb, const std::vector<Draw>& draws) override {
    const float scale = depth_scale(window_);
    return each(verb, draws, verb == Verb::store ? 1.0f : 0.0f, [&](float z, double sign) {
      return static_cast<float>(0.5f + z * scale + sign * steps_ * 0x1p-24);
    });
  }

 private:
  template <class Moved>
  std::vector<float> each(Verb verb, const std::vector<Draw>& draws, float none, Moved moved) {
    std::vector<float> out(static_cast<std::size_t>(window_.width) * window_.height, none);
    for (const Draw& draw : draws) {
      const Proxy& p = drawables_->proxies[draw.element];
      const float z = verb == Verb::store ? p.solid[0][3] : p.solid[4][0];
      const auto [x0, x1] = std::minmax({p.corners[0], p.corners[2], p.corners[4], p.corners[6]});
      const auto [y0, y1] = std::minmax({p.corners[1], p.corners[3], p.corners[5], p.corners[7]});
      for (int y = static_cast<int>(std::floor(y0)); y <= static_cast<int>(y1); ++y) {
        for (int x = static_cast<int>(std::floor(x0)); x <= static_cast<int>(x1); ++x) {
          const std::size_t at = static_cast<std::size_t>(y + window_.height / 2) * window_.width +
                                 x + window_.width / 2;
          out[at] = moved(z, verb == Verb::store ? 1 : -1);
        }
      }
    }
    return out;
  }

  double steps_;
  RasterLimits limits_;
  Window window_;
  const Drawables* drawables_ = nullptr;
};

// Boxes without a radius, on rectangles that cover the pixels.
Fattener unfattened() {
  Fattener out = obb_fattener();
  out.fatten = [](const Patch& patch, double, const ProxyBounds& bounds, Drawables& drawables) {
    drawables.proxies.push_back(
        {proxy_rectangle(patch.points(), 1, bounds), obb_of(patch.points(), 0)});
  };
  return out;
}

LemmaRow shifted_row(double steps, bool stored, int depth_bits = 32) {
  ShiftedCanvas canvas(steps, depth_bits);
  LemmaSettings settings = settings_of(1, 1000 * lemma_generators().size());
  settings.generator = "exact pixel corners";  // segments of one depth
  settings.stored = stored;
  return lemma_experiment(canvas, unfattened(), settings)[0];
}

TEST(Lemma, MeasuresAShiftOfKSteps) {
  // The box's ends are a depth of at most 90 px rounded outward to float, by 2^-17 px at most. A
  // step of this window is 2^-24 / scale, scale <= 0.25 / 130, so over 2^-15 px: a quarter of a
  // step. Rounding the shifted sample outward takes another quarter.
  for (const double k : {1.0, 2.0, 10.0, 1000.0}) {
    const LemmaRow row = shifted_row(k, false);
    EXPECT_EQ(row.no_sample, 0u);
    EXPECT_EQ(row.not_bounding, row.points);
    EXPECT_LE(row.largest_steps, k);
    EXPECT_GE(row.largest_steps, k - 0.5);
    EXPECT_NEAR(row.largest_px, row.largest_steps * 0x1p-24 * 4 * 130, 1e-6 * row.largest_px);
  }
  const LemmaRow still = shifted_row(0, false);
  EXPECT_EQ(still.violations(), 0u);
  EXPECT_EQ(still.largest_px, 0);
}

TEST(Lemma, OfABufferARoundingIsNoViolationAndMoreIs) {
  // The map rounds to nearest here, by three quarters of a step at most, beside a whole shift and
  // the quarter of the ends.
  for (const int bits : {32, 24}) {
    const LemmaRow rounding = shifted_row(0, true, bits);
    EXPECT_EQ(rounding.violations(), 0u) << bits;
    EXPECT_GT(rounding.rounded, 0u) << bits;
    EXPECT_LE(rounding.largest_steps, depth_rounding(bits));
    for (const double k : {5.0, 1000.0}) {
      const LemmaRow row = shifted_row(k, true, bits);
      EXPECT_EQ(row.not_bounding, row.points) << bits;
      EXPECT_EQ(row.rounded, 0u);
      EXPECT_LE(row.largest_steps, k + 0.75);
      EXPECT_GE(row.largest_steps, k - 1);
    }
  }
  // The twin: what 24 bits may round is a violation of 32.
  EXPECT_EQ(shifted_row(2, true, 24).violations(), 0u);
  EXPECT_GT(shifted_row(2, true, 32).violations(), 0u);
}

TEST(Lemma, BuffersOfTheWorstCanvasBoundAtTheBudgetInDeepAndWideWindows) {
  const Fattener fattener = obb_fattener();
  for (const int bits : {32, 24}) {
    for (const double depth : {128.0, 0x1p19}) {
      WorstCanvas canvas(fattener.solid, {.depth_bits = bits});
      LemmaSettings settings = settings_of(1, 2400);
      settings.stored = true;
      settings.side = 1020;
      settings.depth = depth;
      for (const LemmaRow& row : lemma_experiment(canvas, fattener, settings)) {
        EXPECT_EQ(row.violations(), 0u) << row.generator;
        EXPECT_GE(row.points, 200u);
      }
      // The twin: half the radius does not.
      settings.radius = [](const Budget& budget, double) { return 0.5 * budget.radius(); };
      EXPECT_GT(lemma_total(lemma_experiment(canvas, fattener, settings)).violations(), 200u);
    }
  }
}

TEST(LemmaPoint, PromisesAtTheBudgetAndAViolationThereBreaksIt) {
  MeasurementContext lab("cpu");
  const auto at = [&](const RadiusRule& radius, DepthMode mode = DepthMode::fragment) {
    return stored(measure_lemma({.generator = "pixel corners",
                                 .points = 100,
                                 .worst = true,
                                 .radius = radius,
                                 .depth_mode = mode},
                                lab));
  };
  Measurement kept = at({});
  EXPECT_EQ(kept.counts["promises"], true);
  EXPECT_EQ(kept.counts["violations"], 0);
  EXPECT_FALSE(breaks_promise(kept));
  kept.counts["violations"] = 1;
  EXPECT_TRUE(breaks_promise(kept));
  EXPECT_EQ(at({.factor = 1.1}).counts["promises"], true);
  // The twin: nothing is promised below it, and what is violated breaks nothing.
  const Measurement half = at({.factor = 0.5});
  EXPECT_EQ(half.counts["promises"], false);
  EXPECT_GT(half.counts["violations"], 0);
  EXPECT_FALSE(breaks_promise(half));
  EXPECT_EQ(at({.published = true}).counts["promises"], false);
  EXPECT_EQ(at({}, DepthMode::fixed).counts["promises"], false);
}

TEST(LemmaScene, IsReadAsItWasWritten) {
  for (const LemmaScene& scene :
       {LemmaScene{"pixel corners", 400, 256}, LemmaScene{"edges at 45 degrees", 1, 0x1p20}}) {
    const LemmaScene again = parse_lemma_scene(scene.name());
    EXPECT_EQ(again.generator, scene.generator);
    EXPECT_EQ(again.points, scene.points);
    EXPECT_EQ(again.depth, scene.depth);
  }
  EXPECT_THROW(parse_lemma_scene("needles:100"), std::logic_error);
}

}  // namespace
}  // namespace farcull
