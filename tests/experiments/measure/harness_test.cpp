#include "experiments/measure/harness.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

TEST(Harness, RunsAllContestantsInTurnAfterTheWarmUp) {
  std::string order;
  const std::vector<Timed> timed =
      measure_in_turns(2, {.warm_up = 1, .counted = 2}, [&](std::size_t i, int round) {
        order += std::to_string(i) + ":" + std::to_string(round) + " ";
        return 10.0 * static_cast<double>(i) + round;
      });
  EXPECT_EQ(order, "0:-1 1:-1 0:0 1:0 0:1 1:1 ");
  ASSERT_EQ(timed.size(), 2u);
  EXPECT_EQ(timed[1].ms, (std::vector<double>{10, 11}));
  EXPECT_EQ(timed[1].warm_up_ms, 9);
  EXPECT_FALSE(timed[0].peak_mib);
}

TEST(Harness, TakesTheMeanOfTwoMiddleValuesAndTheFasterOfTwoMiddleRuns) {
  EXPECT_EQ(spread_of({4, 1, 2, 9}).median, 3);
  EXPECT_EQ(spread_of({4, 1, 2, 9}).min, 1);
  EXPECT_EQ(spread_of({4, 1, 2, 9}).max, 9);
  EXPECT_EQ(spread_of({4, 1, 2, 9}).n, 4u);
  EXPECT_EQ(spread_of({}).median, 0);
  EXPECT_EQ(median_run({4, 1, 2, 9}), 2u);
  EXPECT_EQ(median_run({7}), 0u);
}

TEST(MeasurementContext, ReadsAMotionAnewWhereItHasOtherFrames) {
  MeasurementContext lab("cpu");
  const auto hash = [&](long frames) { return scene_hash(lab.scene("crowd:30", 1, frames)); };
  const std::string of4 = hash(4), of12 = hash(12);
  EXPECT_EQ(hash(4), of4);
  MeasurementContext fresh("cpu");
  EXPECT_EQ(scene_hash(fresh.scene("crowd:30", 1, 12)), of12);
  EXPECT_NE(of4, of12) << "else it would not matter";
}

TEST(MeasurementContext, TheTruthIsWithoutWhatTheSceneIgnores) {
  MeasurementContext lab("cpu");
  Scene scene = make_builtin_scene("two-tori");
  lab.scene("whole", [&] { return scene; });
  EXPECT_GT(lab.truth().pairs.size(), 0u);
  scene.ignored = {{0, 1}};
  lab.scene("ignored", [&] { return scene; });
  EXPECT_EQ(lab.truth().pairs.size(), 0u);
}

// ---- Intervals by the bootstrap against what combinatorics says about them.

double choose(int n, int k) {
  double out = 1;
  for (int i = 0; i < k; ++i) out = out * (n - i) / (i + 1);
  return out;
}

// The least rank k with which a drawn median of 1 .. n (n odd) is at most k with more than 2.5 %.
int lower_rank(int n) {
  for (int k = 1;; ++k) {
    double below = 0;
    for (int j = (n + 1) / 2; j <= n; ++j)
      below += choose(n, j) * std::pow(double(k) / n, j) * std::pow(1 - double(k) / n, n - j);
    if (below > 0.025) return k;
  }
}

// How often the interval from the k-th least to the k-th largest of n contains the true median.
double coverage(int n, int k) {
  double outside = 0;
  for (int j = 0; j < k; ++j) outside += choose(n, j);
  return 1 - 2 * outside * std::pow(0.5, n);
}

TEST(Statistics, BootstrapEndsWhereCombinatoricsPutThem) {
  for (const int n : {3, 5, 7, 9, 15}) {
    std::vector<double> up_to_n(static_cast<std::size_t>(n));
    std::iota(up_to_n.begin(), up_to_n.end(), 1.0);
    const Spread e = spread_of(up_to_n);
    EXPECT_EQ(e.median, (n + 1) / 2) << n;
    EXPECT_EQ(e.low, lower_rank(n)) << n;
    EXPECT_EQ(e.high, n + 1 - lower_rank(n)) << n;
    EXPECT_EQ(e.n, static_cast<std::size_t>(n));
  }
}

// What the header says of it; the twin: five runs are too few.
TEST(Statistics, NineRunsAreTheFewestOddNumberThatGives95PerCent) {
  EXPECT_NEAR(coverage(3, lower_rank(3)), 0.75, 1e-12);
  EXPECT_NEAR(coverage(5, lower_rank(5)), 0.9375, 1e-12);
  EXPECT_LT(coverage(7, lower_rank(7)), 0.95);
  EXPECT_GT(coverage(9, lower_rank(9)), 0.95);
}

TEST(Statistics, TheSameValuesInAnyOrderGiveTheSameInterval) {
  std::vector<double> values = {4, 1.5, 2, 9, 3, 3.5, 8};
  const Spread first = spread_of(values);
  std::ranges::reverse(values);
  const Spread again = spread_of(values);
  EXPECT_EQ(first.low, again.low);
  EXPECT_EQ(first.high, again.high);
  // The twin: another value, another interval.
  values[0] = 0.5;
  values[1] = 0.6;
  EXPECT_NE(spread_of(values).low, first.low);
}

TEST(Statistics, FewValues) {
  EXPECT_EQ(spread_of({}).n, 0u);
  const Spread one = spread_of({7});
  EXPECT_EQ(one.low, 7);
  EXPECT_EQ(one.high, 7);
  EXPECT_EQ(spread_of({1, 3}).median, 2);
  EXPECT_EQ(middle({4, 1, 2, 9}), 3);
  EXPECT_EQ(middle({}), 0);
}

}  // namespace
}  // namespace farcull
