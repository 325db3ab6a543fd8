// Frames in which an object moves as a whole, by contestants that have to agree.
#include "experiments/measure/bench.h"

#include <nlohmann/json.hpp>

#include "tests/lab/test.h"

namespace farcull {
namespace {

TEST(PoseBench, KeptTreesAnswerAsNewCallsAndFclNearly) {
  const Scene scene = make_builtin_scene("random-soup");
  const PoseBenchOptions options{.repeat = 2};
  const PoseBenchResult result = bench_poses(scene, options);
  ASSERT_EQ(result.rows.size() + result.left_out.size(), 2 + pose_peers().size());
  for (const PoseBenchRow& row : result.rows) {
    EXPECT_EQ(row.repeats, 2);
    EXPECT_GT(row.pairs, 0u);
    EXPECT_LE(row.lacking + row.beyond, row.peer ? row.pairs / 100 : 0) << row.name;
  }
  // The object turns, so frames have other pairs.
  const auto at_rest = all_colliding_pairs(scene, {}, {}).pairs.size();
  EXPECT_NE(result.rows[0].pairs, 3 * at_rest);
  EXPECT_EQ(disagreement_of(result), "");
  const auto json = to_json(scene, options, result);
  EXPECT_EQ(json["rows"].size(), result.rows.size());
  EXPECT_TRUE(has_text(pose_bench_table(scene, options, result), "boxes, new call"));
  PoseBenchResult twin = result;
  twin.rows[1].lacking = 3;
  EXPECT_EQ(disagreement_of(twin), "boxes lacks 3 pairs of boxes, new call, and has 0 others");
}

TEST(PoseBench, RefusesWhatItCannotMeasure) {
  const Scene scene = make_builtin_scene("two-spheres");
  EXPECT_EQ(error_of([&] { bench_poses(scene, {.peers = "nope"}); }).where, "--peers");
  EXPECT_EQ(error_of([&] { bench_poses(scene, {.repeat = 0}); }).where, "--repeat");
  EXPECT_EQ(error_of([&] { bench_poses(make_builtin_scene("crumpled:1000"), {}); }).reason,
            "has no two objects, of which one could move");
}

}  // namespace
}  // namespace farcull
