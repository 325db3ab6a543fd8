// The rules by which culling leaves out the level of objects and further rounds.
#include "core/cull/cull.h"
#include "core/native/canvas.h"
#include "core/view/regions.h"
#include "offsets/obb.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

/// Objects of one triangle each in a stack, so close that all boxes overlap.
Scene stack(int objects) {
  std::vector<std::vector<std::array<Vec3, 3>>> out;
  for (double z = 0; z < objects; ++z)
    out.push_back({{Vec3(0, 0, z), Vec3(9, 0, z + objects), Vec3(0, 9, z + objects)}});
  return lab::scene_of(out);
}

CullSettings settings_of(const Fattener& fattener) {
  return {.views = parse_views("x,y,z"),
          .resolution = 64,
          .fattener = fattener,
          .radius = {},
          .least_objects = kFewObjects,
          .worth_a_round = kWorthARound};
}

CullResult cull_of(const Scene& scene, const CullSettings& settings) {
  NativeCanvas canvas(settings.fattener.mode, settings.fattener.solid);
  return cull(scene, find_regions(scene), settings, canvas);
}

const Stage* find_stage(const std::vector<Stage>& stages, StageKind kind) {
  for (const Stage& stage : stages)
    if (stage.kind == kind) return &stage;
  return nullptr;
}

bool asked_objects(const std::vector<Stage>& stages) {
  for (const Stage& stage : stages)
    if (stage.level == "objects" && stage.ran) return true;
  return false;
}

TEST(CullRules, ObjectsAreAskedAsAWholeFromSixteenOn) {
  const Fattener fattener = obb_fattener();
  for (const int objects : {2, 15, 16, 17}) {
    SCOPED_TRACE(objects);
    const Scene scene = stack(objects);
    const Regions regions = find_regions(scene);
    ASSERT_EQ(regions.triangles.size(), static_cast<std::size_t>(objects));
    const CullSettings settings = settings_of(fattener);
    const CullResult result = cull_of(scene, settings);
    const std::vector<Stage> planned = planned_stages(scene, regions, settings);
    for (const auto* stages : {&result.stages, &planned}) {
      const Stage* left_out = find_stage(*stages, StageKind::objects);
      EXPECT_EQ(left_out != nullptr, objects < 16);
      EXPECT_EQ(asked_objects(*stages), objects >= 16);
      if (left_out == nullptr) continue;
      EXPECT_FALSE(left_out->ran);
      EXPECT_EQ(left_out->reason, Reason::few_objects);
      EXPECT_EQ(left_out->n, static_cast<std::uint64_t>(objects));
      EXPECT_EQ(left_out->m, 16u);
    }
    CullSettings always = settings;
    always.least_objects = 0;
    EXPECT_TRUE(asked_objects(cull_of(scene, always).stages));
  }
}

// Whatever is left out, what intersects stays, and what a run without rules culls is a superset.
TEST(CullRules, ARoundFollowsOneThatCulledAnEighth) {
  const Fattener fattener = obb_fattener();
  int left_out = 0, went_on = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = lab::random_scene(seed);
    const CullSettings settings = settings_of(fattener);
    CullSettings without = settings;
    without.worth_a_round = 0;
    const CullResult result = cull_of(scene, settings), all = cull_of(scene, without);
    EXPECT_TRUE(
        std::includes(result.live.begin(), result.live.end(), all.live.begin(), all.live.end()));
    int rounds = 0;
    for (const Stage& stage : result.stages) rounds = std::max(rounds, stage.round);
    const Stage* stage = find_stage(result.stages, StageKind::further_rounds);
    if (stage != nullptr && stage->reason == Reason::little_culled) {
      ++left_out;
      EXPECT_EQ(stage->round, rounds);
      EXPECT_LT(stage->n * kWorthARound, stage->m);
      EXPECT_EQ(stage->m - stage->n, result.live.size());
    }
    went_on += rounds > 1;
  }
  EXPECT_GT(left_out, 5);
  EXPECT_GT(went_on, 5);
}

TEST(CullRules, FullLeavesNothingOutByThem) {
  const Scene scene = stack(3);
  CullSettings settings = settings_of(obb_fattener());
  settings.full = true;
  const CullResult result = cull_of(scene, settings);
  const Stage* rounds = find_stage(result.stages, StageKind::further_rounds);
  EXPECT_TRUE(rounds == nullptr || rounds->reason != Reason::little_culled);
}

}  // namespace
}  // namespace farcull
