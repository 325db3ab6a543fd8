// Tests of rounded geometry add this to verify/rational.h: exact images of points, and random
// numbers whose seed is printed.
#pragma once

#include "core/view/view.h"
#include "tests/lab/standard.h"
#include "verify/rational.h"

namespace farcull::rational {

/// map * (x - origin) without rounding.
inline Q3 image(const Window& window, const Vec3& x) {
  Q3 d;
  for (int i = 0; i < 3; ++i) d[i] = Q(x[i]) - Q(window.origin[i]);
  Q3 out;
  for (int row = 0; row < 3; ++row)
    for (int i = 0; i < 3; ++i) out[row] += Q(window.map(row, i)) * d[i];
  return out;
}

inline std::vector<Vec3> box_corners(const Box& box) {
  std::vector<Vec3> corners;
  for (int bits = 0; bits < 8; ++bits) {
    corners.emplace_back(bits & 1 ? box.hi[0] : box.lo[0], bits & 2 ? box.hi[1] : box.lo[1],
                         bits & 4 ? box.hi[2] : box.lo[2]);
  }
  return corners;
}

/// The seed is printed; FARCULL_TEST_SEED gives another one.
class Random : public Draws {
 public:
  explicit Random(std::uint64_t seed) : Draws(given(seed)) {}

 private:
  static std::uint64_t given(std::uint64_t seed) {
    if (const char* text = std::getenv("FARCULL_TEST_SEED")) seed = std::stoull(text);
    std::cout << "[ seed " << seed << "; FARCULL_TEST_SEED=... for another ]\n";
    return seed;
  }
};

/// An axis view, a round oblique one, or a direction with components of very different sizes.
inline View random_view(Random& random) {
  static const char* const kNames[] = {"x",           "-x",    "y",     "-y",
                                       "z",           "-z",    "1:1:1", "1:-2:0.5",
                                       "1:1e-8:1e-9", "0:1:1", "3:4:0", "1:1:0"};
  const int pick = random.below(18);
  if (pick < 12) return parse_view(kNames[pick]);
  const Vec3 d = pick < 15 ? random.cube(1) : random.scaled3(-40, 1);
  char text[100];
  std::snprintf(text, sizeof text, "%.17g:%.17g:%.17g", d[0], d[1], d[2]);
  return parse_view(text);
}

}  // namespace farcull::rational
