// FAR pairs takes no more work than `exact`, a constant factor apart, wherever triangles lie and
// however large they are. Work is counted, so that a loaded machine changes nothing;
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

// Through a plan whose limit of tests may be another one.
PairResult found(const Scene& scene, const PairSettings& settings, unsigned threads,
                 bool limited = true) {
  PairPlan plan = plan_pairs(scene, settings, threads);
  if (!limited) plan.most_tests = UINT64_MAX;
  PairWorkspace workspace;
  return find_pairs(scene, plan, *cpu_pair_backend(threads), workspace);
}

// Of an object: so many that a view of all in one pixel takes more tests than it may.
constexpr int kTriangles = 8000;

bool has_stage(const PairResult& result, Reason reason) {
  return std::ranges::any_of(result.stages,
                             [&](const Stage& stage) { return stage.reason == reason; });
}

// "" if a result is right and took no more work than it may.
std::string wrong(const Scene& scene, const PairResult& result) {
  const ExactResult exact = all_colliding_pairs(scene);
  std::vector<TrianglePair> truth = exact.pairs;
  truth.insert(truth.end(), exact.neighbour_pairs.begin(), exact.neighbour_pairs.end());
  if (lab::missed(truth, result.candidates) > 0) return "missed a pair";
  for (const TrianglePair& pair : result.candidates)
    if (!boxes_meet(scene, pair, 0)) return "a candidate whose boxes are apart";
  const lab::PairWork work = lab::work_of(result);
  const lab::PairWork most = lab::most_work(scene.triangles.size(), exact.box_pairs);
  if (work.tests > most.tests) return "too many tests: " + std::to_string(work.tests / most.tests);
  if (work.lists > most.lists) return "too long a list: " + std::to_string(work.lists / most.lists);
  return "";
}

// As the scene decides, and by views alone, as on a GL device. All six scenes, with the address
// sanitizer too: fewer do not show all three ways.
TEST(Strays, TakeNoMoreWorkThanExactAndMissNothing) {
  std::size_t uneven = 0, given_up = 0, others = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Strays strays = random_strays(seed);
    const Scene scene = stray_scene(seed, kTriangles, strays);
    SCOPED_TRACE(seed);
    const PairResult by_scene = found(scene, {}, 2), by_views = found(scene, {.blocks = false}, 2);
    EXPECT_EQ(wrong(scene, by_scene), "");
    EXPECT_EQ(wrong(scene, by_views), "");
    uneven += has_stage(by_scene, Reason::join_uneven);
    others += has_stage(by_scene, Reason::block_pairs);
    given_up += has_stage(by_views, Reason::join_many_tests);
  }
  EXPECT_GT(uneven, 0u);
  EXPECT_GT(others, 0u);
  EXPECT_GT(given_up, 0u);
}

// A view that is never given up.
TEST(StraysTwin, WithoutALimitTakeTooMuchWork) {
  const Scene scene = stray_scene(0, 5000, {.outliers = 3, .surface = true, .exponent = 7});
  EXPECT_EQ(wrong(scene, found(scene, {.blocks = false}, 2)), "");
  EXPECT_TRUE(
      wrong(scene, found(scene, {.blocks = false}, 2, false)).starts_with("too many tests"));
}

// The scenes in which a stray vertex took half a minute, smaller.
TEST(Strays, OfAScanWithABadVertexOrTriangle) {
  for (const double far : {1e4, 3e4, 1e30, 1e300}) {
    for (const bool self : {true, false}) {
      Scene scene = make_builtin_scene("two-spheres");
      if (self) scene = with_self(std::move(scene));
      for (const Object& object : scene.objects)
        scene.vertices[scene.triangles[object.first_triangle + 77][1]] = Vec3(far, 1, -0.5 * far);
      const PairResult result = found(scene, {}, 2);
      EXPECT_EQ(wrong(scene, result), "") << far;
      EXPECT_TRUE(has_stage(result, Reason::join_uneven));
      const PairPlan plan = plan_pairs(scene, {});
      EXPECT_EQ(plan.join, Reason::join_uneven) << "the plan says so";
      EXPECT_EQ(planned_stages(plan).back().reason, Reason::join_uneven);
    }
  }
}

