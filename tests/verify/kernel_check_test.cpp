// The checks of kernels' answers: this CPU's are right, and answers that are a little too
// narrow, far too wide, or no numbers are not.
#include "verify/kernel_check.h"
#include "offsets/offsets.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

using Change = std::function<void(SolidAnswer&)>;

/// Of solids that are adversarial, and of those of triangles; `check` judges an answer.
template <class Adversarial, class Of, class Check>
KernelTally solids(const SolidProgram& program, Adversarial adversarial, Of of, Check check,
                   const Change& change) {
  KernelTally tally;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    SolidCase c{0.5f + static_cast<float>(i % 100), 0.5f, {}};
    const bool direct = i % 3 == 0;
    const KernelTriangle t = kernel_triangle(3, i, c.cx, c.cy);
    c.solid = direct ? adversarial(3, i, c.cx, c.cy) : of(t);
    SolidAnswer a{};
    a.hit = program.interval(c.cx, c.cy, c.solid, a.entry, a.exit);
    change(a);
    check(c, a, !direct && t.ordinary, tally);
  }
  return tally;
}

KernelTally boxes(const Change& change) {
  const auto of = [](const KernelTriangle& t) { return obb_of(t.corners, t.radius); };
  return solids(obb_fattener().solid, adversarial_box, of, check_box, change);
}

KernelTally sums(const Change& change) {
  const auto of = [](const KernelTriangle& t) {
    return minkowski_solid(t.corners[0], t.corners[1], t.corners[2], t.radius);
  };
  return solids(minkowski_fattener().solid, adversarial_minkowski, of, check_minkowski, change);
}

bool loose(const KernelTally& t) {
  return static_cast<double>(t.loose) > kLooseShare * static_cast<double>(t.ordinary);
}

template <class Run>
void expect_right(Run run) {
  const KernelTally t = run([](auto&) {});
  EXPECT_EQ(t.lost, 0u);
  EXPECT_FALSE(loose(t)) << t.loose << " of " << t.ordinary;
  EXPECT_GT(t.checked, 10'000u);
}

TEST(KernelCheck, ThisCpusAnswersAreRight) {
  expect_right(boxes);
  expect_right(sums);
}

TEST(KernelCheck, WrongAnswersLosePoints) {
  // By 2^-18 of each end, which is more than the widening.
  const Change narrow = [](SolidAnswer& a) {
    a.entry += std::abs(a.entry) * 0x1p-18f + 1e-6f;
    a.exit -= std::abs(a.exit) * 0x1p-18f + 1e-6f;
  };
  const Change miss = [](SolidAnswer& a) { a.hit = false; };
  const Change nan = [](SolidAnswer& a) { a.exit = std::numeric_limits<float>::quiet_NaN(); };
  for (const Change& change : {narrow, miss, nan}) {
    EXPECT_GT(boxes(change).lost, 100u);
    EXPECT_GT(sums(change).lost, 100u);
  }
}

TEST(KernelCheck, AnswersThatSayNothingAreLoose) {
  const Change wide = [](SolidAnswer& a) {
    a.entry -= 1;
    a.exit += 1;
  };
  EXPECT_TRUE(loose(boxes(wide)));
  EXPECT_TRUE(loose(sums(wide)));
  EXPECT_EQ(boxes(wide).lost, 0u);
}

}  // namespace
}  // namespace farcull
