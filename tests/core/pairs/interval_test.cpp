// The kernel of FAR pairs (core/pairs/interval.glsl) against exact arithmetic: the real triangle,
// anywhere its float corners and the widening allow, clipped to a pixel with rationals.
#include "core/pairs/grid.h"

#include "core/canvas/kernel_case.h"
#include "tests/core/base/chance.h"
#include "tests/lab/rational.h"
#include "tests/lab/test.h"
#include "verify/kernel_cases.h"

namespace farcull::lab {

using FloatTriangle = std::array<std::array<float, 3>, 3>;

using Answer = IntervalAnswer;

inline float number(float x) { return x; }
inline float number(glsl_chance::Chance x) { return x.value(); }

}  // namespace farcull::lab

namespace farcull::interval {
#include "tests/core/pairs/interval_evaluate.h"
}

// Without the allowance for rounding.
#undef FAR_PAIR_ROUNDING
#define FAR_PAIR_ROUNDING 0.0f
namespace farcull::interval_bare {
using namespace farcull::glsl;
#include "core/pairs/interval.glsl"
#include "tests/core/pairs/interval_evaluate.h"
}  // namespace farcull::interval_bare

#define float Chance
namespace farcull::interval_bare_chance {
using namespace farcull::glsl_chance;
#include "core/pairs/interval.glsl"
#undef float
#include "tests/core/pairs/interval_evaluate.h"
}  // namespace farcull::interval_bare_chance

#undef FAR_PAIR_ROUNDING
#define FAR_PAIR_ROUNDING 1.0f
#define float Chance
namespace farcull::interval_chance {
using namespace farcull::glsl_chance;
#include "core/pairs/interval.glsl"
#undef float
#include "tests/core/pairs/interval_evaluate.h"
}  // namespace farcull::interval_chance

