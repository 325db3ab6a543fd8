// FAR as a property on the worst canvas; the same on GL in gl_far_properties_test.cpp.
#include "tests/core/cull/far_properties.h"

#include "tests/core/base/trials.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

std::unique_ptr<Canvas> worst(const Fattener& fattener) {
  return std::make_unique<WorstCanvas>(fattener.solid);
}

TEST(FarProperty, NoFamilyOfExtremeScenesLosesAPairOnTheWorstCanvas) {
  lab::expect_far_survives_all_families(worst, trials(40, 12), "worst");
}

TEST(FarProperty, KeptCasesStayMended) { EXPECT_GT(lab::replay_cases(worst), 0); }

TEST(FarProperty, EveryFamilyLosesPairsAtTheRadiusThatItNames) {
  lab::expect_every_family_loses_pairs(worst, "worst");
}

}  // namespace
}  // namespace farcull
