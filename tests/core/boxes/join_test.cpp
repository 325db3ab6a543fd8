// The box join finds the pairs that brute force finds.
#include "core/boxes/join.h"

#include <rapidcheck/gtest.h>

#include "tests/lab/boxes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::Indices, lab::overlapping, lab::Pairs, rational::Random;

Pairs brute_force(const std::vector<Box>& boxes, const Indices& owners, const Indices& items) {
  std::vector<bool> taken(boxes.size());
  for (const std::uint32_t item : items) taken[item] = true;
  return lab::brute_force(boxes, [&](std::uint32_t a, std::uint32_t b) {
    return owners[a] != owners[b] && taken[a] && taken[b];
  });
}

void expect_as_brute_force(const std::vector<Box>& boxes, const Indices& owners,
                           const Indices& items) {
  const Pairs expected = brute_force(boxes, owners, items);
  const Pairs found = box_join(boxes, owners, items);
  ASSERT_EQ(found, expected);
}

Indices all(std::size_t count) {
  Indices items(count);
  std::iota(items.begin(), items.end(), 0u);
  return items;
}

TEST(SweepJoin, EqualPointsAllMeet) {
  const std::vector<Box> boxes(20, Box{Vec3(1, 2, 3), Vec3(1, 2, 3)});
  expect_as_brute_force(boxes, all(20), all(20));
  EXPECT_EQ(box_join(boxes, all(20), all(20)).size(), 190u);
}

TEST(SweepJoin, EmptyBoxesMeetNothingEvenWhenEmptyAlongOneAxisOnly) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Box> boxes(4, Box{Vec3::Constant(-1), Vec3::Constant(1)});
    std::swap(boxes[1].lo[axis], boxes[1].hi[axis]);
    boxes[2] = Box::empty();
    EXPECT_EQ(box_join(boxes, all(4), all(4)), (Pairs{{0, 3}}));
  }
}

// The order of -0.0 and 0.0 must not matter.
TEST(SweepJoin, TheEndsOfTheDoubles) {
  const std::vector<Box> boxes = {{Vec3::Constant(-DBL_MAX), Vec3::Constant(DBL_MAX)},
                                  {Vec3::Constant(-DBL_MAX), Vec3::Constant(-DBL_MAX)},
                                  {Vec3::Constant(0.0), Vec3::Constant(0.0)},
                                  {Vec3::Constant(-0.0), Vec3::Constant(-0.0)},
                                  {Vec3::Constant(5e-324), Vec3::Constant(DBL_MAX)}};
  expect_as_brute_force(boxes, all(5), all(5));
  EXPECT_EQ(box_join(boxes, all(5), all(5)).size(), 5u);
}

RC_GTEST_PROP(SweepJoinProperty, AsBruteForceOnDuplicatedCoordinates, ()) {
  const int count = *rc::gen::inRange(0, 60);
  const int extent = *rc::gen::inRange(1, 9);
  const int owner_count = *rc::gen::inRange(1, 12);
  std::vector<Box> boxes;
  Indices owners, items;
  for (int n = 0; n < count; ++n) {
    Box box;
    for (int i = 0; i < 3; ++i) {
      box.lo[i] = *rc::gen::inRange(0, extent);
      box.hi[i] = box.lo[i] + *rc::gen::elementOf(std::vector<int>{0, 0, 1, 2, -1});
    }
    boxes.push_back(box);
    owners.push_back(static_cast<std::uint32_t>(*rc::gen::inRange(0, owner_count)));
    if (*rc::gen::inRange(0, 4) != 0) items.push_back(static_cast<std::uint32_t>(n));
  }
  // Owners that ascend with the items, as objects do, have an order of leaves of their own.
  if (*rc::gen::inRange(0, 2) == 0) std::ranges::sort(owners);
  std::ranges::reverse(items);  // the order of items does not matter
  RC_ASSERT(box_join(boxes, owners, items) == brute_force(boxes, owners, items));
}

