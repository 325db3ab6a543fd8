// FAR pairs where one rule alone keeps a pair: each scene loses it when that rule is taken away.
#include "core/base/stopwatch.h"
#include "core/pairs/backend.h"
#include "core/pairs/lists.h"
#include "core/pairs/tile.h"
#include "core/scene/pair_sort.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::Changed;
using lab::missed;
using lab::Random;
using lab::scene_of;
using lab::truth_of;
using Corners = std::array<Vec3, 3>;

// Two objects with the same box, so that the pixel grid is known.
std::vector<std::vector<Corners>> two_objects(const Vec3& lo, const Vec3& hi) {
  return {{{lo, lo, lo}, {hi, hi, hi}}, {{lo, lo, lo}, {hi, hi, hi}}};
}

// Small triangles in a box, for each object in turn, that fill its pixels.
void fill(std::vector<std::vector<Corners>>& objects, int count, const Vec3& lo, const Vec3& hi,
          double size, Random& random) {
  for (int n = 0; n < count; ++n) {
    const Vec3 p(random.between(lo.x(), hi.x()), random.between(lo.y(), hi.y()),
                 random.between(lo.z(), hi.z()));
    objects[n % 2].push_back({p, p + Vec3(size, 0, size / 2), p + Vec3(0, size, size / 4)});
  }
}

TEST(PairsEdges, NoViewResolvesWhatIsBeyondDouble) {
  constexpr double m = 1.5e308;
  const Scene scene = scene_of({{{Vec3(-m, 0, 0), Vec3(m, 0, 0), Vec3(0, m, m)}},
                                {{Vec3(-m, -m, 0), Vec3(m, 1, 0), Vec3(0, m, 0)}}});
  const auto backend = cpu_pair_backend(2);
  ASSERT_EQ(truth_of(scene).size(), 1u);
  EXPECT_EQ(missed(scene, {}, *backend), 0u);
  const PairSettings given{.views = parse_views("z")};
  EXPECT_EQ(missed(scene, given, *backend), 0u);
  EXPECT_EQ(find_pairs(scene, given, *backend).stages.back().kind, StageKind::join);
}

// A triangle that no view can show is compared with all others, and they are not joined for its
// sake: the boxes of these needles overlap 45 million times.
TEST(PairsEdges, ATriangleThatNoViewShowsCostsLittle) {
  Scene scene = make_builtin_scene("needles-layers");
  const auto backend = cpu_pair_backend(2);
  const auto timed = [&](PairResult& result) {
    const Stopwatch watch;
    result = find_pairs(scene, {}, *backend);
    return watch.ms();
  };
  PairResult before, after;
  const double without = std::min(timed(before), timed(before));
  const Vec3 far = Vec3(1, 1, 1) * 0x1p60;
  add_triangle(scene, {-far, far, far + Vec3(0, 0, 0x1p10)});
  ++scene.objects.back().triangle_count;
  const double with = std::min(timed(after), timed(after));
  ASSERT_EQ(after.views.size(), 1u);
  EXPECT_EQ(after.views[0].counts.undrawable, 1u);
  EXPECT_GT(after.candidates.size(), before.candidates.size());
  EXPECT_EQ(missed(decide(scene, before.candidates).pairs, after.candidates), 0u);
  // A join of all boxes takes more than twenty times as long.
  EXPECT_LT(with, 8 * without);
}

TEST(PairsEdges, TheLeastClearanceIsOne) {
  constexpr double least = 5e-324;
  const Scene scene = scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                                {{Vec3(0, 0, least), Vec3(1, 0, least), Vec3(0, 1, least)}}});
  const auto backend = cpu_pair_backend(2);
  ASSERT_EQ(truth_of(scene, least).size(), 1u);
  EXPECT_EQ(missed(scene, {.clearance = least}, *backend), 0u);
}

// Two whole triangles that start in a crowded pixel, where finer intervals part them, and meet in
// the next one.
TEST(PairsEdges, APairThatMeetsBesideACrowdedPixel) {
  Random random(3);
  auto objects = two_objects(Vec3(0, 0, -1), Vec3(8, 8, 2));
  fill(objects, 3000, Vec3(3.02, 3.02, 0), Vec3(3.96, 3.96, 1), 0.02, random);
  objects[0].push_back({Vec3(3.2, 3.2, 0), Vec3(4.8, 3.2, 1), Vec3(4.8, 3.8, 1)});
  objects[1].push_back({Vec3(3.2, 3.8, 0.9), Vec3(4.8, 3.8, 0.6), Vec3(4.8, 3.2, 0.6)});
  const Scene scene = scene_of(objects);
  const PairSettings settings{.views = parse_views("z"), .resolution = 8};
  // With so little memory each pixel is a tile of its own.
  for (const std::size_t memory : {std::size_t{256} << 20, std::size_t{1}}) {
    const auto backend = cpu_pair_backend(2, memory);
    EXPECT_EQ(missed(scene, settings, *backend), 0u) << memory;
    EXPECT_GT(find_pairs(scene, settings, *backend).views[0].counts.crowded, 0u);
  }
}

