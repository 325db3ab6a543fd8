// The kernel of FAR pairs (core/interval.glsl) against exact arithmetic: the real triangle,
// anywhere its float corners and the widening allow, clipped to a pixel with rationals.
#include "core/interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/core/chance.h"
#include "tests/core/rational.h"

namespace farcull::lab {

using FloatTriangle = std::array<std::array<float, 3>, 3>;

struct Answer {
  std::array<float, 3> lo, hi;
  float row_lo, row_hi;
  bool hit;
  float near, far;
};

inline float number(float x) { return x; }
inline float number(glsl_chance::Chance x) { return x.value(); }

}  // namespace farcull::lab

namespace farcull::interval {
#include "tests/core/interval_evaluate.h"
}

// Without the allowance for rounding.
#undef FAR_PAIR_ROUNDING
#define FAR_PAIR_ROUNDING 0.0f
namespace farcull::interval_bare {
using namespace farcull::glsl;
#include "core/interval.glsl"
#include "tests/core/interval_evaluate.h"
}  // namespace farcull::interval_bare

#define float Chance
namespace farcull::interval_bare_chance {
using namespace farcull::glsl_chance;
#include "core/interval.glsl"
#undef float
#include "tests/core/interval_evaluate.h"
}  // namespace farcull::interval_bare_chance

#undef FAR_PAIR_ROUNDING
#define FAR_PAIR_ROUNDING 1.0f
#define float Chance
namespace farcull::interval_chance {
using namespace farcull::glsl_chance;
#include "core/interval.glsl"
#undef float
#include "tests/core/interval_evaluate.h"
}  // namespace farcull::interval_chance

namespace farcull {
namespace {

using lab::Answer;
using lab::FloatTriangle;
using rational::Q;
using rational::Q3;
using rational::Random;

using Evaluate = Answer (*)(const FloatTriangle&, float, int, int, float);

// The part of a convex polygon where sign * p[axis] <= sign * bound.
std::vector<Q3> clipped(const std::vector<Q3>& polygon, int axis, int sign, const Q& bound) {
  std::vector<Q3> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Q3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const Q dp = sign * (p[axis] - bound), dq = sign * (q[axis] - bound);
    if (dp <= 0) out.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0))
      out.push_back(rational::between(p, q, dp / (dp - dq)));
  }
  return out;
}

float usable(double x) { return std::abs(x) < 0x1p-60 ? 0.f : static_cast<float>(x); }

// Triangles of every kind that has been trouble, near the pixels around `at`.
FloatTriangle draw(Random& random) {
  const double reach = std::exp2(random.uniform(2, random.below(8) == 0 ? 20 : 12));
  const Vec3 at(random.uniform(0, reach), random.uniform(0, reach), random.uniform(-reach, reach));
  const double size = std::exp2(random.uniform(-6, 4));
  std::array<Vec3, 3> t;
  for (Vec3& p : t) p = at + random.cube(size);
  const Vec3 along = random.cube(1).normalized();
  switch (random.below(9)) {
    case 0:  // needles
      t[1] = t[0] + 40 * size * along;
      t[2] = t[1] + random.scaled3(-24, -8);
      break;
    case 1:  // corners at the centres, borders and corners of pixels
      for (Vec3& p : t) {
        p = p.array().round() + 0.5 * random.below(2);
        if (random.coin()) p += random.scaled3(-24, -12);
      }
      break;
    case 2:  // the plane all but contains the view
      t[2].head<2>() = t[0].head<2>() + random.uniform(-2, 3) * (t[1] - t[0]).head<2>() +
                       random.scaled3(-28, -16).head<2>();
      t[2].z() += random.scaled(0, 6);
      break;
    case 3:  // segments and points
      t[2] = t[random.below(2)];
      if (random.below(4) == 0) t[1] = t[0];
      break;
    case 4:  // edges all but along a row or a column
      t[1][random.below(2)] = t[0][0] + random.scaled(-26, -14);
      t[1].y() = std::nextafter(t[0].y(), random.sign() * 1e30);
      break;
    case 5:  // an edge on the border of a pixel
      t[0].y() = t[1].y() = std::round(t[0].y());
      break;
    case 6:  // a corner on the border, the others on both sides
      t[0].y() = std::round(t[0].y());
      t[1].y() = t[0].y() + random.uniform(0, size);
      t[2].y() = t[0].y() - random.uniform(0, size);
      break;
    default:
      break;
  }
  FloatTriangle out;
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      out[k][axis] = usable(std::clamp(t[k][axis], -0x1p20, 0x1p20));
    }
  }
  return out;
}

// A real triangle whose points lie within `widening` and half a unit in the last place of those of
// the float triangle; mostly at the limit.
std::vector<Q3> real_triangle(Random& random, const FloatTriangle& t, float widening) {
  std::vector<Q3> out(3);
  const bool together = random.coin();
  std::array<int, 3> shift{};
  for (int& s : shift) s = random.below(3) - 1;
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      const double room = widening + 0x1p-24 * std::abs(t[k][axis]);
      const int s = together ? shift[axis] : random.below(3) - 1;
      out[k][axis] = Q(t[k][axis]) + s * Q(room);
    }
  }
  return out;
}

struct Tally {
  std::size_t checked = 0;
  std::size_t failed = 0;
  std::string first;
};

void expect(Tally& tally, bool good, const std::string& what, const FloatTriangle& t, int i,
            int j) {
  ++tally.checked;
  if (good) return;
  if (tally.failed++ > 0) return;
  char text[400];
  std::snprintf(text, sizeof text, "%s in pixel (%d, %d): %a %a %a  %a %a %a  %a %a %a",
                what.c_str(), i, j, t[0][0], t[0][1], t[0][2], t[1][0], t[1][1], t[1][2], t[2][0],
                t[2][1], t[2][2]);
  tally.first = text;
}