TEST(SweepJoin, AsBruteForceOnManyBoxesOfEveryShape) {
  Random random(301);
  for (int n = 0; n < 12; ++n) {
    std::vector<Box> boxes;
    Indices owners;
    const int count = 1500;
    for (int k = 0; k < count; ++k) {
      const Vec3 at = n % 3 == 2 ? random.scaled3(-300, 300) : random.cube(10);
      Vec3 size = n % 2 == 0 ? random.scaled3(-12, 3).cwiseAbs() : Vec3(random.cube(1).cwiseAbs());
      if (n % 4 == 1) size[n % 3] = 0;
      boxes.push_back({at, at + size});
      owners.push_back(static_cast<std::uint32_t>(random.below(2 * n + 1)));
    }
    expect_as_brute_force(boxes, owners, all(count));
    std::ranges::sort(owners);  // as objects are
    expect_as_brute_force(boxes, owners, all(count));
    if (HasFatalFailure()) return;
  }
}

// More than a thread takes alone, in any number of threads, and no more pairs than asked for.
TEST(SweepJoin, StopsAfterTheMostAndTakesAnyNumberOfThreads) {
  Random random(302);
  std::vector<Box> boxes;
  Indices owners;
  for (std::uint32_t k = 0; k < 6000; ++k) {
    const Vec3 at = random.cube(10);
    boxes.push_back({at, at + Vec3(random.cube(2).cwiseAbs())});
    owners.push_back(k % 7);
  }
  for (const bool ascend : {false, true}) {
    if (ascend) std::ranges::sort(owners);
    const Pairs expected = brute_force(boxes, owners, all(6000));
    ASSERT_GT(expected.size(), 1000u);
    for (const unsigned threads : {1u, 3u, 0u}) {
      EXPECT_EQ(box_join(boxes, owners, all(6000), SIZE_MAX, threads), expected);
      for (const std::size_t most : {std::size_t{0}, std::size_t{1}, expected.size() - 1}) {
        const Pairs some = box_join(boxes, owners, all(6000), most, threads);
        ASSERT_EQ(some.size(), most + 1);
        EXPECT_TRUE(std::equal(some.begin(), some.end(), expected.begin()));
      }
      EXPECT_EQ(box_join(boxes, owners, all(6000), expected.size(), threads), expected);
    }
  }
}

// ---- Boxes that grow by half a clearance, against rationals.

using rational::Q;

// Two boxes each of which is beyond the exact sum overlap wherever the boxes were that close.
TEST(GrownBox, IsBeyondTheExactSumOnEverySide) {
  Random random(811);
  int nearest_is_inside = 0;
  for (int n = 0; n < 20'000; ++n) {
    const double clearance = std::abs(random.scaled(-60, 20));
    const double half = half_of(clearance);
    ASSERT_GT(Q(half), Q(clearance) / 2);
    const Vec3 a = random.scaled3(-30, 30), b = random.scaled3(-30, 30);
    const Box box{a.cwiseMin(b), a.cwiseMax(b)};
    const Box grown = grow(box, half);
    for (int axis = 0; axis < 3; ++axis) {
      const Q lo = Q(box.lo[axis]) - Q(half), hi = Q(box.hi[axis]) + Q(half);
      ASSERT_LT(Q(grown.lo[axis]), lo);
      ASSERT_GT(Q(grown.hi[axis]), hi);
      nearest_is_inside += Q(box.lo[axis] - half) > lo;
    }
  }
  EXPECT_GT(nearest_is_inside, 1000) << "the twin: sums that are rounded to nearest";
}

TEST(GrownBox, StaysWhatItIsWithoutAClearance) {
  const Box box{Vec3(1, 2, 3), Vec3(4, 5, 6)};
  const Box same = grow(box, half_of(0));
  EXPECT_EQ(same.lo, box.lo);
  EXPECT_EQ(same.hi, box.hi);
  EXPECT_TRUE(grow(Box::empty(), half_of(1)).is_empty());
}

// ---- Pairs in order, some at a time, against all pairs of triangles whose boxes overlap.

/// Objects of small triangles, some of them `self`, and one triangle that meets nearly all others.
Scene some_scene(Random& random, int triangles) {
  Scene scene;
  for (int t = 0; t < triangles; ++t) {
    const Vec3 at(random.below(7), random.below(7), random.below(3));
    std::array<Vec3, 3> corners;
    for (Vec3& p : corners) p = t == 5 ? Vec3(random.cube(9)) : Vec3(at + random.cube(0.7));
    add_triangle(scene, corners);
  }
  for (int first = 0; first < triangles;) {
    const int count = std::min(random.below(triangles / 2 + 2), triangles - first);
    scene.objects.push_back(
        {"", static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), random.coin()});
    first += count;
  }
  return scene;
}

