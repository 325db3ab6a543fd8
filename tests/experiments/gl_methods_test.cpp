// The methods that draw, end to end on a GL device: the planner changes no answer, both query modes
// give the same, and the CULLIDE family is ordered as it should be.
#include <gtest/gtest.h>

#include "experiments/builtin_scenes.h"
#include "experiments/family.h"
#include "experiments/planner.h"
#include "experiments/run.h"
#include "tests/core/scenes.h"
#include "tests/experiments/plan_lab.h"

namespace farcull {
namespace {

using lab::not_followed;

Session& session() {
  static Session shared("");
  return shared;
}

RunOptions options_of(Method method, int resolution = 64) {
  RunOptions options;
  options.method = method;
  options.resolution = resolution;
  return options;
}

constexpr Method kDrawing[] = {Method::far, Method::cullide, Method::quick_cullide,
                               Method::s_cullide};

Scene scene_for(const std::string& name, Method method) {
  Scene scene = make_builtin_scene(name);
  if (tests_self_alone(method)) {
    for (Object& object : scene.objects) object.self = true;
  }
  return scene;
}

TEST(GlMethods, RunsFollowThePlan) {
  for (const Method method : kDrawing) {
    for (const char* name : {"far-apart", "crowd"}) {
      // Each triangle of S-CULLIDE is drawn by itself.
      const Scene scene = scene_for(method == Method::s_cullide ? "degenerate" : name, method);
      for (const bool full : {false, true}) {
        RunOptions options = options_of(method);
        options.full = full;
        for (const QueryMode query : {QueryMode::flags, QueryMode::occlusion}) {
          options.query = query;
          EXPECT_EQ(not_followed(planned(scene, options), run_scene(scene, options, session())), "")
              << scene.name << " " << to_string(method) << " full " << full;
        }
      }
    }
  }
}

TEST(GlMethods, FullFindsTheSamePairsByFarWithEitherOffset) {
  for (int seed = 0; seed < 12; ++seed) {
    const Scene scene = lab::random_scene(seed);
    RunOptions exact;
    exact.method = Method::exact;
    const RunRecord truth = run_scene(scene, exact, session());
    for (const char* offset : {"obb", "exact"}) {
      for (const bool full : {false, true}) {
        RunOptions options = options_of(Method::far);
        options.offset = offset;
        options.full = full;
        const RunRecord record = run_scene(scene, options, session());
        EXPECT_EQ(record.pairs, truth.pairs) << seed << " " << offset << " full " << full;
        EXPECT_EQ(record.verification->false_negatives, 0u);
      }
    }
  }
}

TEST(GlMethods, BothQueryModesGiveTheSame) {
  for (const Method method : kDrawing) {
    const Scene scene = scene_for("degenerate", method);
    RunOptions options = options_of(method, 128);
    options.query = QueryMode::flags;
    const RunRecord flags = run_scene(scene, options, session());
    options.query = QueryMode::occlusion;
    EXPECT_EQ(run_scene(scene, options, session()).kept, flags.kept) << to_string(method);
  }
}

std::uint64_t total(const RunRecord& record, std::uint64_t Stage::*count) {
  std::uint64_t sum = 0;
  for (const Stage& stage : record.stages) sum += stage.*count;
  return sum;
}

TEST(GlMethods, QuickCullideKeepsNoMoreAndSaysWhatItSaved) {
  for (const char* name : {"two-spheres", "crowd", "random-soup"}) {
    const Scene scene = make_builtin_scene(name);
    const RunRecord plain = run_scene(scene, options_of(Method::cullide, 128), session());
    const RunRecord quick = run_scene(scene, options_of(Method::quick_cullide, 128), session());
    EXPECT_TRUE(
        std::includes(plain.kept.begin(), plain.kept.end(), quick.kept.begin(), quick.kept.end()))
        << name;
    EXPECT_GT(total(quick, &Stage::draws_saved), 0u) << name;
    EXPECT_GT(total(quick, &Stage::queries_saved), 0u) << name;
    EXPECT_EQ(total(plain, &Stage::draws_saved), 0u) << name;
    EXPECT_FALSE(plain.promises);
    EXPECT_FALSE(quick.promises);
  }
}

// One object: a sheet, and in it a triangle that only touches it and one that goes through.
Scene contacts() {
  Scene scene = lab::scene_of({{{Vec3(0, 0, 0), Vec3(8, 0, 0), Vec3(0, 8, 0)},
                                {Vec3(2, 2, 0), Vec3(3, 2, 1), Vec3(2, 3, 1)},
                                {Vec3(1, 1, -1), Vec3(1.5, 1, 1), Vec3(1, 1.5, 1)}}});
  scene.objects[0].self = true;
  return scene;
}

TEST(GlMethods, SCullideMissesWhatOnlyTouchesAndSaysSo) {
  const Scene scene = contacts();
  RunOptions options = options_of(Method::s_cullide, 256);
  options.views = "-z";
  const RunRecord record = run_scene(scene, options, session());
  EXPECT_EQ(record.pairs, (std::vector<TrianglePair>{{0, 2}}));
  ASSERT_TRUE(record.verification);
  EXPECT_EQ(record.verification->false_negatives, 1u);
  EXPECT_EQ(record.missed, (ContactCounts{.touching = 1, .penetrating = 0}));
  EXPECT_FALSE(broken(record, false));
  EXPECT_TRUE(broken(record, true));
  // The reliable answer beside it.
  RunOptions pairs = options_of(Method::far_pairs);
  EXPECT_EQ(run_scene(scene, pairs, session()).pairs, (std::vector<TrianglePair>{{0, 1}, {0, 2}}));
}

TEST(GlMethods, TheFamilyOfASceneInMotion) {
  FamilyArguments arguments;
  arguments.scenes = {"crowd"};
  arguments.range = {0, 2};
  arguments.options.resolution = 64;
  const std::vector<FamilyCell> cells = run_family(arguments);
  // far twice (obb, exact), the others once, S-CULLIDE not: nothing is tested against itself.
  ASSERT_EQ(cells.size(), all_methods().size());
  for (const FamilyCell& cell : cells) {
    if (cell.promises) {
      EXPECT_EQ(cell.missed(), 0u) << to_string(cell.method);
    }
    if (draws(cell.method)) {
      EXPECT_GT(cell.frames[0].queries, 0u);
    }
  }
}

}  // namespace
}  // namespace farcull
