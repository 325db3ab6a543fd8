// The method boxes takes no more work than `exact`, a constant factor apart, wherever triangles lie
// and however large they are. Work is counted, so that a loaded machine changes nothing.
#include "core/boxes/block.h"
#include "core/proximity/near_pairs.h"
#include "core/scene/pair_sort.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::Random;

constexpr int kTriangles = 8000;  // of an object

struct Strays {
  int outliers = 0;      // 0 to 10: triangles, or corners of triangles
  double decades = 0;    // 0 to 300: of the sizes of the others
  bool spread = false;   // their places spread as their sizes do
  bool surface = false;  // instead of triangles anywhere in a cube: two sheets, in any order
  bool self = false;     // one object with itself, instead of two
  double exponent = -1;  // of the size of outliers, to base 10; negative: each one of 0 to 300
};

Strays random_strays(std::uint64_t seed) {
  Random random(seed);
  Strays out;
  out.outliers = random.below(11);
  out.surface = random.below(3) == 0;
  const double most[] = {0, 0, 8, 30, 300};
  out.decades = out.surface ? 0 : random.between(0, most[random.below(5)]);
  out.spread = random.below(2) == 0;
  out.self = random.below(2) == 0;
  return out;
}

Scene stray_scene(std::uint64_t seed, int triangles, const Strays& strays) {
  Random random(seed);
  const auto direction = [&] {
    return Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  };
  std::vector<std::vector<std::array<Vec3, 3>>> objects(strays.self ? 1 : 2);
  const int side = std::max(1, static_cast<int>(std::sqrt(0.5 * triangles)));
  for (std::size_t o = 0; o < objects.size(); ++o) {
    auto& object = objects[o];
    for (int t = 0; t < triangles; ++t) {
      if (strays.surface) {
        const double x = (t / 2) % side, y = (t / 2) / side;
        const auto at = [&](double i, double j) {
          return Vec3(i, j, 3 * std::sin(0.21 * i + static_cast<double>(o)) * std::cos(0.17 * j));
        };
        object.push_back(t % 2 ? std::array<Vec3, 3>{at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}
                               : std::array<Vec3, 3>{at(x, y), at(x + 1, y), at(x, y + 1)});
        continue;
      }
      // The largest is a tenth of the cube, so that most boxes meet few others.
      const double size = std::pow(10, random.between(-strays.decades, 0) - 1);
      const double scale = strays.spread ? 10 * size * std::pow(10, 0.5 * strays.decades) : 1;
      const double part = strays.spread ? 0.05 * scale : size;
      const Vec3 place = scale * direction();
      object.push_back(
          {place + part * direction(), place + part * direction(), place + part * direction()});
    }
    if (strays.surface) {
      for (std::size_t k = object.size(); k > 1; --k)
        std::swap(object[k - 1],
                  object[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
    }
  }
  for (int k = 0; k < strays.outliers; ++k) {
    auto& object =
        objects[static_cast<std::size_t>(random.below(static_cast<int>(objects.size())))];
    auto& one = object[static_cast<std::size_t>(random.below(static_cast<int>(object.size())))];
    const double far =
        std::pow(10, strays.exponent >= 0 ? strays.exponent : random.between(0, 300));
    const int kind = random.below(3);
    const Vec3 by = far * direction();
    if (kind == 0)  // huge
      one = {by, far * direction(), far * direction()};
    else if (kind == 1)  // a bad corner
      one[0] = by;
    else  // as large as before, far away
      for (Vec3& corner : one) corner += by;
  }
  Scene scene = lab::scene_of(objects);
  scene.objects[0].self = strays.self;
  return scene;
}

/// What a run of boxes compared and listed.
struct BoxesWork {
  double tests = 0;  // boxes compared
  double lists = 0;  // pairs in its longest list
};

BoxesWork work_of(const BoxesResult& result) {
  const Stage& stage = result.stage;
  const auto n = static_cast<double>(stage.n), m = static_cast<double>(stage.m);
  const bool blocks = stage.kind == StageKind::blocks;
  return {.tests = blocks ? 256 * n : 16 * m,
          .lists = std::max(blocks ? n : 0, static_cast<double>(result.candidates.size()))};
}

/// What it may take. `exact` looks at each triangle and at each pair of boxes that overlap. A
/// triangle costs it about as much time as 1,024 comparisons of boxes cost blocks, a pair as much
/// as 64: three times that, and a constant for small scenes.
BoxesWork most_work(std::size_t triangles, std::size_t box_pairs) {
  const auto n = static_cast<double>(triangles), k = static_cast<double>(box_pairs);
  return {.tests = 3 * (1024 * n + 64 * k) + 0x1p20, .lists = 3 * (24 * n + k) + 1e4};
}

BoxesResult found(const Scene& scene, const BoxesSettings& settings, unsigned threads) {
  return find_boxes(scene, plan_boxes(scene, settings, threads));
}

// "" if a result is right and took no more work than it may.
std::string wrong(const Scene& scene, const BoxesResult& result) {
  const ExactResult exact = all_colliding_pairs(scene);
  if (lab::missed(exact.all(), result.candidates) > 0) return "missed a pair";
  for (const TrianglePair& pair : result.candidates)
    if (!boxes_meet(scene, pair, 0)) return "a candidate whose boxes are apart";
  const BoxesWork work = work_of(result);
  const BoxesWork most = most_work(scene.triangles.size(), exact.box_pairs);
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

// Three triangles in a hundred are large, in a file that scatters them all.
TEST(Strays, LargeTrianglesAreInBlocksOfTheirOwn) {
  const Scene rest = make_builtin_scene("funnel:12000:400");
  const auto pairs_of = [](const TriangleBlocks& blocks) {
    std::vector<BlockPair> pairs;
    pair_blocks(BlockTrees(blocks, blocks.objects), 0, 0, 0, blocks.first[1], SIZE_MAX, pairs);
    return pairs.size();
  };
  const Scene scattered = lab::shuffled(rest, 7);
  const BoxesResult result = found(scattered, {}, 2);
  EXPECT_EQ(wrong(scattered, result), "");
  EXPECT_EQ(result.stage.reason, Reason::normal_pairs);
  const std::size_t own = pairs_of(make_ordered_blocks(scattered, 0, 2));
  EXPECT_EQ(result.stage.n, own);
  // The twin: among the small ones, each near the place where it lies, they enlarge their blocks.
  const auto& triangles = rest.triangles;
  const std::size_t large = 400, small = triangles.size() - large;
  Scene among = rest;
  among.triangles.clear();
  for (std::size_t k = 0; k < small; ++k) {
    among.triangles.push_back(triangles[k]);
    if (k % (small / large) == 0 && among.triangles.size() < k + large)
      among.triangles.push_back(triangles[small + k / (small / large)]);
  }
  while (among.triangles.size() < triangles.size())
    among.triangles.push_back(triangles[among.triangles.size()]);
  EXPECT_GT(pairs_of(make_blocks(among, 0, 2)), 4 * own);
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

}  // namespace
}  // namespace farcull
