// The method boxes takes no more work than `exact`, a constant factor apart, wherever triangles lie
// and however large they are. Work is counted, so that a loaded machine changes nothing;
// farcull_strays measures time and memory.
#include "tests/lab/strays.h"
#include "core/boxes/block.h"
#include "core/boxes/join.h"
#include "core/proximity/near_pairs.h"
#include "core/scene/pair_sort.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::random_strays;
using lab::stray_scene;
using lab::Strays;
using lab::with_self;

constexpr int kTriangles = 8000;  // of an object

BoxesResult found(const Scene& scene, const BoxesSettings& settings, unsigned threads) {
  return find_boxes(scene, plan_boxes(scene, settings, threads));
}

// "" if a result is right and took no more work than it may.
std::string wrong(const Scene& scene, const BoxesResult& result) {
  const ExactResult exact = all_colliding_pairs(scene);
  std::vector<TrianglePair> truth = exact.pairs;
  truth.insert(truth.end(), exact.neighbour_pairs.begin(), exact.neighbour_pairs.end());
  if (lab::missed(truth, result.candidates) > 0) return "missed a pair";
  for (const TrianglePair& pair : result.candidates)
    if (!boxes_meet(scene, pair, 0)) return "a candidate whose boxes are apart";
  const lab::BoxesWork work = lab::work_of(result);
  const lab::BoxesWork most = lab::most_work(scene.triangles.size(), exact.box_pairs);
  if (work.tests > most.tests) return "too many tests: " + std::to_string(work.tests / most.tests);
  if (work.lists > most.lists) return "too long a list: " + std::to_string(work.lists / most.lists);
  return "";
}

// All six scenes, with the address sanitizer too: fewer do not show both ways.
TEST(Strays, TakeNoMoreWorkThanExactAndMissNothing) {
  std::size_t uneven = 0, others = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Scene scene = stray_scene(seed, kTriangles, random_strays(seed));
    SCOPED_TRACE(seed);
    const BoxesResult result = found(scene, {}, 2);
    EXPECT_EQ(wrong(scene, result), "");
    uneven += result.stage.reason == Reason::join_uneven;
    others += result.stage.reason == Reason::block_pairs;
  }
  EXPECT_GT(uneven, 0u);
  EXPECT_GT(others, 0u);
}

// Blocks in the order of a file that scatters its triangles overlap each other nearly all.
TEST(StraysTwin, BlocksOfScatteredTrianglesTakeTooMuchWork) {
  const Scene scene = stray_scene(0, 2 * kTriangles, {.surface = true});
  BoxesResult result = found(scene, {}, 2);
  EXPECT_EQ(wrong(scene, result), "");
  const TriangleBlocks blocks = make_blocks(scene, 0, 2);
  std::vector<BlockPair> pairs;
  pair_blocks(BlockTrees(blocks, blocks.objects), 0, 1, blocks.first[0], blocks.first[1], SIZE_MAX,
              pairs);
  result.stage.n = pairs.size();
  EXPECT_TRUE(wrong(scene, result).starts_with("too many tests"));
}

// The scenes in which a stray vertex took half a minute, smaller.
TEST(Strays, OfAScanWithABadVertexOrTriangle) {
  for (const double far : {1e4, 3e4, 1e30, 1e300}) {
    for (const bool self : {true, false}) {
      Scene scene = make_builtin_scene("two-spheres");
      if (self) scene = with_self(std::move(scene));
      for (const Object& object : scene.objects)
        scene.vertices[scene.triangles[object.first_triangle + 77][1]] = Vec3(far, 1, -0.5 * far);
      const BoxesResult result = found(scene, {}, 2);
      EXPECT_EQ(wrong(scene, result), "") << far;
      EXPECT_EQ(result.stage.reason, Reason::join_uneven);
      EXPECT_EQ(planned_stage(plan_boxes(scene, {})).reason, Reason::join_uneven);
    }
  }
}