std::vector<TrianglePair> streamed(const Scene& scene, double clearance,
                                   const std::vector<ObjectPair>& ignored, unsigned threads,
                                   std::size_t most) {
  OrderedPairs pairs(scene, clearance, ignored, true, threads);
  std::vector<TrianglePair> out, part;
  while (!pairs.at_end()) {
    pairs.next(most, part);
    EXPECT_LE(part.size(), most + threads * scene.triangles.size());
    out.insert(out.end(), part.begin(), part.end());
  }
  pairs.next(most, part);
  EXPECT_TRUE(part.empty());
  return out;
}

std::vector<TrianglePair> given(const Scene& scene, double clearance,
                                const std::vector<ObjectPair>& ignored, bool neighbours,
                                unsigned threads) {
  std::vector<TrianglePair> out;
  std::mutex mutex;
  OrderedPairs pairs(scene, clearance, ignored, neighbours, threads);
  const std::uint64_t count = pairs.give([&](std::vector<TrianglePair>& some) {
    const std::scoped_lock lock(mutex);
    out.insert(out.end(), some.begin(), some.end());
  });
  EXPECT_EQ(count, out.size());
  EXPECT_TRUE(pairs.at_end());
  std::ranges::sort(out);
  return out;
}

TEST(OrderedPairs, AreAllPairsInOrderWhateverThePartsAndThreads) {
  Random random(621);
  std::size_t found = 0;
  for (const int triangles : {0, 1, 2, 15, 16, 17, 300, 700}) {
    const Scene scene = some_scene(random, triangles);
    std::vector<ObjectPair> ignored;
    if (scene.objects.size() > 2) ignored = {{0, 2}};
    const double clearance = random.coin() ? 0 : 0.25;
    const std::vector<TrianglePair> expected = overlapping(scene, clearance, true, ignored);
    found += expected.size();
    for (const unsigned threads : {1u, 3u}) {
      for (const std::size_t most : {std::size_t{1}, std::size_t{40}, std::size_t{100'000}})
        EXPECT_EQ(streamed(scene, clearance, ignored, threads, most), expected) << triangles;
      EXPECT_EQ(given(scene, clearance, ignored, true, threads), expected) << triangles;
      EXPECT_EQ(given(scene, clearance, ignored, false, threads),
                overlapping(scene, clearance, false, ignored))
          << triangles;
    }
    // The twin: the search notices a pair of objects that is not ignored.
    if (!ignored.empty() && overlapping(scene, clearance) != expected) {
      EXPECT_NE(streamed(scene, clearance, {}, 1, 40), expected);
    }
  }
  EXPECT_GT(found, 200u);
}

TEST(OrderedPairs, GivesManyPairsFromSeveralThreadsAndEndsAtAFailure) {
  const std::array<Vec3, 3> one = {Vec3(0, 0, 0), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  const std::vector<std::array<Vec3, 3>> many(400, one);
  const Scene scene = lab::scene_of({many, many});
  EXPECT_EQ(given(scene, 0, {}, true, 3), overlapping(scene, 0));
  for (const unsigned threads : {1u, 3u}) {
    OrderedPairs pairs(scene, 0, {}, true, threads);
    const auto fail = [](std::vector<TrianglePair>&) { throw std::runtime_error("full"); };
    EXPECT_THROW(pairs.give(fail), std::runtime_error);
  }
}

// So many triangles are searched by several threads at once, each with a part of them.
TEST(OrderedPairs, EndBehindTheFirstPartThatIsNotComplete) {
  Random random(623);
  const Scene scene = some_scene(random, 4'200);
  EXPECT_EQ(streamed(scene, 0, {}, 3, 40), overlapping(scene, 0));
}

TEST(OrderedPairs, OfAClearanceBeyondTheDoublesAreAllPairs) {
  Random random(622);
  Scene scene = some_scene(random, 40);
  for (Vec3& p : scene.vertices) p *= 1e307;
  constexpr double kMax = std::numeric_limits<double>::max();
  const std::vector<TrianglePair> expected = overlapping(scene, kMax);
  EXPECT_GT(expected.size(), 500u);
  EXPECT_EQ(streamed(scene, kMax, {}, 2, 64), expected);
}

}  // namespace
}  // namespace farcull
