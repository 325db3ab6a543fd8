// Boxes that grow by half a clearance, against rationals.
#include "core/boxes/block.h"

#include "tests/lab/rational.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using rational::Q;
using rational::Random;

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

}  // namespace
}  // namespace farcull
