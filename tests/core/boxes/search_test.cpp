// The method boxes: no colliding pair is ever missed, whatever finds the pairs, and the answer
// depends on nothing that it should not depend on. Each property has a twin that must fail.
#include "core/boxes/search.h"

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::missed, lab::pairs_by_boxes, lab::Random, lab::random_scene, lab::truth_of,
    lab::with_self;
using Objects = std::vector<std::vector<std::array<Vec3, 3>>>;

void expect_none_missed(const Scene& scene, const BoxesSettings& settings, std::uint64_t seed) {
  lab::expect_not([&](const Scene& of) { return missed(of, settings) > 0; }, scene,
                  "boxes-" + std::to_string(seed), settings.full ? "boxes, full" : "boxes");
}

TEST(Boxes, MissNothingOnRandomScenes) {
  std::size_t pairs = 0;
  for (std::uint64_t n = 0; more_cases(n, trials(200), pairs > 100); ++n) {
    const std::uint64_t seed = test_seed(n);
    Scene scene = random_scene(seed);
    if (n % 2 == 1) {
      scene = with_self(std::move(scene));
      if (seed % 3 == 0) scene.objects[0].self = false;
    }
    pairs += truth_of(scene).size();
    for (const double clearance : {0.0, 0x1p-10, 0.01, 0.3})
      expect_none_missed(scene, {.clearance = clearance}, seed);
    expect_none_missed(scene, {.full = true}, seed);
  }
}

TEST(Boxes, MissNothingWithinAClearanceAtAnyScale) {
  for (const double scale : {1e-300, 1e-160, 1e-20, 1.0, 1e100, 1e158, 1e200, 1e290}) {
    Objects objects(2);
    objects[0].push_back({Vec3(0, 0, 0), Vec3(40, 0, 0), Vec3(0, 40, 0)});
    objects[1].push_back({Vec3(100, 100, 0), Vec3(60, 100, 0), Vec3(100, 60, 0)});
    for (auto& object : objects)
      for (Vec3& corner : object[0]) corner *= scale;
    const Scene scene = lab::scene_of(objects);
    ASSERT_EQ(truth_of(scene, 86 * scale).size(), 1u);
    EXPECT_EQ(missed(scene, {.clearance = 86 * scale}), 0u) << scale;
  }
}

TEST(Boxes, TheLeastClearanceIsOne) {
  constexpr double least = 5e-324;
  const Scene scene = lab::scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                                     {{Vec3(0, 0, least), Vec3(1, 0, least), Vec3(0, 1, least)}}});
  ASSERT_EQ(truth_of(scene, least).size(), 1u);
  EXPECT_EQ(missed(scene, {.clearance = least}), 0u);
}

TEST(Boxes, MissNothingNearTheLargestDouble) {
  constexpr double m = 1.5e308;
  const Scene scene = lab::scene_of({{{Vec3(-m, 0, 0), Vec3(m, 0, 0), Vec3(0, m, m)}},
                                     {{Vec3(-m, -m, 0), Vec3(m, 1, 0), Vec3(0, m, 0)}}});
  ASSERT_EQ(truth_of(scene).size(), 1u);
  EXPECT_EQ(missed(scene), 0u);
}

TEST(Boxes, MissNothingOnBuiltInScenes) {
  for (const char* name :
       {"two-spheres", "random-soup", "needles", "degenerate", "ground", "crowd", "needles@far",
        "needles@tiny", "two-spheres@ground", "degenerate@huge"}) {
    EXPECT_EQ(missed(make_builtin_scene(name)), 0u) << name;
  }
}

TEST(Boxes, LeaveOutWhatCannotMeet) {
  const Scene apart = make_builtin_scene("far-apart");
  const BoxesPlan plan = plan_boxes(apart, {});
  EXPECT_TRUE(plan.nothing_can_meet());
  EXPECT_FALSE(planned_stage(plan).ran);
  EXPECT_EQ(planned_stage(plan).reason, Reason::no_boxes_overlap);
  EXPECT_TRUE(find_boxes(apart, plan).candidates.empty());
  const Scene crowd = make_builtin_scene("crowd");
  for (const TrianglePair& pair : pairs_by_boxes(crowd))
    ASSERT_TRUE(overlap(grown_box(crowd, pair.a, 0), grown_box(crowd, pair.b, 0)));
}

