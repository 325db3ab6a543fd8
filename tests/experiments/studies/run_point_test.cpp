// That a point's row depends on the point alone, not on what the lab measured before, nor on which
// of several runs was looked at.
#include "experiments/studies/run_point.h"

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/studies/point.h"
#include "experiments/studies/study.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

PointResult measured(Lab& lab, const std::string& scene, Method method, int repeat = 1) {
  return measure_run(repeated(plain_point(NamedScene{scene}, method), repeat), lab);
}

TEST(RunPoint, DoesNotDependOnEarlierRunsOfTheSession) {
  Lab fresh("cpu");
  const PointResult first = measured(fresh, "far-apart", Method::far_pairs);
  Lab used("cpu");
  measured(used, "two-spheres", Method::far_pairs);
  const PointResult later = measured(used, "far-apart", Method::far_pairs);
  EXPECT_EQ(named(first.counts), named(later.counts));
  EXPECT_EQ(first.device, later.device);
}

// Whether the lists of i-collide are those of a run just before.
bool is_warm(Lab& lab) { return lab.session().sweep().find(lab.current()).counts.sorts == 0; }

TEST(RunPoint, StartsICollideWithoutListsEachTimeWhereNothingMoves) {
  Lab lab("cpu");
  const auto stages_of = [&](const RunPoint& point) {
    Record record;
    measure_run(point, lab, &record);
    std::string out;
    for (const Stage& stage : record.trace) out += name_of(stage) + ": " + reason_of(stage) + "\n";
    return out;
  };
  const RunPoint still = plain_point(NamedScene{"crowd"}, Method::i_collide);
  const std::string cold = stages_of(still);
  EXPECT_EQ(stages_of(still), cold);
  EXPECT_TRUE(is_warm(lab)) << "else nothing is there to be forgotten";
  EXPECT_EQ(stages_of(still), cold);
  // The twin: a point of a motion keeps the lists.
  RunPoint moving = still;
  moving.scene = MotionFrame{"crowd", 0, 2};
  const std::string first = stages_of(moving);
  EXPECT_NE(stages_of(moving), first);
  EXPECT_THROW(measure_run(repeated(moving, 2), lab), std::logic_error);
}

// Crossings at the corners of pixels: 0.9 of the radius loses some, the budget none. A method
// without a radius has nothing at risk of it.
TEST(RunPoint, OfScenesThatGoToAnExtremeSaysHowManyPairsAreAtRisk) {
  Lab lab("native");
  const auto counts_of = [&lab](RunPoint point) {
    point.scene = PixelCorners{};
    point.views = "z";
    point.resolution = 96;
    return std::get<RunCounts>(stability_study().measure(point, lab).counts);
  };
  const RunCounts far =
      counts_of({.method = Method::far, .offset = "obb", .radius = kBudgetRadius});
  EXPECT_EQ(far.missed, 0u);
  ASSERT_TRUE(far.at_risk.has_value());
  EXPECT_GT(*far.at_risk, 0u);
  EXPECT_FALSE(counts_of({.method = Method::cullide}).at_risk.has_value());
}

TEST(RunPoint, GivesTheSameCountsInEveryRepeat) {
  Lab lab("cpu");
  for (const Method method : {Method::far_pairs, Method::i_collide, Method::exact}) {
    EXPECT_EQ(named(measured(lab, "crowd", method, 3).counts),
              named(measured(lab, "crowd", method).counts));
  }
}

// The twin: each way in which two runs may differ is refused, and said.
TEST(RunPoint, RefusesRunsThatDiffer) {
  const PointKey point = key_of(plain_point(NamedScene{"crowd"}, Method::far_pairs));
  const Outcome good{.pairs = {{1, 2}, {3, 4}}, .counts = RunCounts{}, .device = "cpu"};
  EXPECT_NO_THROW(require_same(point, good, good));
  const auto said = [&](const Outcome& other) -> std::string {
    try {
      require_same(point, good, other);
    } catch (const Error& error) {
      EXPECT_EQ(error.where, describe(point));
      return error.reason;
    }
    return "nothing";
  };
  Outcome other = good;
  std::get<RunCounts>(other.counts).missed = 3;
  EXPECT_TRUE(has_text(said(other), "missed 0 and 3"));
  other = good;
  std::get<RunCounts>(other.counts).drawn = DrawnCounts{.queries = 7};
  EXPECT_TRUE(has_text(said(other), "queries none and 7"));
  other = good;
  other.pairs = {{1, 2}, {3, 5}};
  EXPECT_TRUE(has_text(said(other), "1 and 1 pairs"));
  other = good;
  other.device = "another";
  EXPECT_TRUE(has_text(said(other), "device cpu and another"));
}

}  // namespace
}  // namespace farcull