// Two whole triangles, one of which begins a row before the other, in a tile with a crowded pixel.
TEST(PairsEdges, APairOfWhichOneBeginsEarlierBesideACrowdedPixel) {
  const auto backend = cpu_pair_backend(2);
  for (const int row : {1, 2, 3, 4, 5}) {
    for (const int first : {0, 1}) {
      Random random(3);
      auto objects = two_objects(Vec3(0, 0, -1), Vec3(8, 8, 2));
      fill(objects, 3000, Vec3(6.02, row + 0.02, 0), Vec3(6.96, row + 0.96, 1), 0.02, random);
      objects[first].push_back(
          {Vec3(3.2, row + 0.2, 0), Vec3(3.8, row + 1.8, 0.5), Vec3(3.2, row + 1.8, 0.5)});
      objects[1 - first].push_back(
          {Vec3(3.2, row + 1.5, 0.4), Vec3(3.8, row + 1.5, 0.6), Vec3(3.8, row + 1.7, 0.3)});
      const Scene scene = scene_of(objects);
      const PairSettings settings{.views = parse_views("z"), .resolution = 8};
      EXPECT_EQ(missed(scene, settings, *backend), 0u) << row;
      EXPECT_GT(find_pairs(scene, settings, *backend).views[0].counts.crowded, 0u);
      const std::vector<TrianglePair> truth = truth_of(scene);
      const TrianglePair last{scene.objects[1].first_triangle - 1,
                              static_cast<std::uint32_t>(scene.triangles.size()) - 1};
      EXPECT_TRUE(std::ranges::binary_search(truth, last));
    }
  }
}

// A large triangle is compared with small ones by itself, over their rectangles. Those here are a
// little nearer than the clearance, beside it along the depth.
TEST(PairsEdges, LargeTrianglesWithinAClearance) {
  const auto backend = cpu_pair_backend(2);
  for (const double slope : {0.0, 0.3}) {
    const Vec3 along(1, 0, slope), up(0, 1, 0);
    const Vec3 normal = along.cross(up).normalized();
    std::vector<std::vector<Corners>> objects(2);
    objects[0].push_back({Vec3(0, 0, 0), 100 * along, 100 * up});
    for (int n = 0; n < 40; ++n) {
      const Vec3 p = (2 + n) * along + 20 * up + (n % 2 ? 0.95 : -0.95) * normal;
      objects[1].push_back({p, p + 0.5 * along, p + 0.5 * up});
    }
    const Scene scene = scene_of(objects);
    const PairSettings settings{
        .views = parse_views("z"), .resolution = 1024, .clearance = 1, .blocks = false};
    ASSERT_EQ(truth_of(scene, 1).size(), 40u);
    EXPECT_EQ(missed(scene, settings, *backend), 0u) << slope;
    EXPECT_EQ(find_pairs(scene, settings, *backend).views[0].counts.large, 1u);
  }
}

