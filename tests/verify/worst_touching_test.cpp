// The worst canvas on depths that are equal: seen where touching counts, and there alone.
#include <gtest/gtest.h>

#include "offsets/offsets.h"
#include "tests/core/canvas/lab.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

TEST(WorstTouching, IsSeenWhereItCounts) {
  const Window window = lab::window(8, 100);
  const auto triangle = [](float z) {
    return std::array<float, 12>{-4, -4, z, 0, 12, -4, z, 0, -4, 12, z, 0};
  };
  for (const int bits : {32, 24}) {
    WorstCanvas canvas(obb_fattener().solid, {.depth_bits = bits});
    const auto is_seen = [&](float stored, float asked, bool touching) {
      Drawables drawables;
      drawables.mode = DepthMode::fixed;
      drawables.first = {0, 1, 2};
      drawables.triangles = {triangle(stored), triangle(asked)};
      Pass pass;
      pass.slots = 1;
      pass.touching = touching;
      pass.draws = {{0, 0}, {1, 0}};
      pass.steps = {{Verb::store, 0, 1}, {Verb::ask, 1, 1}};
      canvas.begin(window, drawables);
      return canvas.run(pass)[0] != 0;
    };
    EXPECT_TRUE(is_seen(3, 3, true)) << bits;
    EXPECT_FALSE(is_seen(3, 3, false)) << bits;
    // The twins: a quarter of a pixel before, and behind.
    EXPECT_FALSE(is_seen(3, 2.75f, true)) << bits;
    EXPECT_TRUE(is_seen(3, 3.25f, false)) << bits;
  }
}

}  // namespace
}  // namespace farcull
