// That a point's row depends on the point alone, not on what the lab measured before, nor on which
// of several runs was looked at.
#include "experiments/studies/lab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"
#include "experiments/builtin_scenes.h"
#include "experiments/studies/points.h"

namespace farcull {
namespace {

Measurement measured(Lab& lab, const std::string& scene, const std::string& method,
                     int repeat = 1) {
  lab.scene(scene);
  return measure_run(plain_point(scene, method), lab, repeat);
}

TEST(Lab, OpensTheDeviceOfFarPairsWhereBoxesWouldDecideToo) {
  Lab fresh("cpu");
  const Measurement first = measured(fresh, "far-apart", "far-pairs");
  EXPECT_TRUE(fresh.session().has_pairs());
  Lab used("cpu");
  measured(used, "two-spheres", "far-pairs");
  const Measurement later = measured(used, "far-apart", "far-pairs");
  EXPECT_EQ(first.counts, later.counts);
  EXPECT_EQ(first.device, later.device);
  // The twin: a run by itself goes without, and with, as it comes.
  Session session("cpu");
  RunOptions options;
  options.method = Method::far_pairs;
  options.device = "cpu";
  const Scene scene = make_builtin_scene("far-apart");
  const auto why = [&] { return run_scene(scene, options, session).device_note; };
  const std::string before = why();
  EXPECT_FALSE(session.has_pairs());
  run_scene(make_builtin_scene("two-spheres"), options, session);
  EXPECT_NE(why(), before);
}

// Whether the lists of i-collide are those of a run just before.
bool is_warm(Lab& lab) { return lab.session().sweep().find(lab.current()).counts.sorts == 0; }

TEST(Lab, StartsICollideWithoutListsEachTimeWhereNothingMoves) {
  Lab lab("cpu");
  const auto stages_of = [&](const Point& point) {
    RunRecord record;
    measure_run(point, lab, 1, &record);
    std::string out;
    for (const Stage& stage : record.stages) out += stage.name + ": " + stage.reason + "\n";
    return out;
  };
  lab.scene("crowd");
  const Point still = plain_point("crowd", "i-collide");
  const std::string cold = stages_of(still);
  EXPECT_EQ(stages_of(still), cold);
  EXPECT_TRUE(is_warm(lab)) << "else nothing is there to be forgotten";
  EXPECT_EQ(stages_of(still), cold);
  // The twin: a point of a motion keeps the lists.
  Point moving = still;
  moving.frame = 0;
  EXPECT_NE(stages_of(moving), cold);
  EXPECT_THROW(measure_run(moving, lab, 2), std::logic_error);
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

TEST(Lab, GivesTheSameCountsInEveryRepeat) {
  Lab lab("cpu");
  for (const char* method : {"far-pairs", "i-collide", "exact"}) {
    EXPECT_EQ(measured(lab, "crowd", method, 3).counts, measured(lab, "crowd", method).counts);
  }
}

// The twin: each way in which two runs may differ is refused, and said.
TEST(Lab, RefusesRunsThatDiffer) {
  const Point point = plain_point("crowd", "far-pairs");
  const Outcome good{.pairs = {{1, 2}, {3, 4}}, .counts = {{"missed", 0}}, .device = "cpu"};
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
  other.counts["missed"] = 3;
  EXPECT_NE(said(other).find("missed 0 and 3"), std::string::npos) << said(other);
  other = good;
  other.counts["queries"] = 7;
  EXPECT_NE(said(other).find("queries none and 7"), std::string::npos) << said(other);
  other = good;
  other.pairs = {{1, 2}, {3, 5}};
  EXPECT_NE(said(other).find("1 and 1 pairs"), std::string::npos) << said(other);
  other = good;
  other.device = "another";
  EXPECT_NE(said(other).find("device cpu and another"), std::string::npos) << said(other);
}

}  // namespace
}  // namespace farcull
