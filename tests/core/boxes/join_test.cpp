// The box join finds the pairs that brute force finds.
#include "core/boxes/join.h"

#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/lab/boxes.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using lab::Indices;
using lab::Pairs;
using rational::Random;

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

TEST(SweepJoin, NothingToJoin) {
  EXPECT_TRUE(box_join({}, {}, {}).empty());
  const std::vector<Box> boxes(3, Box{Vec3::Zero(), Vec3::Zero()});
  EXPECT_TRUE(box_join(boxes, Indices{0, 1, 2}, Indices{1}).empty());
  EXPECT_TRUE(box_join(boxes, Indices{4, 4, 4}, all(3)).empty());
}

// All extents are zero, so no axis is better than another (0 / 0).
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

// Lengths and extents overflow; the order of -0.0 and 0.0 must not matter.
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
      owners.push_back(static_cast<std::uint32_t>(random.below(n + 1)));
    }
    expect_as_brute_force(boxes, owners, all(count));
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace farcull