// Neighbours and ignored objects are left out of the tree as well, and a clearance finds more.
TEST(Strays, KeepTheQuestion) {
  Scene scene = with_self(make_builtin_scene("two-spheres"));
  scene.vertices[scene.triangles[5][0]] = Vec3(1e9, 0, 0);
  const std::size_t all = found(scene, {}, 2).candidates.size();
  BoxesSettings settings{.neighbours = false};
  const BoxesResult apart = found(scene, settings, 2);
  EXPECT_LT(apart.candidates.size(), all);
  for (const TrianglePair& pair : apart.candidates)
    ASSERT_FALSE(share_index(scene.triangles[pair.a], scene.triangles[pair.b]));
  settings = {.ignored = {{0, 1}}};
  const std::vector<std::uint32_t> owner = owners(scene);
  for (const TrianglePair& pair : found(scene, settings, 2).candidates)
    ASSERT_EQ(owner[pair.a], owner[pair.b]);
  settings = {.clearance = 0.01};
  const BoxesResult wide = found(scene, settings, 2);
  EXPECT_EQ(wide.stage.reason, Reason::join_uneven);
  EXPECT_GT(wide.candidates.size(), all);
  EXPECT_EQ(lab::missed(lab::truth_of(scene, 0.01), wide.candidates), 0u);
}

// A vertex that flies away and comes back, with what is kept of each frame.
TEST(Strays, InFramesAreFoundAsWithoutThem) {
  const Scene rest = make_builtin_scene("two-spheres");
  FrameMemory memory;
  std::size_t uneven = 0;
  const double places[] = {0, 0, 1e6, 1e6, 1e30, 0, 0, 0};
  for (std::size_t frame = 0; frame < std::size(places); ++frame) {
    Scene scene = rest;
    if (places[frame] > 0) scene.vertices[scene.triangles[100][0]] = Vec3(places[frame], 0, 0);
    scene.vertices[scene.triangles[200][0]].x() += 1e-3 * static_cast<double>(frame);
    memory.moved.update(scene);
    const BoxesResult result = find_boxes(scene, plan_boxes(scene, {}, 2, &memory), &memory);
    uneven += result.stage.reason == Reason::join_uneven;
    EXPECT_EQ(result.candidates, found(scene, {}, 2).candidates) << frame;
  }
  EXPECT_EQ(uneven, 3u);
}

// All pairs, and the blocks that were compared for them.
std::pair<std::size_t, std::uint64_t> pairs_and_blocks(const Scene& scene) {
  OrderedPairs pairs(scene, 0, {}, true, 2);
  std::vector<TrianglePair> part;
  std::size_t count = 0;
  while (!pairs.at_end()) {
    pairs.next(1000, part);
    count += part.size();
  }
  return {count, pairs.compared()};
}

// One triangle in ten reaches through all others, and is thin; or places spread over 300 decades.
TEST(Strays, StandApartInATree) {
  const std::uint64_t even = pairs_and_blocks(stray_scene(1, kTriangles, {})).second;
  Scene needles = stray_scene(1, kTriangles, {});
  for (std::uint32_t t = 0; t < needles.triangles.size(); t += 10)
    for (const std::uint32_t v : needles.triangles[t])
      needles.vertices[v] = Vec3(v % 2 ? 2 : -2, needles.vertices[v].y(), needles.vertices[v].z());
  EXPECT_LE(pairs_and_blocks(needles).second, 3 * even);
  const Scene spread = stray_scene(1, kTriangles, {.decades = 300, .spread = true});
  EXPECT_LE(pairs_and_blocks(spread).second, 4 * even);
}

// The trees of streams and distances do not follow the extent either.
TEST(Strays, SpoilNoTree) {
  for (const double far : {1e4, 1e30}) {
    Scene scene = make_builtin_scene("two-spheres"), other = scene;
    for (const Object& object : scene.objects)
      for (const std::uint32_t v : scene.triangles[object.first_triangle + 77])
        scene.vertices[v] *= far;
    const auto [count, blocks] = pairs_and_blocks(other);
    const auto [more, more_blocks] = pairs_and_blocks(scene);
    // Each huge box meets all blocks, of which there are a fifteenth of the triangles at most.
    EXPECT_LE(more_blocks, 3 * blocks + more) << far;
    const ProximityTrees trees(scene, 2), simple(other, 2);
    const std::vector<ObjectPair> question = {{0, 1}};
    trees.near_pairs(question, 1e300, {});
    simple.near_pairs(question, 1e300, {});
    EXPECT_LE(trees.counts().box_pairs, 3 * simple.counts().box_pairs + scene.triangles.size());
  }
}

}  // namespace
}  // namespace farcull