// Triangles of many sub-pixels that touch in one point, among crumbs that make the pixels crowded.
TEST(PairsEdges, ContactsInCrowdedPixels) {
  const auto backend = cpu_pair_backend(2);
  for (const std::uint64_t seed : {1u, 2u}) {
    Random random(seed);
    auto objects = two_objects(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    constexpr std::uint32_t contacts = 200;
    for (std::uint32_t n = 0; n < contacts; ++n) {
      const Vec3 q(random.between(-0.7, 0.7), random.between(-0.7, 0.7), random.between(-0.9, 0.9));
      const auto away = [&](double sign) {
        return Vec3(q + Vec3(random.between(-0.16, 0.16), random.between(-0.16, 0.16),
                             sign * random.between(0.004, 0.2)));
      };
      objects[0].push_back({q, away(1), away(1)});
      objects[1].push_back({q, away(-1), away(-1)});
    }
    fill(objects, 40000, Vec3(-0.99, -0.99, -0.9), Vec3(0.98, 0.98, 0.9), 0.005, random);
    const Scene scene = scene_of(objects);
    const PairResult result =
        find_pairs(scene, {.views = parse_views("z"), .resolution = 4}, *backend);
    EXPECT_GT(result.views[0].counts.crowded, 0u);
    for (std::uint32_t n = 2; n < 2 + contacts; ++n) {
      const TrianglePair contact{n, scene.objects[1].first_triangle + n};
      EXPECT_TRUE(std::ranges::binary_search(result.candidates, contact));
    }
  }
}

// The double term of the widening: vertices may lie anywhere within it.
std::size_t missed_when_moved(Changed::Change change) {
  Changed backend(change);
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    auto objects = two_objects(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    for (int n = 0; n < 20; ++n) {  // the same sheet, parallel to the image, in both
      const Vec3 q(random.between(-0.9, 0.9), random.between(-0.9, 0.9), random.between(-0.9, 0.9));
      for (auto& object : objects)
        object.push_back({q, q + Vec3(0.05, 0, 0), q + Vec3(0, 0.05, 0)});
    }
    count += missed(scene_of(objects), {.views = parse_views("z"), .resolution = 16}, backend);
  }
  return count;
}

void move(PairTask& task) {
  static std::vector<PixelVertex> moved;
  moved.assign(task.vertices.begin(), task.vertices.end());
  for (std::size_t v = 0; v < moved.size(); ++v) moved[v].z += v / 3 % 2 ? 0x1.fp-11f : -0x1.fp-11f;
  task.vertices = moved;
}

TEST(PairsEdges, VerticesAnywhereWithinTheDoubleTerm) { EXPECT_EQ(missed_when_moved(move), 0u); }

TEST(PairsTwin, WithoutTheDoubleTermMovedVerticesMiss) {
  EXPECT_GT(missed_when_moved([](PairTask& task) {
              move(task);
              task.widening = {0x1p-40f, 0x1p-40f, 0x1p-40f, 0};
            }),
            0u);
}

// ---- Pairs that are found in many pixels: they are held and compared about once, and the answer
// is that of every pixel looked at by itself.

using lab::coincident;
using lab::for_each_task;

TEST(SettledPairs, HoldNothingThatWasNotSettled) {
  Random random(1);
  SettledPairs table;
  std::size_t held = 0;
  for (int window = 0; window < 20; ++window) {
    table.start(1 << (4 + window % 12));
    std::set<std::pair<std::uint32_t, std::uint32_t>> settled;
    std::uint32_t round = table.round();
    for (int list = 0; list < 60; ++list) {
      const std::size_t n = 1 + static_cast<std::size_t>(random.below(64));
      ASSERT_TRUE(table.reserve(n));
      if (table.round() != round) settled.clear();
      round = table.round();
      std::vector<std::uint32_t> triangles, numbers;
      for (std::size_t k = 0; k < n; ++k) {
        triangles.push_back(static_cast<std::uint32_t>(random.below(200)) << (window % 20));
        numbers.push_back(table.number(triangles.back()));
      }
      ASSERT_EQ(table.row(numbers[0]).size(), table.words());
      for (std::size_t a = 0; a < n; ++a) {
        for (std::size_t b = 0; b < n; ++b) {
          const bool known = settled.contains({triangles[a], triangles[b]});
          ASSERT_EQ(table.settled(numbers[a], numbers[b]), known);
          held += known;
          if (random.below(8) != 0) continue;
          table.settle(numbers[a], numbers[b]);
          settled.insert({triangles[a], triangles[b]});
          settled.insert({triangles[b], triangles[a]});
        }
      }
    }
  }
  EXPECT_GT(held, 10000u);
  EXPECT_FALSE(table.reserve(std::size_t{1} << 30));
}

TEST(PairPool, HoldsTheDistinctPairsAndItsBuffer) {
  Random random(2);
  for (const std::size_t buffer : {1u, 100u, 5000u}) {
    for (const int range : {3, 40, 300}) {
      PairPool pool(2, buffer);
      std::set<TrianglePair> distinct;
      for (int n = 0; n < 200'000; ++n) {
        const TrianglePair pair{static_cast<std::uint32_t>(random.below(range)),
                                static_cast<std::uint32_t>(random.below(range))};
        distinct.insert(pair);
        pool.add(static_cast<std::size_t>(n % 2), pair);
        ASSERT_LE(pool.held(), distinct.size() + std::max(buffer, distinct.size()) + 2);
      }
      const std::vector<TrianglePair> all = pool.take(1);
      EXPECT_TRUE(std::equal(all.begin(), all.end(), distinct.begin(), distinct.end()));
    }
  }
}

/// Raw pairs of tiles of `side` pixels, each by itself; large triangles are listed like others.
template <class Rules = TileRules>
std::vector<TrianglePair> raw_pairs(const PairTask& task, int side, std::size_t memory) {
  const PairGrid grid(task);
  std::vector<PairItem> items;
  for (const std::uint32_t t : task.active) {
    const PairBounds bounds = grid.bounds(t);
    if (!bounds.empty()) items.push_back(grid.item(t, bounds));
  }
  const bool masked = std::ranges::any_of(task.self, [](std::uint8_t self) { return self == 0; });
  PairPool pool(1, 1000);
  TileWorker<Rules> worker;
  PairCounts counts;
  for (int j = 0; j < task.height; j += side) {
    for (int i = 0; i < task.width; i += side) {
      worker.begin(grid, masked, memory, pool, 0);
      worker.run({i, std::min(i + side, task.width) - 1, j, std::min(j + side, task.height) - 1},
                 items, counts);
    }
  }
  return pool.take(1);
}

// A tile of one pixel with a table too small for long lists: each pixel reports all of its pairs.
constexpr std::size_t kPlenty = std::size_t{1} << 28, kSome = 1 << 17, kNoTable = 1;

TEST(PairsRepeated, TheAnswerIsThatOfEveryPixelByItself) {
  std::size_t pairs = 0;
  for_each_task([&](const PairTask& task, const std::string& name) {
    SCOPED_TRACE(name);
    const std::vector<TrianglePair> unfiltered = raw_pairs(task, 1, kNoTable);
    pairs += unfiltered.size();
    EXPECT_EQ(raw_pairs(task, 1 << 15, kPlenty), unfiltered);
    EXPECT_EQ(raw_pairs(task, 1 << 15, kSome), unfiltered);
    EXPECT_EQ(raw_pairs(task, 3, kSome), unfiltered);
    PairCounts counts;
    const auto of_pixels = cpu_pair_backend(1, 1)->raw_pairs(task, counts);
    EXPECT_EQ(cpu_pair_backend(1)->raw_pairs(task, counts), of_pixels);
    EXPECT_EQ(cpu_pair_backend(3, kSome)->raw_pairs(task, counts), of_pixels);
  });
  EXPECT_GT(pairs, 1'000'000u);
}

// Twins of the two rules that pass pairs over.
struct SettlesApart : TileRules {
  static constexpr bool kSettlesApart = true;
};
// A pair of whole triangles is left to the first pixel of either of them.
struct WrongPixel : TileRules {
  static std::uint32_t begun(bool left, bool below) { return left || below ? 3 : 0; }
};

template <class Rules>
std::size_t lost() {
  std::size_t count = 0;
  for_each_task([&](const PairTask& task, const std::string&) {
    if (count > 100) return;  // enough
    count += lab::missed(raw_pairs(task, 1, kNoTable), raw_pairs<Rules>(task, 1 << 15, kPlenty));
  });
  return count;
}
TEST(PairsRepeatedTwin, SettledWhereTheirIntervalsAreApartPairsAreLost) {
  EXPECT_GT(lost<SettlesApart>(), 100u);
}
TEST(PairsRepeatedTwin, LeftToAWrongPixelPairsAreLost) { EXPECT_GT(lost<WrongPixel>(), 100u); }

// A pixel of 2 n entries used to take n (2 n - 1) comparisons, in each of more than a hundred.
TEST(PairsRepeated, CoincidentTrianglesAreComparedOnce) {
  constexpr int kCount = 400;
  const auto backend = cpu_pair_backend(1);
  for (const double apart : {0.0, 1e-9}) {
    const Scene scene = coincident(kCount, apart, 9);
    PairPlan plan = plan_pairs(scene, {.views = parse_views("z"), .resolution = 18}, 1);
    plan.most_tests = UINT64_MAX;  // which counts those that are passed over as well
    PairWorkspace workspace;
    const PairResult result = find_pairs(scene, plan, *backend, workspace);
    EXPECT_EQ(result.candidates.size(), std::size_t{kCount} * kCount);
    EXPECT_GT(result.views[0].counts.entries, std::uint64_t{100} * 2 * kCount);
    EXPECT_LT(result.views[0].counts.tests, std::uint64_t{4} * 2 * kCount * kCount);
  }
}

// Further views of what lies on itself take nothing away: a sample shows it.
TEST(PairsRepeated, NoFurtherViewWhereItTakesNothingAway) {
  const auto backend = cpu_pair_backend(2);
  const Scene scene = coincident(300, 0, 10);
  const PairResult by_runs = find_pairs(scene, {}, *backend);
  EXPECT_EQ(by_runs.candidates.size(), 90'000u);
  EXPECT_TRUE(by_runs.views.empty());
  const PairResult result = find_pairs(scene, {.resolution = 32}, *backend);
  EXPECT_EQ(result.candidates, by_runs.candidates);
  EXPECT_EQ(result.views.size(), 1u);
  EXPECT_TRUE(std::ranges::any_of(result.stages, [](const Stage& stage) {
    return !stage.ran && reason_of(stage) == "it keeps all of a sample of the candidates";
  }));
}

}  // namespace
}  // namespace farcull
