// Triangles that are compared along their normals: no colliding pair is lost, on every instruction
// set, and large triangles among small ones leave few pairs. Each property has a twin that must
// fail.
#include "core/boxes/meetings.h"
#include "core/boxes/oriented.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/lanes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::missed, lab::random_scene, lab::truth_of, lab::with_self;

// The pairs of all blocks of a scene, whatever the rules would choose.
std::vector<TrianglePair> pairs_of(const Scene& scene, bool along_normals, double clearance) {
  const TriangleBlocks blocks = make_ordered_blocks(scene, clearance, 1);
  const BlockTrees trees(blocks, blocks.objects);
  BlockPairs pairs;
  const auto n = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t a = 0; a < n; ++a) {
    for (std::uint32_t b = a; b < n; ++b) {
      if (a == b && !scene.objects[a].self) continue;
      pair_blocks(trees, a, b, blocks.first[a], blocks.first[a + 1], SIZE_MAX,
                  a == b ? pairs.inside : pairs.between);
    }
  }
  return sorted_pairs(2, [&](const TakePairs& take) {
    return give_pairs_of_some(scene, blocks, pairs, along_normals, clearance, true, 2, take);
  });
}

TEST(Normals, LoseNoPairThatCollides) {
  std::vector<Scene> scenes;
  for (const char* name : {"cad-cut:2000", "needles", "degenerate", "mixed", "gap", "shells:8",
                           "mixed@far", "needles@tiny"}) {
    scenes.push_back(make_builtin_scene(name));
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    scenes.push_back(seed % 2 ? with_self(random_scene(seed)) : random_scene(seed));
  std::size_t found = 0, left_out = 0;
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    for (const double clearance : {0.0, 0.003}) {
      const std::vector<TrianglePair> truth = truth_of(scene, clearance);
      const std::vector<TrianglePair> boxes = pairs_of(scene, false, clearance);
      const std::vector<TrianglePair> pairs = pairs_of(scene, true, clearance);
      EXPECT_EQ(missed(truth, pairs), 0u);
      EXPECT_TRUE(std::ranges::includes(boxes, pairs)) << "each once, and boxes overlap";
      found += truth.size();
      left_out += boxes.size() - pairs.size();
      on_every_target([&] { EXPECT_EQ(pairs_of(scene, true, clearance), pairs); });
    }
  }
  EXPECT_GT(found, 5000u);
  EXPECT_GT(left_out, 5000u);
}

TEST(Normals, AreNotComparedWhereFloatsCannotHoldTheCoordinates) {
  for (const float reach : {0.0f, 0x1p-80f, 0x1p70f, kInfinite})
    EXPECT_EQ(normal_margin(reach, 0), std::nullopt) << reach;
  const Scene scene = make_builtin_scene("cad-cut:2000");
  for (const double scale : {0x1p70, 0x1p-80}) {
    const Scene other = transformed(scene, scale, Vec3::Zero());
    EXPECT_EQ(pairs_of(other, true, 0), pairs_of(other, false, 0));
  }
  EXPECT_LT(pairs_of(scene, true, 0).size(), pairs_of(scene, false, 0).size());
}

// Large triangles and small ones in one mesh, in the order of the file or in none.
TEST(Normals, DecideACoarseFunnelInOneMeshWithACloth) {
  for (const bool shuffled : {false, true}) {
    Scene scene = make_builtin_scene("funnel:20000:400");
    ASSERT_EQ(scene.objects.size(), 1u);
    if (shuffled) scene = lab::shuffled(scene, 3);
    const BlockMeetings blocks = decide_by_blocks(scene, 0, 2).blocks;
    EXPECT_EQ(blocks.oriented, nullptr);
    ASSERT_TRUE(blocks.normals);
    const std::size_t pairs = pairs_of_blocks(scene, blocks, 0, false, 2).size();
    EXPECT_LT(pairs, 2 * scene.triangles.size());
    // The twin: boxes alone leave many more.
    BlockMeetings boxes = blocks;
    boxes.normals = false;
    EXPECT_EQ(pairs_of_boxes(scene, {}, false, 2), pairs_of_blocks(scene, boxes, 0, false, 2));
    EXPECT_GT(pairs_of_blocks(scene, boxes, 0, false, 2).size(), 8 * pairs);
  }
}

// Pairs of two objects of at most 16 triangles each, by one comparison, with a margin.
std::vector<TrianglePair> compared(const Scene& scene, double clearance, double margin) {
  const Box all = box_of(scene, 0, static_cast<std::uint32_t>(scene.triangles.size()));
  const Vec3 origin = 0.5 * (all.lo + all.hi);
  std::array<BlockLanes, 2> lanes;
  std::array<NormalLanes, 2> normals;
  const auto reach = static_cast<float>((all.hi - origin).norm());
  for (std::size_t o = 0; o < 2; ++o) {
    std::vector<std::uint32_t> own(scene.objects[o].triangle_count);
    std::iota(own.begin(), own.end(), scene.objects[o].first_triangle);
    fill_lanes(scene, own, half_of(clearance), origin, lanes[o]);
    fill_normals(scene, own, origin, {reach, static_cast<float>(margin)}, normals[o]);
  }
  BlockFindings found;
  compare_blocks({.first = lanes, .second = {}}, {}, normals,
                 std::array<LanePair, 1>{{{0, 1, false}}}, found);
  found.pairs.insert(found.pairs.end(), found.perhaps.begin(), found.perhaps.end());
  std::ranges::sort(found.pairs);
  return found.pairs;
}

TEST(NormalsTwin, WithoutAMarginPairsThatTouchAreLost) {
  std::size_t pairs = 0, lost = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = lab::standing(kWide, seed);
    const std::vector<TrianglePair> truth = truth_of(scene);
    pairs += truth.size();
    EXPECT_EQ(missed(truth, compared(scene, 0, 0x1p-20 * 2000)), 0u);
    lost += missed(truth, compared(scene, 0, 0));
  }
  EXPECT_GE(pairs, 20u * kWide);
  EXPECT_GT(lost, 0u);
}

TEST(NormalsTwin, MarginsWithoutTheClearanceMissPairsOfAClearance) {
  constexpr double kClearance = 1, kMargin = 0x1p-20 * 2000;
  const Scene scene = lab::standing(kWide, 1, 0.98 * kClearance);
  const std::vector<TrianglePair> truth = truth_of(scene, kClearance);
  EXPECT_GE(truth.size(), kWide);
  EXPECT_EQ(missed(truth, compared(scene, kClearance, kMargin + 1.001 * kClearance)), 0u);
  EXPECT_GT(missed(truth, compared(scene, kClearance, kMargin)), 0u);
}

}  // namespace
}  // namespace farcull
