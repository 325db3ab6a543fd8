// FAR as a property on the worst canvas; the same on GL in gl_far_properties_test.cpp.
#include "tests/core/far_properties.h"

#include "verify/worst_canvas.h"

namespace farcull {
namespace {

std::unique_ptr<Canvas> worst(const Fattener& fattener) {
  return std::make_unique<WorstCanvas>(fattener.solid);
}

TEST(FarProperty, NoFamilyOfExtremeScenesLosesAPairOnTheWorstCanvas) {
  lab::expect_far_survives_all_families(worst, 40, "worst");
}

TEST(FarProperty, KeptCasesStayMended) { EXPECT_GT(lab::replay_cases(worst), 0); }

// The property has teeth: without a radius some family loses a pair, and the counter-example
// shrinks to a few triangles.
TEST(FarProperty, WithoutARadiusItFails) {
  const Fattener fattener = obb_fattener();
  WorstCanvas canvas(fattener.solid);
  bool missed = false;
  lab::Random random(3);
  for (int i = 0; i < 200 && !missed; ++i) {
    missed = lab::far_on(canvas, lab::random_scene(5000 + i), fattener, "x,y,z", 32, 0)
                 .accounting.false_negatives > 0;
  }
  EXPECT_TRUE(missed);
}

}  // namespace
}  // namespace farcull
