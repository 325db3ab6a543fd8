// Pairs that are sorted, and collected in bounded memory.
#include "core/scene/pair_sort.h"

#include "tests/lab/scenes.h"

namespace farcull {
namespace {

TEST(PairSort, SortsAndDropsDuplicates) {
  lab::Random random(9);
  for (int round = 0; round < 200; ++round) {
    const int range = 1 + random.below(1000);
    std::vector<std::vector<TrianglePair>> parts(1 + random.below(5));
    std::set<TrianglePair> expected;
    for (auto& part : parts) {
      for (int n = random.below(round % 2 ? 20 : 9000); n > 0; --n) {
        const auto a = static_cast<std::uint32_t>(random.below(range));
        const auto b = static_cast<std::uint32_t>(random.below(5000));
        part.push_back({a, b});
        expected.insert({a, b});
      }
    }
    for (const unsigned threads : {1u, 3u}) {
      const std::vector<TrianglePair> sorted = sorted_unique(parts, threads);
      ASSERT_TRUE(std::equal(sorted.begin(), sorted.end(), expected.begin(), expected.end()));
    }
    const std::vector<TrianglePair> sorted = sorted_unique(std::move(parts), 2);
    ASSERT_TRUE(std::equal(sorted.begin(), sorted.end(), expected.begin(), expected.end()));
  }
  EXPECT_TRUE(sorted_unique(std::span<const std::vector<TrianglePair>>(), 1).empty());
}

TEST(PairPool, HoldsTheDistinctPairsAndItsBuffer) {
  lab::Random random(2);
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

}  // namespace
}  // namespace farcull
