// The rules by which culling leaves out the level of objects and further rounds.
#include "core/cull/cull.h"
#include "core/native/canvas.h"
#include "core/view/regions.h"
#include "experiments/record/stage_words.h"
#include "offsets/offsets.h"
#include "tests/lab/cull.h"
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
    if (stage.level == kObjectLevel && stage.ran) return true;
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

// ---- Triangles as owners: S-CULLIDE with raw triangles and a strict test, and the same with
// fattened ones, which promises.

using lab::Drawing;
using lab::Trace;

CullSettings self_settings(const Drawing& drawing, bool touching) {
  const bool raw = drawing.fattener.name == "raw";
  CullSettings settings = lab::cull_settings(drawing, raw ? "z,-z" : "x,y,z", raw ? 24 : 16);
  settings.self = true;
  settings.touching = touching;
  return settings;
}

// A sheet of n x n squares in the plane z = 0, one object; `fold` turns its right half over, to lie
// above the left one at that distance, tilted so that the depth order is one-sided.
Scene sheet(int n, bool fold) {
  std::vector<std::array<Vec3, 3>> triangles;
  const auto at = [&](int i, int j) {
    const double x = double(i) / n, y = double(j) / n;
    if (!fold || x <= 0.5) return Vec3(x, y, 0);
    return Vec3(1 - x, y, 0.5 * (x - 0.5));
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  Scene scene = lab::scene_of(std::vector<std::vector<std::array<Vec3, 3>>>{triangles});
  scene.objects[0].self = true;
  return scene;
}

TEST(CullSelf, AFlatSheetAndAFoldedOneAreCulledWholeByTheStrictTest) {
  const Drawing raw = lab::raw_on_ideal();
  for (const bool fold : {false, true}) {
    const Trace run = lab::run_by(kQuickRule, sheet(8, fold), raw, self_settings(raw, false));
    EXPECT_TRUE(run.result.live.empty()) << fold;
  }
}

// Two sheets of one object at one depth touch: seen at the stored depth, not behind it.
TEST(CullSelf, TouchingContactsAreKeptOrIgnoredAsAsked) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (int i = 0; i < 2; ++i)
    triangles.push_back({Vec3(0, 0, 0), Vec3(1, 0.25 * i, 0), Vec3(0.25 * i, 1, 0)});
  triangles.push_back({Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1)});  // gives the view a depth
  Scene scene = lab::scene_of(std::vector<std::vector<std::array<Vec3, 3>>>{triangles});
  scene.objects[0].self = true;
  const Drawing raw = lab::raw_on_ideal();
  CullSettings settings = self_settings(raw, true);
  settings.views = parse_views("z");
  EXPECT_EQ(lab::run_by(kQuickRule, scene, raw, settings).result.live,
            (std::vector<std::uint32_t>{0, 1}));
  settings.touching = false;
  EXPECT_TRUE(lab::run_by(kQuickRule, scene, raw, settings).result.live.empty());
}

// What is in conflict on every view's canvas, by the test in use, is kept: theorem 2 with the
// canvas's own notion of collision.
TEST(CullSelf, ConflictsInsideObjectsAreKept) {
  const Drawing raw = lab::raw_on_ideal();
  for (const bool touching : {true, false}) {
    std::size_t pairs = 0;
    const auto check = [&] {
      const Scene scene = lab::scene_of(*lab::small_triangles(), true);
      const CullSettings settings = self_settings(raw, touching);
      const lab::Pairs wanted = lab::conflicts(scene, raw, settings);
      pairs += wanted.size();
      for (const PassRule& rule : {kQuickRule, kPlainRule})
        RC_ASSERT(lab::wrongly_cleared(lab::run_by(rule, scene, raw, settings), wanted) == 0);
    };
    lab::expect_property(821, 60, check, [&] { return pairs > 20; });
  }
}

// The twin: the strict test loses conflicts at equal depth, and objects as owners lose all inside.
TEST(CullSelf, TheStrictTestAndObjectsAsOwnersLoseConflicts) {
  const Drawing raw = lab::raw_on_ideal();
  int strict = 0, objects = 0;
  for (int n = 0; n < 40; ++n) {
    const Scene scene = lab::scene_of(lab::random_small(2200 + n, 80), true);
    CullSettings settings = self_settings(raw, true);
    const lab::Pairs wanted = lab::conflicts(scene, raw, settings);
    settings.touching = false;
    strict += lab::wrongly_cleared(lab::run_by(kQuickRule, scene, raw, settings), wanted);
    settings.touching = true;
    settings.self = false;
    const auto live = lab::run_by(kQuickRule, scene, raw, settings).result.live;
    for (const auto& [u, t] : wanted) objects += !std::ranges::binary_search(live, u);
  }
  EXPECT_GT(strict, 0);
  EXPECT_GT(objects, 0);
}

// With a fattener and triangles as owners nothing is missed inside objects either.
TEST(CullSelf, FattenedTrianglesAsOwnersMissNothing) {
  const Drawing obb = lab::on_worst(obb_fattener());
  std::size_t pairs = 0, culled = 0;
  for (int n = 0; n < 40; ++n) {
    Scene scene = lab::random_scene(8100 + n);
    for (Object& object : scene.objects) object.self = true;
    const lab::Pairs wanted = lab::collisions(scene);
    const Trace run = lab::run_by(kQuickRule, scene, obb, self_settings(obb, true));
    ASSERT_EQ(lab::wrongly_cleared(run, wanted), 0) << n;
    pairs += wanted.size();
    culled += scene.triangles.size() - run.result.live.size();
  }
  EXPECT_GT(pairs, 500u);
  EXPECT_GT(culled, 50u);
}

TEST(CullSelf, ThePlanTakesTheWholeOfObjectsThatAreTestedAgainstThemselves) {
  Scene scene = sheet(4, false);
  EXPECT_TRUE(find_regions(scene).triangles.empty());
  const Regions plan = find_regions(scene, {.self = true});
  EXPECT_EQ(plan.triangles.size(), scene.triangles.size());
  ASSERT_EQ(plan.places.size(), 1u);
  EXPECT_EQ(plan.places[0].lo, plan.object_boxes[0].lo);
  scene.objects[0].self = false;
  EXPECT_TRUE(find_regions(scene, {.self = true}).triangles.empty());
}

TEST(CullSelf, NoLevelOfObjectsOrClustersWhereTrianglesAreOwners) {
  const Drawing raw = lab::raw_on_ideal();
  CullSettings settings = self_settings(raw, true);
  settings.clusters = {.sizes = {4}, .reason = Reason::clusters_given};
  for (const Stage& stage : lab::run_by(kQuickRule, sheet(4, true), raw, settings).result.stages) {
    EXPECT_FALSE(has_text(name_of(stage), "objects"));
    EXPECT_FALSE(has_text(name_of(stage), "clusters"));
    if (name_of(stage) == "sub-object level") {
      EXPECT_FALSE(stage.ran);
    }
  }
}

}  // namespace
}  // namespace farcull
