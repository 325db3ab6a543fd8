#include "experiments/measure/harness.h"

#include "experiments/measure/lab.h"
#include "experiments/scenes/builtin/scenes.h"
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

TEST(Harness, DoesNotRepeatAContestantOverTheLimit) {
  int runs = 0;
  const Rounds rounds{.warm_up = 1, .counted = 3, .limit_ms = 5, .memory = true};
  const std::vector<Timed> timed = measure_in_turns(2, rounds, [&](std::size_t i, int) {
    runs += i == 1;
    return i == 1 ? 6.0 : 5.0;
  });
  EXPECT_EQ(runs, 1);
  EXPECT_TRUE(timed[1].over_limit(rounds));
  EXPECT_TRUE(timed[1].ms.empty());
  EXPECT_FALSE(timed[0].over_limit(rounds));
  EXPECT_EQ(timed[0].ms.size(), 3u);
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

TEST(Lab, ReadsAMotionAnewWhereItHasOtherFrames) {
  Lab lab("cpu");
  const auto hash = [&](long frames) { return scene_hash(lab.scene("crowd:30", 1, frames)); };
  const std::string of4 = hash(4), of12 = hash(12);
  EXPECT_EQ(hash(4), of4);
  Lab fresh("cpu");
  EXPECT_EQ(scene_hash(fresh.scene("crowd:30", 1, 12)), of12);
  EXPECT_NE(of4, of12) << "else it would not matter";
}

TEST(Lab, TheTruthIsWithoutWhatTheSceneIgnores) {
  Lab lab("cpu");
  Scene scene = make_builtin_scene("two-tori");
  lab.scene("whole", [&] { return scene; });
  EXPECT_GT(lab.truth().pairs.size(), 0u);
  scene.ignored = {{0, 1}};
  lab.scene("ignored", [&] { return scene; });
  EXPECT_EQ(lab.truth().pairs.size(), 0u);
}

}  // namespace
}  // namespace farcull
