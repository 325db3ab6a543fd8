// Clipping to the region: what it leaves out, and what it charges for a cut. clip_fan_test.cpp has
// the claim of core/view/view.h itself.
#include "core/view/view.h"

#include "tests/core/view/clip_cases.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using namespace clip_cases;
using rational::Q, rational::Q3, rational::Random;

TEST(Clip, HugeIsUndrawableAndNeverSilentlyOutside) {
  const std::vector<Box> region{{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
  Random random(202);
  for (const char* name : {"z", "1:2:3"}) {
    const Window window = *fit_window(parse_view(name), region, 64);
    for (const double size : {1e14, 1e20, 1e100, 1e300, DBL_MAX}) {
      for (int n = 0; n < 500; ++n) {
        Triangle corners = {random.cube(1), random.cube(1), random.cube(1)};
        corners[random.below(3)] = random.cube(1).cwiseSign() * size;
        const Patch patch = clip_to_region(window, corners);
        ASSERT_FALSE(patch.drawable()) << name << ", " << size;
        ASSERT_FALSE(std::isnan(patch.error));
      }
    }
  }
}

// Needles along an edge of the box, whose corners rounding puts on either side of two planes at
// once: the one case where a polygon gains more than one corner at a plane.
TEST(Clip, RoundingNeverOverfillsThePatch) {
  Random random(203);
  const std::vector<Box> region{{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
  const Window window = *fit_window(parse_view("z"), region, 8);
  int most = 0;
  for (int n = 0; n < 500'000; ++n) {
    const double length = std::exp2(random.uniform(5, 50));
    const int axis = random.below(3);
    Triangle corners;
    for (int i = 0; i < 3; ++i) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = window.hi[k] + length * random.scaled(-56, -49);
      p[axis] = i == 0   ? -length
                : i == 1 ? length * random.uniform(0.5, 1)
                         : random.uniform(-5, 5) * (random.coin() ? 1 : length * 0x1p-8);
      corners[i] = p * window.pixel_size;
    }
    const Patch patch = clip_to_region(window, corners);
    if (!patch.drawable()) continue;
    ASSERT_LE(patch.count, 9);
    most = std::max(most, patch.count);
  }
  EXPECT_GE(most, 6);  // both ends and a third plane
}

// What the other tests compare with.
TEST(Clip, TheExactClippingKeepsWhatLiesInThePlane) {
  const auto at = [](int x, int y) { return Q3{Q(x), Q(y), Q(0)}; };
  const std::vector<Q3> triangle = {at(0, 0), at(2, 0), at(0, 2)};
  const auto clipped = [&](int sign, int bound) {
    return rational::clipped(triangle, 0, sign, Q(bound));
  };
  EXPECT_EQ(clipped(1, 0), (std::vector<Q3>{at(0, 0), at(0, 2)}));  // an edge
  EXPECT_EQ(clipped(-1, 2), (std::vector<Q3>{at(2, 0)}));           // a corner
  EXPECT_EQ(clipped(1, 2), triangle);
  EXPECT_EQ(clipped(1, 1), (std::vector<Q3>{at(0, 0), at(1, 0), at(1, 1), at(0, 2)}));
  EXPECT_TRUE(clipped(1, -1).empty());
}

// The error of a patch is that of its corners' images and a charge for each cut, which moves a
// corner by up to kCutRounding of the largest coordinate (docs/budget.md, "Clipping and the fan").
TEST(Clip, EachCutIsCharged) {
  Random random(204);
  const std::vector<Box> region{{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
  const Window window = *fit_window(parse_view("z"), region, 64);
  std::array<int, 7> with_cuts{};
  for (int n = 0; n < 2000; ++n) {
    const double half = n % 4 == 0 ? 0.5 : 3;  // of the region it is 1
    const Triangle corners = {random.cube(half), random.cube(half), random.cube(half)};
    const Patch patch = clip_to_region(window, corners);
    ASSERT_TRUE(patch.drawable());
    double largest = 0, mapped = 0;
    for (const Vec3& corner : corners) {
      const PixelPoint q = to_pixel(window, corner);
      largest = std::max(largest, q.p.cwiseAbs().maxCoeff());
      mapped = std::max(mapped, q.error);
    }
    EXPECT_GE(Q(patch.error),
              Q(mapped) + Q(patch.cuts) * Q(kCutRounding) * Q(largest) * Q(1 - 0x1p-50));
    ++with_cuts.at(static_cast<std::size_t>(patch.cuts));
  }
  EXPECT_GT(with_cuts[0], 0) << "the twin: without a cut there is no charge";
  EXPECT_GT(with_cuts[1] + with_cuts[2] + with_cuts[3], 200);
}

}  // namespace
}  // namespace farcull
