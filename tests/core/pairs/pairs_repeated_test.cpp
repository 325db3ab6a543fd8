// Pairs that are found in many pixels: they are held and compared about once, and the answer is
// that of every pixel looked at by itself.
#include "core/pairs/backend.h"
#include "core/pairs/lists.h"
#include "core/pairs/tile.h"
#include "core/scene/pair_sort.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::coincident;
using lab::for_each_task;
using lab::Random;

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
