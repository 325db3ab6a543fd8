// Defaults of Canvas: a canvas that does not override samples() or depths() throws in them.
#include "core/canvas/canvas.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace farcull {

std::vector<float> Canvas::samples(Verb, const std::vector<Draw>&) {
  throw std::logic_error("this canvas offers no samples");
}

std::vector<float> Canvas::depths(Verb, const std::vector<Draw>&) {
  throw std::logic_error("this canvas offers no depths");
}

float depth_scale(const Window& window) {
  const double reach = std::max(std::abs(window.lo[2]), std::abs(window.hi[2])) + 2;
  return static_cast<float>(0.25 / reach);
}

double depth_step(const Window& window, int depth_bits) {
  // Depths lie in [1/4, 3/4]: the coarsest step of a 32-bit float there is 2^-24, as for 24 bits of
  // fixed point.
  (void)depth_bits;
  return 0x1p-24 / depth_scale(window);
}

double depth_rounding(int depth_bits) {
  return depth_bits == 24 ? 0.5 + 1 + 0x1p24 / (0x1p24 - 1) + 1 : 0.5 + 1;
}

}  // namespace farcull
