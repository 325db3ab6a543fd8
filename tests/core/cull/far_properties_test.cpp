// FAR as a property on the worst canvas; the same on GL in gl_far_test.cpp.
#include "tests/lab/far.h"

#include "verify/worst_canvas.h"

namespace farcull {
namespace {

std::unique_ptr<Canvas> worst(const Fattener& fattener) {
  return std::make_unique<WorstCanvas>(fattener.solid);
}

TEST(FarProperty, NoFamilyOfExtremeScenesLosesAPairOnTheWorstCanvas) {
  lab::expect_far_survives_all_families(
      worst, {.canvas = "worst", .fixed = 8, .of_the_day = trials(8, 4), .most_px = 24});
}

TEST(FarProperty, KeptCasesStayMended) { EXPECT_GT(lab::replay_cases(worst), 0); }

}  // namespace
}  // namespace farcull
