// The worst-case arithmetic against floats in all four rounding modes, and against rationals: a
// Worst must hold every result that a device may give, and stay exact where a device must be.
#include "core/base/glsl_worst.h"

#include <rapidcheck/gtest.h>

#include "tests/lab/rational.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using glsl_worst::Worst, rational::Q, rational::Random;

constexpr int kModes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
constexpr float kSmallest = 0x1p-126f;
constexpr float kLargest = std::numeric_limits<float>::max();

float flushed(float x) { return std::abs(x) < kSmallest ? 0.0f : x; }

/// a + b, a - b, a * b, a / b, or the root of a.
template <class T>
auto result_of(char operation, const T& a, const T& b) {
  using std::sqrt;
  if (operation == '+') return a + b;
  if (operation == '-') return a - b;
  if (operation == '*') return a * b;
  return operation == '/' ? a / b : sqrt(a);
}

/// The operation on this machine's floats in one rounding mode. Through volatile operands and
/// results, so that it cannot move out of the mode.
float rounded(char operation, float a, float b, int mode) {
  volatile float x = a, y = b;
  std::fesetround(mode);
  volatile float result = result_of(operation, x, y);
  std::fesetround(FE_TONEAREST);
  return result;
}

bool holds(Worst w, float x) { return w.lo() <= x && x <= w.hi(); }

/// Division is only promised for divisors in [2^-126, 2^126], roots for what is not negative.
bool defined(char operation, float a, float b) {
  if (operation == '/') return std::abs(b) >= kSmallest && std::abs(b) <= 0x1p126f;
  return operation != 'r' || a >= 0;
}

float any_float(Random& random) {
  for (;;) {
    const float x = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits() >> 32));
    if (std::isfinite(x)) return x;
  }
}

/// Numbers at the ends of binades, of the range and of the denormals; and any others.
float operand(Random& random) {
  static const float kHard[] = {0.0f,  -0.0f,     1.0f,       0x1p-126f,  0x1p-149f,
                                3.0f,  0x1p-127f, kLargest,   0x1p-23f,   0x1.fffffep-127f,
                                -1.0f, 0x1p64f,   0x1.8p-24f, 0x1p-100f,  -0x1.fffffep-1f,
                                0.1f,  0x1p126f,  0x1p-63f,   0x1.8p-75f, 0x1.fffffep+0f};
  float x = random.below(3) == 0 ? kHard[random.below(static_cast<int>(std::size(kHard)))]
            : random.coin()      ? any_float(random)
                                 : static_cast<float>(random.scaled(-30, 30));
  if (random.below(4) == 0) x = std::nextafter(x, random.coin() ? kLargest : -kLargest);
  return x;
}

/// A second operand that makes trouble with the first: cancels, is far smaller, is its neighbour or
/// a power of two.
float partner(Random& random, float a) {
  const int kind = random.below(6);
  if (kind == 0) return -a;
  if (kind == 1) return std::nextafter(-a, random.coin() ? kLargest : -kLargest);
  if (kind == 2) return static_cast<float>(double(a) * random.scaled(-120, -20));
  if (kind == 3) return static_cast<float>(random.sign() * std::exp2(random.below(250) - 125));
  return operand(random);
}

/// Counts results of a rounding mode beyond the range that `claimed` says, over random operands.
template <class Claim>
long escapes(char operation, std::uint64_t seed, const Claim& claimed) {
  Random random(seed);
  long out = 0;
  for (int n = 0; n < 400'000; ++n) {
    const float a = operand(random), b = partner(random, a);
    if (!defined(operation, a, b)) continue;
    const Worst w = claimed(a, b);
    for (const int mode : kModes) {
      const float x = rounded(operation, a, b, mode);
      if (std::isnan(x)) continue;
      const bool held = holds(w, x) && holds(w, flushed(x));
      if (!held && out++ == 0)
        std::printf("first: %a %c %a = %a, not in [%a, %a]\n", a, operation, b, x, w.lo(), w.hi());
    }
  }
  return out;
}

class Operations : public testing::TestWithParam<char> {};

TEST_P(Operations, RangeHoldsAllFourRoundingModesAndFlushing) {
  const char op = GetParam();
  EXPECT_EQ(escapes(op, 701, [op](float a, float b) { return result_of<Worst>(op, a, b); }), 0);
}