TEST(Boxes, LeaveOutNeighboursByIndexOnly) {
  const Scene scene = with_self(make_builtin_scene("two-spheres"));
  const std::vector<std::uint32_t> owner = owners(scene);
  for (const bool full : {false, true}) {
    const std::vector<TrianglePair> all = pairs_by_boxes(scene, {.full = full});
    std::vector<TrianglePair> expected = all;
    std::erase_if(expected, [&](const TrianglePair& pair) {
      return owner[pair.a] == owner[pair.b] &&
             share_index(scene.triangles[pair.a], scene.triangles[pair.b]);
    });
    EXPECT_EQ(pairs_by_boxes(scene, {.full = full, .neighbours = false}), expected);
    EXPECT_LT(expected.size(), all.size() / 4);
  }
}

// Needles in all directions through a small cube: boxes of blocks overlap too often, oriented ones
// too.
Scene heaps() {
  Random random(3);
  const auto coordinate = [&] { return random.between(-1, 1); };
  Objects objects(2);
  for (auto& object : objects) {
    for (int k = 0; k < 1500; ++k) {
      const Vec3 p(coordinate(), coordinate(), coordinate());
      const Vec3 along = Vec3(coordinate(), coordinate(), coordinate()).normalized();
      const Vec3 tip = 0.02 * Vec3(coordinate(), coordinate(), coordinate());
      object.push_back({p - 3 * along, p + 3 * along + 0.1 * tip, p + tip});
    }
  }
  return lab::scene_of(objects);
}

// Objects whose boxes all overlap. Their pairs are not listed, which would take memory that grows
// with the square of the objects.
Scene crowded() {
  Random random(5);
  const auto point = [&](double size) {
    return Vec3(size * random.between(-1, 1), size * random.between(-1, 1),
                size * random.between(-1, 1));
  };
  Objects objects(300);
  for (auto& object : objects) {
    for (int k = 0; k < 20; ++k) {
      const Vec3 p = point(1);
      object.push_back({p, p + point(0.3), p + point(0.3)});
    }
  }
  return lab::scene_of(objects);
}

// Where blocks do not decide, a tree does: it finds the pairs whose boxes overlap, listed or given
// as they are found.
TEST(Boxes, OfWhatBlocksDoNotDecideATreeFindsThePairs) {
  for (const auto& [scene, reason] :
       {std::pair(heaps(), Reason::join_often), std::pair(crowded(), Reason::join_crowded)}) {
    for (const Scene& either : {scene, with_self(scene)}) {
      const BoxesPlan plan = plan_boxes(either, {.lists = true}, 2);
      EXPECT_EQ(plan.decision.tree, reason);
      EXPECT_EQ(planned_stage(plan).reason, reason);
      EXPECT_EQ(plan.trace.front().out, either.triangles.size());
      const BoxesResult listed = find_boxes(either, plan);
      std::mutex mutex;
      std::vector<TrianglePair> all;
      const BoxesResult given =
          find_boxes(either, plan, nullptr, {}, [&](std::vector<TrianglePair>& some) {
            const std::scoped_lock lock(mutex);
            all.insert(all.end(), some.begin(), some.end());
          });
      std::ranges::sort(all);
      EXPECT_EQ(all, listed.candidates);
      EXPECT_TRUE(given.streamed && given.candidates.empty());
      EXPECT_EQ(given.count, listed.count);
      const std::vector<TrianglePair> truth = truth_of(either);
      EXPECT_GT(truth.size(), 1000u);
      EXPECT_EQ(missed(truth, listed.candidates), 0u);
    }
  }
}

// Twins: without the growth by half the clearance, and without the pairs of blocks of one meeting,
// pairs are lost.
TEST(BoxesTwin, ATreeOfBoxesThatAreNotGrownMisses) {
  const Scene scene = heaps();
  const std::vector<TrianglePair> truth = truth_of(scene, 0.05);
  EXPECT_EQ(missed(truth, pairs_by_boxes(scene, {.clearance = 0.05, .full = true})), 0u);
  EXPECT_GT(missed(truth, pairs_by_boxes(scene, {.full = true})), 0u);
}

TEST(BoxesTwin, WithoutThePairsInsideObjectsMisses) {
  const Scene scene = with_self(make_builtin_scene("crumpled:4000"));
  BoxesPlan plan = plan_boxes(scene, {});
  ASSERT_GT(plan.decision.blocks.pairs.inside.size(), 0u);
  const std::vector<TrianglePair> truth = truth_of(scene);
  EXPECT_EQ(missed(truth, find_boxes(scene, plan).candidates), 0u);
  plan.decision.blocks.pairs.inside.pop_back();
  const std::size_t last = find_boxes(scene, plan).candidates.size();
  plan.decision.blocks.pairs.inside.clear();
  EXPECT_LT(find_boxes(scene, plan).candidates.size(), last);
  EXPECT_GT(missed(truth, find_boxes(scene, plan).candidates), 0u);
}

}  // namespace
}  // namespace farcull
