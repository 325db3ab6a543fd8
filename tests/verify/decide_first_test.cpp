// The first colliding candidates: always a prefix of all of them, and no more is decided than that
// takes.
#include "tests/lab/rational.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

/// An object of triangles between points of a grid, against itself, and all its pairs.
struct Tangle {
  Scene scene;
  std::vector<TrianglePair> pairs;
};
Tangle tangle(std::uint32_t triangles) {
  rational::Random random(641);
  Tangle out;
  for (int i = 0; i < 125; ++i) out.scene.vertices.emplace_back(i % 5, i / 5 % 5, i / 25);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) corner = random.below(125u);
    out.scene.triangles.push_back(corners);
    out.scene.source_face.push_back(t);
    for (std::uint32_t a = 0; a < t; ++a) out.pairs.push_back({a, t});
  }
  out.scene.objects.push_back({"", 0, triangles, true});
  std::ranges::sort(out.pairs);
  return out;
}

TEST(DecideFirst, GivesAPrefixOfAllThatCollide) {
  const Tangle all = tangle(120);
  const std::vector<TrianglePair> expected = decide(all.scene, all.pairs).all();
  ASSERT_GT(expected.size(), 500u);
  for (const unsigned threads : {1u, 2u}) {
    for (const std::uint64_t limit : {std::uint64_t{1}, std::uint64_t{100}, expected.size() - 1,
                                      expected.size(), expected.size() + 1}) {
      const FirstCollisions first = decide_first(all.scene, all.pairs, limit, {.threads = threads});
      const std::vector<TrianglePair> found = first.collisions.all();
      const auto end = expected.begin() + static_cast<long>(std::min(limit, expected.size()));
      EXPECT_EQ(found, std::vector<TrianglePair>(expected.begin(), end)) << limit;
      EXPECT_EQ(first.complete, limit >= expected.size() && first.decided == all.pairs.size());
      if (limit == 1) {
        EXPECT_LT(first.decided, all.pairs.size() / 2);
      }
      if (limit > expected.size()) {
        EXPECT_TRUE(first.complete);
      }
      // The twin: what is decided ends at or behind the last pair; a block less does not suffice.
      EXPECT_GE(all.pairs[first.decided - 1], found.back());
    }
  }
}

// Exactly as many pairs collide as the limit allows, and the last of them stands before many
// candidates that do not.
TEST(DecideFirst, NumberOfThreadsDecidesNothing) {
  const Tangle all = tangle(120);
  const std::vector<TrianglePair> meet = decide(all.scene, all.pairs).all();
  const TrianglePair one = meet.front();
  std::vector<TrianglePair> candidates;
  for (const TrianglePair& pair : all.pairs)
    if (pair == one || (one < pair && !std::ranges::binary_search(meet, pair)))
      candidates.push_back(pair);
  ASSERT_GT(candidates.size(), 3000u);
  const FirstCollisions first = decide_first(all.scene, candidates, 1, {.threads = 1});
  EXPECT_EQ(first.collisions.all(), std::vector<TrianglePair>{one});
  EXPECT_FALSE(first.complete);
  for (const unsigned threads : {2u, 3u, 16u}) {
    const FirstCollisions other = decide_first(all.scene, candidates, 1, {.threads = threads});
    EXPECT_EQ(other.decided, first.decided);
    EXPECT_EQ(other.complete, first.complete);
  }
}

TEST(DecideFirst, OfNoCandidatesIsComplete) {
  const Tangle all = tangle(3);
  const FirstCollisions none = decide_first(all.scene, {}, 1);
  EXPECT_TRUE(none.complete);
  EXPECT_EQ(none.decided, 0u);
  EXPECT_THROW(decide_first(all.scene, {}, 0), std::logic_error);
  EXPECT_THROW(decide_first(all.scene, std::vector<TrianglePair>{{0, 3}}, 1), std::logic_error);
}

TEST(KeepFirst, CutsTheLastOfBothLists) {
  Collisions some;
  some.pairs = {{0, 1}, {0, 5}, {2, 3}};
  some.neighbour_pairs = {{0, 2}, {2, 4}};
  EXPECT_FALSE(keep_first(5, some));
  EXPECT_TRUE(keep_first(3, some));
  EXPECT_EQ(some.pairs, (std::vector<TrianglePair>{{0, 1}, {0, 5}}));
  EXPECT_EQ(some.neighbour_pairs, (std::vector<TrianglePair>{{0, 2}}));
  EXPECT_TRUE(keep_first(1, some));
  EXPECT_EQ(some.pairs, (std::vector<TrianglePair>{{0, 1}}));
  EXPECT_TRUE(some.neighbour_pairs.empty());
}

}  // namespace
}  // namespace farcull