// Neighbours and ignored objects are left out of the tree as well, and a clearance finds more.
TEST(Strays, KeepTheQuestion) {
  Scene scene = with_self(make_builtin_scene("two-spheres"));
  scene.vertices[scene.triangles[5][0]] = Vec3(1e9, 0, 0);
  const std::size_t all = found(scene, {}, 2).candidates.size();
  PairSettings settings{.neighbours = false};
  const PairResult apart = found(scene, settings, 2);
  EXPECT_LT(apart.candidates.size(), all);
  for (const TrianglePair& pair : apart.candidates)
    ASSERT_FALSE(share_index(scene.triangles[pair.a], scene.triangles[pair.b]));
  settings = {.ignored = {{0, 1}}};
  const std::vector<std::uint32_t> owner = owners(scene);
  for (const TrianglePair& pair : found(scene, settings, 2).candidates)
    ASSERT_EQ(owner[pair.a], owner[pair.b]);
  settings = {.clearance = 0.01};
  const PairResult wide = found(scene, settings, 2);
  EXPECT_TRUE(has_stage(wide, Reason::join_uneven));
  EXPECT_GT(wide.candidates.size(), all);
  EXPECT_EQ(lab::missed(lab::truth_of(scene, 0.01), wide.candidates), 0u);
}

// Whether a view is given up is decided by all work together: one limit, whatever the threads.
TEST(Strays, AViewIsGivenUpAtTheSameWorkWhateverTheThreads) {
  for (const char* name : {"needles", "fans:2000"}) {
    const Scene scene = make_builtin_scene(name);
    PairPlan plan = plan_pairs(scene, {.blocks = false});
    PairWorkspace workspace;
    const auto given_up = [&](std::uint64_t most, unsigned threads) {
      plan.most_tests = most;
      const PairResult result = find_pairs(scene, plan, *cpu_pair_backend(threads), workspace);
      return has_stage(result, Reason::join_many_tests);
    };
    std::uint64_t low = 0, high = std::uint64_t{1} << 32;  // given up at low, not at high
    ASSERT_TRUE(given_up(low, 1));
    ASSERT_FALSE(given_up(high, 1));
    while (high - low > 1) {
      const std::uint64_t middle = low + (high - low) / 2;
      (given_up(middle, 1) ? low : high) = middle;
    }
    for (const unsigned threads : {2u, 3u, 7u}) {
      EXPECT_TRUE(given_up(low, threads)) << name << " " << low;
      EXPECT_FALSE(given_up(high, threads)) << name << " " << high;
    }
  }
}

// A vertex that flies away and comes back, with what is kept of each frame.
TEST(Strays, InFramesAreFoundAsWithoutThem) {
  const Scene rest = make_builtin_scene("two-spheres");
  PairWorkspace workspace;
  std::size_t uneven = 0;
  const double places[] = {0, 0, 1e6, 1e6, 1e30, 0, 0, 0};
  for (std::size_t frame = 0; frame < std::size(places); ++frame) {
    Scene scene = rest;
    if (places[frame] > 0) scene.vertices[scene.triangles[100][0]] = Vec3(places[frame], 0, 0);
    scene.vertices[scene.triangles[200][0]].x() += 1e-3 * static_cast<double>(frame);
    const PairPlan plan = plan_pairs(scene, {}, 2, &workspace.memory);
    const PairResult result = find_pairs(scene, plan, *cpu_pair_backend(2), workspace);
    uneven += has_stage(result, Reason::join_uneven);
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

// Where a list fills up, only what the caller still wants stays.
TEST(PairPool, HoldsNoMoreThanItsBufferAndWhatIsNotNarrowedAway) {
  const auto most_held = [](PairPool::Narrow narrow) {
    PairPool pool(1, 1000, std::move(narrow));
    std::size_t most = 0;
    for (std::uint32_t a = 0; a < 300; ++a) {
      for (std::uint32_t b = a + 1; b < 300; ++b) pool.add(0, {a, b});
      most = std::max(most, pool.held());
    }
    return most;
  };
  EXPECT_LE(most_held([](std::vector<TrianglePair>& pairs) {
              std::erase_if(pairs, [](const TrianglePair& pair) { return pair.b != pair.a + 1; });
            }),
            1300u);
  EXPECT_GT(most_held({}), 20'000u);
}

}  // namespace
}  // namespace farcull