Tally compare(Evaluate evaluate, int triangles, float shrink = 0) {
  Random random(11);
  Tally tally;
  for (int n = 0; n < triangles; ++n) {
    if (triangles > 100) glsl_chance::rounding() = static_cast<glsl_chance::Rounding>(n % 3);
    const FloatTriangle t = draw(random);
    const float widening = static_cast<float>(
        random.coin() ? 0x1p-40 : std::exp2(random.uniform(-12, random.below(4) == 0 ? 4 : -2)));
    const std::vector<Q3> real = real_triangle(random, t, widening);
    // Pixels around one point of the triangle; few, since each is clipped with rationals.
    const int k = random.below(3);
    const double mix = random.coin() ? 0 : random.uniform(0, 1);
    const int i0 = static_cast<int>(std::floor(t[k][0] + mix * (t[(k + 1) % 3][0] - t[k][0])));
    const int j0 = static_cast<int>(std::floor(t[k][1] + mix * (t[(k + 1) % 3][1] - t[k][1])));
    for (int j = j0 - 1; j <= j0 + 1; ++j) {
      const std::vector<Q3> row = clipped(clipped(real, 1, -1, Q(j)), 1, 1, Q(j + 1));
      if (row.empty()) continue;
      for (int i = i0 - 1; i <= i0 + 1; ++i) {
        const std::vector<Q3> part = clipped(clipped(row, 0, -1, Q(i)), 0, 1, Q(i + 1));
        if (part.empty()) continue;
        const Answer answer = evaluate(t, widening, i, j, shrink);
        for (const Q3& p : part) {
          for (int axis = 0; axis < 3; ++axis) {
            expect(tally, Q(answer.lo[axis]) <= p[axis] && p[axis] <= Q(answer.hi[axis]), "bounds",
                   t, i, j);
          }
          expect(tally, answer.hit, "no interval", t, i, j);
          if (!answer.hit) continue;
          expect(tally, Q(answer.row_lo) <= p[0] && p[0] <= Q(answer.row_hi), "row", t, i, j);
          expect(tally, Q(answer.near) <= p[2] && p[2] <= Q(answer.far), "depth", t, i, j);
        }
      }
    }
  }
  return tally;
}

TEST(Interval, ContainsTheRealTrianglePixelByPixel) {
  const Tally tally = compare(interval::evaluate, 60000);
  EXPECT_EQ(tally.failed, 0u) << tally.first;
  EXPECT_GT(tally.checked, 1000000u);
}

TEST(Interval, ContainsItHoweverTheDeviceRounds) {
  const Tally tally = compare(interval_chance::evaluate, 60000);
  EXPECT_EQ(tally.failed, 0u) << tally.first;
  EXPECT_GT(tally.checked, 1000000u);
}

TEST(Interval, LosesPointsWithoutTheAllowanceForRounding) {
  EXPECT_GT(compare(interval_bare::evaluate, 5000).failed, 0u);
  EXPECT_GT(compare(interval_bare_chance::evaluate, 5000).failed, 0u);
}

TEST(Interval, LosesPointsWhereThePixelIsTooSmall) {
  EXPECT_GT(compare(interval::evaluate, 5000, 0x1p-6f).failed, 0u);
}

// The interval is no wider than the depth of the triangle over the pixel grown by what the budget
// names, so that a test of soundness alone cannot be passed by giving up.
TEST(Interval, IsTight) {
  Random random(12);
  for (int n = 0; n < 3000; ++n) {
    const FloatTriangle t = draw(random);
    float most = 0;
    for (const auto& p : t) {
      for (const float x : p) most = std::max(most, std::fabs(x));
    }
    if (most > 4096) continue;
    std::vector<Q3> exact(3);
    for (int k = 0; k < 3; ++k) exact[k] = {Q(t[k][0]), Q(t[k][1]), Q(t[k][2])};
    const int i = static_cast<int>(std::floor(t[0][0])), j = static_cast<int>(std::floor(t[0][1]));
    const Answer answer = interval::evaluate(t, 0x1p-40f, i, j, 0);
    ASSERT_TRUE(answer.hit);
    // Three times the margin, once for each rounding of a border (docs/budget.md, "Interval
    // pairs").
    const Q grown = Q(3 * 0x1p-17 * (1.0 + most));
    std::vector<Q3> part = clipped(clipped(exact, 1, -1, j - grown), 1, 1, j + 1 + grown);
    part = clipped(clipped(part, 0, -1, i - grown), 0, 1, i + 1 + grown);
    ASSERT_FALSE(part.empty());
    Q near = part[0][2], far = part[0][2];
    for (const Q3& p : part) {
      near = std::min(near, p[2]);
      far = std::max(far, p[2]);
    }
    EXPECT_GE(Q(answer.near), near - grown);
    EXPECT_LE(Q(answer.far), far + grown);
  }
}

TEST(Interval, SlicesNeverDecrease) {
  Random random(13);
  for (int n = 0; n < 100000; ++n) {
    const float near = static_cast<float>(random.scaled(-4, 12));
    const float scale = static_cast<float>(64 / std::exp2(random.uniform(-10, 14)));
    const float z = near + static_cast<float>(random.scaled(-10, 14));
    const float next = random.coin() ? std::nextafter(z, HUGE_VALF)
                                     : z + static_cast<float>(std::exp2(random.uniform(-20, 14)));
    const int slice = interval::far_slice(z, near, scale);
    ASSERT_LE(slice, interval::far_slice(next, near, scale));
    ASSERT_GE(slice, 0);
    ASSERT_LT(slice, 64);
  }
}

}  // namespace
}  // namespace farcull
