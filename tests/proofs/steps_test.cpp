// The steps that Gappa is asked about (kernel_steps.h) have the bits of the kernels, on floats.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/base/glsl_shim.h"
#include "core/base/random.h"
#include "tests/proofs/kernel_steps.h"

namespace farcull::glsl::proved {
#include "offsets/slab.glsl"

#include "offsets/minkowski.glsl"
}  // namespace farcull::glsl::proved

namespace farcull::proofs {
namespace {

namespace kernel = glsl::proved;
using glsl::vec2, glsl::vec4;

constexpr SlabConstants kSlab = {8 * 0x1p-23, 4 * 0x1p-23, 1e-30f};
constexpr int kCases = 100000;

float min(float a, float b) { return b < a ? b : a; }
float max(float a, float b) { return a < b ? b : a; }
bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// Numbers of very different sizes.
struct Numbers {
  RandomNumbers random;
  float operator()(double size) {
    const double x = random.between(-1, 1) * size;
    return static_cast<float>(random.below(4) == 0 ? x * std::ldexp(1.0, -random.below(30)) : x);
  }
};

TEST(steps, OfASlabHaveTheBitsOfTheKernel) {
  Numbers number{RandomNumbers(1)};
  int parallel_ones = 0;
  for (int i = 0; i < kCases; ++i) {
    const vec2 d = {number(1000), number(1000)};
    vec4 slab = {number(1), number(1), number(1), std::fabs(number(100))};
    if (i % 4 == 0) slab.z = number(0x1p-19);
    const float mz = number(1e5), depth = std::fabs(number(1e5));
    const float from = reach(depth, kSlab);
    float lo = -1e6f, hi = 1e6f;
    const bool hit = kernel::far_slab(d, mz, slab, from, lo, hi);
    const auto [s, e] = doubt(slab.x * d.x, slab.y * d.y, kSlab);
    const float h = height(slab.w, e, kSlab);
    const float steep = std::fabs(slab.z);
    if (steep < 0x1p-20f) {
      ++parallel_ones;
      EXPECT_EQ(hit, std::fabs(s) <= limit(h, slack(steep, from, kSlab), kSlab));
      continue;
    }
    const float t0 = (-h - s) / slab.z, t1 = (h - s) / slab.z;
    // The near end is the far end of the mirror image.
    const float far = max(far_end(t0, kSlab), far_end(t1, kSlab));
    const float near = -max(far_end(-t0, kSlab), far_end(-t1, kSlab));
    EXPECT_TRUE(same(hi, min(1e6f, far_depth(mz, far, kSlab))));
    EXPECT_TRUE(same(lo, max(-1e6f, -far_depth(-mz, -near, kSlab))));
  }
  EXPECT_GT(parallel_ones, 1000);
}

TEST(steps, OfAHalfspaceHaveTheBitsOfTheKernel) {
  Numbers number{RandomNumbers(2)};
  int parallel_ones = 0;
  for (int i = 0; i < kCases; ++i) {
    const vec2 d = {number(1000), number(1000)};
    vec4 n = {number(1), number(1), number(1), 0};
    if (i % 4 == 0) n.z = number(0x1p-19);
    const float mz = number(1e5), from = std::fabs(number(1e5)), h = number(500);
    float lo = -1e9f, hi = 1e9f;
    const bool hit = kernel::far_halfspace(d, mz, n, h, from, lo, hi);
    const auto [s, e] = doubt(n.x * d.x, n.y * d.y, kSlab);
    const float wider = wide(room(h, s, e), h, s, e, kSlab);
    const float steep = std::fabs(n.z);
    if (steep < 0x1p-20f) {
      ++parallel_ones;
      const float rest = wider + slack(steep, from, kSlab) * (1 + 8 * 0x1p-23f);
      EXPECT_EQ(hit, rest >= 0);
      EXPECT_TRUE(lo == -1e9f && hi == 1e9f);
      continue;
    }
    const float t = wider / n.z;
    if (n.z > 0) {
      EXPECT_TRUE(same(hi, min(1e9f, far_depth(mz, far_end(t, kSlab), kSlab))));
    } else {
      EXPECT_TRUE(same(lo, max(-1e9f, -far_depth(-mz, far_end(-t, kSlab), kSlab))));
    }
  }
  EXPECT_GT(parallel_ones, 1000);
}

TEST(steps, OfTheExtentHaveTheBitsOfTheKernel) {
  Numbers number{RandomNumbers(3)};
  for (int i = 0; i < kCases; ++i) {
    const vec4 n = {number(1), number(1), number(1), 0};
    vec4 v[3];
    for (vec4& corner : v) corner = {number(100), number(100), number(100), 0};
    v[0].w = std::fabs(number(2));
    float most = -HUGE_VALF, e = 0;
    for (const vec4& corner : v) {
      const float x = n.x * corner.x, y = n.y * corner.y, z = n.z * corner.z;
      most = max(most, along(x, y, z));
      e = max(e, along_doubt(x, y, z, kSlab));
    }
    const float sum = most + e + ball(v[0].w, n.x * n.x, n.y * n.y, n.z * n.z, kSlab);
    EXPECT_TRUE(same(kernel::far_extent(n, v[0], v[1], v[2]), extent(sum, kSlab)));
  }
}

}  // namespace
}  // namespace farcull::proofs
