// The sweep of boxes against brute force, and broken sweeps that must be caught.
#include <rapidcheck/gtest.h>

#include "tests/lab/boxes.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

using namespace lab;

// ---- boxes ----

TEST(BoxSweep, FollowsBoxesThatMeetAndPart) {
  BoxSweep sweep;
  EXPECT_TRUE(sweep.update({}).empty());
  EXPECT_TRUE(sweep.update(Boxes{along_x(0, 1), along_x(3, 4)}).empty());
  EXPECT_TRUE(sweep.sorted_from_scratch());
  EXPECT_TRUE(sweep.update(Boxes{along_x(0, 1), along_x(2, 4)}).empty());
  EXPECT_FALSE(sweep.sorted_from_scratch());
  EXPECT_EQ(sweep.swaps(), 0u);
  EXPECT_EQ(sweep.update(Boxes{along_x(0, 1), along_x(0.5, 4)}), (Pairs{{0, 1}}));
  EXPECT_EQ(sweep.swaps(), 1u);
  EXPECT_EQ(sweep.update(Boxes{along_x(2, 3), along_x(0.5, 4)}), (Pairs{{0, 1}}));
  EXPECT_TRUE(sweep.update(Boxes{along_x(5, 6), along_x(0.5, 4)}).empty());
  EXPECT_FALSE(sweep.sorted_from_scratch());
}

TEST(BoxSweep, TouchingCountsWhicheverSideComes) {
  for (const double from : {-2.0, 0.0, 2.0}) {
    BoxSweep sweep;
    sweep.update(Boxes{along_x(0, 1), along_x(from, from + 0.5)});
    EXPECT_EQ(sweep.update(Boxes{along_x(0, 1), along_x(1, 1.5)}), (Pairs{{0, 1}}));
    EXPECT_EQ(sweep.update(Boxes{along_x(0, 1), along_x(-1, -0.0)}), (Pairs{{0, 1}}));
    EXPECT_EQ(sweep.update(Boxes{along_x(0, 0), along_x(-0.0, -0.0)}), (Pairs{{0, 1}}));
    EXPECT_TRUE(sweep.update(Boxes{along_x(5e-324, 1), along_x(-1, -0.0)}).empty());
    EXPECT_FALSE(sweep.sorted_from_scratch());
  }
}

// An empty box that stands where it stood, its sides exchanged along one axis, passes no other end.
TEST(BoxSweep, ABoxThatBecomesEmptyLeavesItsPairs) {
  for (int axis = 0; axis < 3; ++axis) {
    BoxSweep sweep;
    Boxes boxes = {cube(0, 9), cube(2, 3), cube(4, 5)};
    EXPECT_EQ(sweep.update(boxes), (Pairs{{0, 1}, {0, 2}}));
    std::swap(boxes[1].lo[axis], boxes[1].hi[axis]);
    EXPECT_EQ(sweep.update(boxes), (Pairs{{0, 2}}));
    boxes[0] = Box::empty();
    EXPECT_TRUE(sweep.update(boxes).empty());
    boxes[0] = cube(0, 9);
    EXPECT_EQ(sweep.update(boxes), (Pairs{{0, 2}}));
  }
}

TEST(BoxSweep, EqualPointsAllMeet) {
  BoxSweep sweep;
  for (const double at : {1.0, 0.0, -0.0, DBL_MAX, -DBL_MAX, 5e-324})
    EXPECT_EQ(sweep.update(Boxes(20, cube(at, at))).size(), 190u);
  EXPECT_FALSE(sweep.sorted_from_scratch());
}

TEST(BoxSweep, AsBruteForceOverMovingBoxes) {
  Random random(601);
  std::uint64_t swaps = 0;
  int coherent = 0;
  for (int kind = 0; kind < 4; ++kind) {
    BoxSweep sweep;
    Boxes boxes = some_boxes(random, 80);
    for (int frame = 0; frame < 60; ++frame) {
      ASSERT_EQ(sweep.update(boxes), brute_force(boxes)) << "kind " << kind << " frame " << frame;
      swaps += sweep.swaps();
      coherent += !sweep.sorted_from_scratch();
      if (frame % 20 == 19) boxes.resize(boxes.size() + 5 - frame / 2, cube(3, 4));
      if (frame % 20 == 5) std::ranges::reverse(boxes);  // others than before
      move(boxes, random, kind);
    }
  }
  // The answers came from the lists that were kept, not from beginning again.
  EXPECT_GT(swaps, 0u);
  EXPECT_GT(coherent, 20);
}

TEST(BoxSweep, BeginsAgainWhereTooMuchMoved) {
  Random random(602);
  BoxSweep sweep;
  for (int frame = 0; frame < 4; ++frame) {
    const Boxes boxes = [&] {
      Boxes out;
      for (int i = 0; i < 300; ++i) {
        const Vec3 at = random.cube(1);
        out.push_back({at, at + Vec3::Constant(0.1)});
      }
      return out;
    }();
    EXPECT_EQ(sweep.update(boxes), brute_force(boxes));
    EXPECT_TRUE(sweep.sorted_from_scratch());
    // It gave up in time: at most 8 moves for each of 600 ends, and one end's way, in each list.
    EXPECT_LE(sweep.swaps(), 3 * (8 * 600 + 600u));
  }
}

TEST(BoxSweepTwin, WithoutAFaultTheSmallSweepIsRight) {
  Random random(603);
  SmallBoxSweep sweep;
  Boxes boxes = some_boxes(random, 40);
  for (Box& box : boxes)
    if (box.is_empty()) box = cube(0, 1);
  for (int frame = 0; frame < 30; ++frame) {
    ASSERT_EQ(sweep.update(boxes), brute_force(boxes)) << frame;
    for (Box& box : boxes) {
      const Vec3 by = random.cube(0.3);
      box = {box.lo + by, box.hi + by};
    }
  }
}

// Each fault gives an answer that brute force does not, at once and for as long as the boxes stay;
// forgetting mends it.
TEST(BoxSweepTwin, ADroppedSwapIsCaught) {
  SmallBoxSweep sweep;
  sweep.update(Boxes{along_x(0, 1), along_x(3, 4)});
  const Boxes met = {along_x(0, 1), along_x(0.5, 4)};
  sweep.fault = SweepFault::dropped_swap;
  EXPECT_NE(sweep.update(met), brute_force(met));
  EXPECT_NE(sweep.update(met), brute_force(met));
  sweep.forget();
  EXPECT_EQ(sweep.update(met), brute_force(met));
}

TEST(BoxSweepTwin, OpenBoxesAreCaught) {
  SmallBoxSweep sweep;
  sweep.update(Boxes{along_x(0, 1), along_x(3, 4)});
  const Boxes touching = {along_x(0, 1), along_x(1, 4)};
  sweep.fault = SweepFault::open_boxes;
  EXPECT_NE(sweep.update(touching), brute_force(touching));
  sweep.fault = SweepFault::none;
  EXPECT_EQ(sweep.update(touching), brute_force(touching));  // with the order of ties put right
}

}  // namespace
}  // namespace farcull