// A range of one number, however well rounded, does not.
TEST_P(Operations, TheNearestFloatAloneDoesNot) {
  const char op = GetParam();
  EXPECT_GT(escapes(op, 701, [op](float a, float b) { return rounded(op, a, b, FE_TONEAREST); }),
            100'000);
}

std::string name_of(const testing::TestParamInfo<char>& info) {
  const std::map<char, std::string> names = {
      {'+', "Sum"}, {'-', "Difference"}, {'*', "Product"}, {'/', "Quotient"}, {'r', "Root"}};
  return names.at(info.param);
}

INSTANTIATE_TEST_SUITE_P(Worst, Operations, testing::Values('+', '-', '*', '/', 'r'), name_of);

// rapidcheck shrinks the bits: a counterexample is two short numbers.
RC_GTEST_PROP(Worst, HoldsSumsAndProductsOfAnyTwoFloats, ()) {
  const auto number = [] {
    return rc::gen::suchThat(
        rc::gen::map(rc::gen::arbitrary<std::uint32_t>(),
                     [](std::uint32_t bits) { return std::bit_cast<float>(bits); }),
        [](float x) { return std::isfinite(x); });
  };
  const float a = *number(), b = *number();
  for (const char op : {'+', '-', '*'}) {
    for (const int mode : kModes) {
      const float x = rounded(op, a, b, mode);
      RC_ASSERT(holds(result_of<Worst>(op, a, b), x));
      RC_ASSERT(holds(result_of<Worst>(op, a, b), flushed(x)));
    }
  }
}

// sqrt(x) is as good as 1 / inversesqrt(x): two units for the latter, two and a half for the
// quotient (GLSL 4.50, 4.7.1).
TEST(Worst, ARootMayErrAsTheReciprocalOfAnInverseRoot) {
  Random random(702);
  for (int n = 0; n < 100'000; ++n) {
    const float a = static_cast<float>(std::abs(random.scaled(-60, 60)));
    const Worst w = sqrt(Worst(a));
    for (const int sign : {-1, 1}) {
      const double inverse = (1 + sign * 2 * 0x1p-23) / std::sqrt(static_cast<double>(a));
      const double root = (1 - sign * 2.5 * 0x1p-23) / inverse;
      ASSERT_LE(double(w.lo()), root) << a;
      ASSERT_GE(double(w.hi()), root) << a;
    }
  }
}

TEST(Worst, AQuotientMayErrByTwoAndAHalfUnits) {
  Random random(703);
  for (int n = 0; n < 100'000; ++n) {
    const float a = static_cast<float>(random.scaled(-60, 60)),
                b = static_cast<float>(random.scaled(-60, 60));
    const Worst w = Worst(a) / Worst(b);
    const Q exact = Q(a) / Q(b);
    int exponent;
    std::frexp(exact.get_d(), &exponent);
    // One unit in the last place of the result's binade.
    const Q error = Q(2.5) * Q(std::ldexp(1.0, exponent - 24));
    ASSERT_LE(Q(w.lo()), exact - error) << a << " / " << b;
    ASSERT_GE(Q(w.hi()), exact + error) << a << " / " << b;
  }
}

// Ranges as operands: any choice from them, in any mode, is held.
TEST(Worst, RangesHoldTheResultsOfTheirMembers) {
  Random random(705);
  for (int n = 0; n < 200'000; ++n) {
    const auto range = [&random] {
      const Worst x(static_cast<float>(random.scaled(-30, 30))),
          y(static_cast<float>(random.scaled(-30, 30)));
      return random.coin() ? x * y : x + y * Worst(0.1f);
    };
    const auto member = [&random](Worst w) { return random.coin() ? w.lo() : w.hi(); };
    const Worst a = range(), b = range();
    const float x = member(a), y = member(b);
    for (const char op : {'+', '-', '*', '/', 'r'}) {
      const bool divides_by_zero = op == '/' && b.lo() <= 0 && b.hi() >= 0;
      if (divides_by_zero || !defined(op, x, y)) continue;
      for (const int mode : kModes)
        ASSERT_TRUE(holds(result_of<Worst>(op, a, b), rounded(op, x, y, mode))) << x << op << y;
    }
    ASSERT_TRUE(holds(min(a, b), std::min(x, y)));
    ASSERT_TRUE(holds(max(a, b), std::max(x, y)));
    ASSERT_TRUE(holds(abs(a), std::abs(x)));
    ASSERT_TRUE(holds(-a, -x));
    ASSERT_TRUE(holds(a, fixed(a).lo()));
    ASSERT_EQ(fixed(a).lo(), fixed(a).hi());
  }
}

}  // namespace
}  // namespace farcull