namespace farcull {
namespace {

using lab::Answer;
using lab::FloatTriangle;
using rational::clipped;
using rational::Q;
using rational::Q3;
using rational::Random;

using Evaluate = Answer (*)(const FloatTriangle&, float, int, int, float);

struct Tally {
  std::size_t checked = 0, failed = 0;
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
    if (n == triangles / 2) random = Random(test_seed(11));
    if (triangles > 100) glsl_chance::rounding() = static_cast<glsl_chance::Rounding>(n % 3);
    const IntervalCase c = interval_cases::random_case(random);
    const FloatTriangle& t = c.corners;
    const float widening = c.widening;
    const std::vector<Q3> real = interval_cases::real_triangle(c);
    // Pixels around one point of the triangle; few, since each is clipped with rationals.
    for (int j = c.j - 1; j <= c.j + 1; ++j) {
      const std::vector<Q3> row = clipped(clipped(real, 1, -1, Q(j)), 1, 1, Q(j + 1));
      if (row.empty()) continue;
      for (int i = c.i - 1; i <= c.i + 1; ++i) {
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
  const Tally tally = compare(interval::evaluate, trials(60000));
  EXPECT_EQ(tally.failed, 0u) << tally.first;
  EXPECT_GT(tally.checked, static_cast<std::uint64_t>(trials(1000000)));
}

TEST(Interval, ContainsItHoweverTheDeviceRounds) {
  const Tally tally = compare(interval_chance::evaluate, trials(60000));
  EXPECT_EQ(tally.failed, 0u) << tally.first;
  EXPECT_GT(tally.checked, static_cast<std::uint64_t>(trials(1000000)));
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
  for (int n = 0; n < trials(3000); ++n) {
    const FloatTriangle t = interval_cases::random_triangle(random);
    float most = 0;
    for (const auto& p : t)
      for (const float x : p) most = std::max(most, std::fabs(x));
    if (most > 4096) continue;
    std::vector<Q3> exact(3);
    for (int k = 0; k < 3; ++k) exact[k] = {Q(t[k][0]), Q(t[k][1]), Q(t[k][2])};
    const int i = static_cast<int>(std::floor(t[0][0])), j = static_cast<int>(std::floor(t[0][1]));
    const Answer answer = interval::evaluate(t, 0x1p-40f, i, j, 0);
    ASSERT_TRUE(answer.hit);
    // Three times the margin, once for each rounding of a border (docs/budget.md, "Interval
    // pairs").
    const Q grown = Q(3 * 0x1p-17 * (1.0 + most));
    const std::vector<Q3> part =
        interval_cases::part_in(exact, i - grown, i + 1 + grown, j - grown, j + 1 + grown);
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

// A cell to be cut into 8 parts along an axis, and a coordinate about it: beside the border of a
// part, inside, outside.
struct CutCell {
  float from, side, p;
  float parts_per_px() const { return 8 / side; }
  int exact_part() const {  // double holds all of it exactly
    const double part = std::floor((double(p) - from) * parts_per_px());
    return static_cast<int>(std::clamp(part, 0.0, 7.0));
  }
};

CutCell random_cut(Random& random) {
  CutCell out{};
  const int level = random.below(3);
  out.side = std::ldexp(1.0f, -3 * level);
  out.from = static_cast<float>(random.below(1 << random.below(15)));
  for (int k = 1; k <= level; ++k) out.from += std::ldexp(float(random.below(8)), -3 * k);
  out.p = out.from + out.side * float(random.below(9)) / 8;
  switch (random.below(4)) {
    case 0:
      break;
    case 1:
      out.p = out.from + static_cast<float>(random.uniform(-0.1, 1.1)) * out.side;
      break;
    case 2:
      out.p = static_cast<float>(random.scaled(-140, 20));
      break;
    default: {  // a few floats beside the border
      const float end = random.coin() ? HUGE_VALF : -HUGE_VALF;
      for (int k = random.below(5); k > 0; --k) out.p = std::nextafter(out.p, end);
      break;
    }
  }
  return out;
}

// docs/budget.md, "Parts of a pixel": no rounding moves the border of a part.
TEST(Interval, PartsOfAPixelAreExactHoweverTheDeviceRounds) {
  using glsl_chance::Rounding;
  Random random(14);
  int seen[8] = {};
  for (int n = 0; n < trials(300'000); ++n) {
    if (n == trials(150'000)) random = Random(test_seed(14));
    const CutCell cell = random_cut(random);
    glsl_chance::rounding() = std::array{Rounding::random, Rounding::up, Rounding::down}[n % 3];
    const int part =
        interval_chance::far_part(cell.p, cell.from, cell.parts_per_px(), glsl_chance::Chance(7));
    ASSERT_EQ(part, cell.exact_part())
        << cell.p << " in the cell of side " << cell.side << " at " << cell.from;
    ASSERT_EQ(part, interval::far_part(cell.p, cell.from, cell.parts_per_px(), 7));
    ++seen[part];
  }
  glsl_chance::rounding() = Rounding::random;
  for (const int count : seen) EXPECT_GT(count, trials(1000));
}

// With a division by the part's side, which GLSL lets err by 2.5 u, a coordinate falls into the
// next part although it is more than 1 u of its distance from the cell away from that.
TEST(Interval, ADivisionWouldMoveTheBorderOfAPart) {
  using glsl_chance::Chance;
  Random random(14);
  double most = 0;
  for (int n = 0; n < trials(300'000); ++n) {
    const CutCell cell = random_cut(random);
    const Chance quotient = (Chance(cell.p) - cell.from) / Chance(cell.side / 8);
    const int part = static_cast<int>(clamp(quotient, 0.0f, 7.0f)), truth = cell.exact_part();
    if (part == truth) continue;
    const double at = (double(cell.p) - cell.from) * cell.parts_per_px();
    most = std::max(most, std::abs(at - std::max(part, truth)) / at);
  }
  EXPECT_GT(most, 0x1p-23);
  EXPECT_LE(most, 2.5 * 0x1p-23 * (1 + 0x1p-20));
}

// A window's depths, and one beside the border of a step, inside or beyond.
struct DeepWindow {
  float near, far, z;
};

DeepWindow random_depths(Random& random) {
  DeepWindow out{};
  out.near = static_cast<float>(random.scaled(-4, 20));
  out.far = out.near + static_cast<float>(std::exp2(random.uniform(-20, 20)));
  out.z = static_cast<float>(
      random.uniform(1.1 * out.near - 0.1 * out.far, 1.1 * out.far - 0.1 * out.near));
  if (random.coin()) {
    const float steps = depth_slices(out.near, out.far).steps_per_px;
    out.z = std::trunc(out.z * steps) / steps;
    const float end = random.coin() ? HUGE_VALF : -HUGE_VALF;
    for (int k = random.below(3); k > 0; --k) out.z = std::nextafter(out.z, end);
  }
  if (random.below(8) == 0) out.z = static_cast<float>(random.scaled(-149, 20));
  return out;
}

// docs/budget.md, "Slices". A double holds the product; the fraction that is dropped is its own.
TEST(Interval, SlicesAreExactHoweverTheDeviceRounds) {
  using glsl_chance::Rounding;
  Random random(13);
  std::array<int, kSlices> seen{};
  for (int n = 0; n < trials(300'000); ++n) {
    if (n == trials(150'000)) random = Random(test_seed(13));
    const DeepWindow w = random_depths(random);
    const DepthSlices cut = depth_slices(w.near, w.far);
    ASSERT_EQ(std::exp2(std::ilogb(cut.steps_per_px)), cut.steps_per_px);
    glsl_chance::rounding() = std::array{Rounding::random, Rounding::up, Rounding::down}[n % 3];
    const int slice =
        interval_chance::far_slice(w.z, cut.steps_per_px, cut.first_step, cut.slices_per_step);
    const double step = std::trunc(double(w.z) * cut.steps_per_px) - cut.first_step;
    const double exact = std::floor(std::clamp(step, 0.0, 16383.0) * cut.slices_per_step / 65536);
    ASSERT_EQ(slice, std::min(exact, 63.0)) << w.z << " in " << w.near << " .. " << w.far;
    ASSERT_EQ(slice, cut.of(w.z));
    ++seen[slice];
    // A window deeper than some steps has all its slices but one or two.
    if (w.far - w.near > 1) {
      ASSERT_LE(cut.of(w.near), 0);
      ASSERT_GE(cut.of(w.far), 61);
    }
  }
  glsl_chance::rounding() = Rounding::random;
  for (const int count : seen) EXPECT_GT(count, trials(500));
}

// The difference from the near end rounds, so two programs that round otherwise differ.
TEST(Interval, ADifferenceFromTheNearEndWouldMoveTheBorderOfASlice) {
  using glsl_chance::Chance;
  using glsl_chance::Rounding;
  Random random(13);
  int differ = 0;
  for (int n = 0; n < trials(300'000); ++n) {
    const DeepWindow w = random_depths(random);
    int slices[2];
    for (const Rounding rounding : {Rounding::up, Rounding::down}) {
      glsl_chance::rounding() = rounding;
      const Chance at = (Chance(w.z) - w.near) * Chance(kSlices / (w.far - w.near));
      slices[rounding == Rounding::up] = static_cast<int>(clamp(at, 0.0f, 63.0f));
    }
    differ += slices[0] != slices[1];
  }
  glsl_chance::rounding() = Rounding::random;
  EXPECT_GT(differ, 0);
}

}  // namespace
}  // namespace farcull
