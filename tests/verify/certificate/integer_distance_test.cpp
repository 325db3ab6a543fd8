// Exact distances in integers agree with brute force in rationals, and so do their features; the 38
// directions prove just what is as far.
#include "verify/certificate/integer_distance.h"

#include "experiments/generators/pair_generators.h"
#include "tests/lab/certificates.h"
#include "tests/lab/hard_pairs.h"
#include "verify/closest.h"

namespace farcull {
namespace {

using reference::Rational;
using reference::Triangle;

Rational value(const Fraction& x) {
  Rational out(x.over, x.under);
  out.canonicalize();
  return out;
}

Fraction fraction(const Rational& x) { return {x.get_num(), x.get_den()}; }

/// Of the pair: the distance, the features, and what is beyond lengths at and beside it.
void expect_distance(const Triangle& a, const Triangle& b) {
  const Rational expected = distance_case::squared(a, b);
  const IntegerDistance found = integer_distance(a, b);
  ASSERT_EQ(value(found.squared), expected);
  ASSERT_EQ(found.features, distance_case::features(a, b, expected));
  const Length length(found.squared);
  ASSERT_FALSE(is_beyond(a, b, length, false));
  ASSERT_TRUE(is_beyond(a, b, length, true));
  const Rational little = expected == 0 ? Rational(1) : Rational(expected / (mpz_class(1) << 200));
  const Length more(fraction(expected + little));
  ASSERT_FALSE(is_beyond(a, b, more, true));
  if (expected == 0) return;
  const Length less(fraction(expected - little));
  ASSERT_TRUE(is_beyond(a, b, less, false));
}

/// That verify/closest.h, which certificates are made with, says the same.
void expect_the_same_of_closest_points(const Triangle& a, const Triangle& b) {
  const Closest closest = closest_points(a, b);
  const IntegerDistance found = integer_distance(a, b);
  ASSERT_EQ(text_of(found.squared), closest.squared.text());
  for (int side = 0; side < 2; ++side)
    ASSERT_EQ(feature_text(found.features[side]), to_string(closest.features[side]));
}

TEST(IntegerDistance, IsThatOfClosestPoints) {
  for (const PairGenerator& generator : pair_generators()) {
    SCOPED_TRACE(generator.name);
    RandomDraws random(8);
    for (int n = 0; n < trials(1000); ++n) {
      const DrawnPair pair = generator.make(random);
      expect_the_same_of_closest_points(pair.a, pair.b);
      if (HasFatalFailure()) return;
    }
  }
  for (const auto& [name, make] : hard_pairs::generators()) {
    SCOPED_TRACE(name);
    RandomDraws random(12);
    for (int n = 0; n < trials(1000); ++n) {
      const DrawnPair pair = make(random);
      if (hard_pairs::finite(pair)) expect_the_same_of_closest_points(pair.a, pair.b);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(IntegerDistance, IsThatOfBruteForceOnEveryGenerator) {
  for (const PairGenerator& generator : pair_generators()) {
    SCOPED_TRACE(generator.name);
    RandomDraws random(7);
    for (int n = 0; n < trials(40); ++n) {
      const DrawnPair pair = generator.make(random);
      expect_distance(pair.a, pair.b);
    }
  }
}

TEST(IntegerDistance, IsThatOfBruteForceOnHardPairs) {
  for (const auto& [name, make] : hard_pairs::generators()) {
    SCOPED_TRACE(name);
    RandomDraws random(11);
    for (int n = 0; n < trials(40); ++n) {
      const DrawnPair pair = make(random);
      if (hard_pairs::finite(pair)) expect_distance(pair.a, pair.b);
    }
  }
}

// Corners on a small grid: parallel edges and faces, common points and degenerate triangles by the
// thousand, so that most pairs of features that can be first are.
TEST(IntegerDistance, IsThatOfBruteForceOnASmallGrid) {
  std::mt19937_64 random(3);
  std::set<std::array<std::uint8_t, 2>> seen;
  for (int n = 0; n < trials(3000); ++n) {
    std::array<Triangle, 2> pair;
    for (Triangle& t : pair) {
      for (Vec3& p : t)
        for (double& x : p) x = static_cast<double>(random() % (n % 2 == 0 ? 3 : 6));
    }
    if (n % 3 == 0)
      for (Vec3& p : pair[1]) p.z() += 4;
    expect_distance(pair[0], pair[1]);
    expect_the_same_of_closest_points(pair[0], pair[1]);
    if (HasFatalFailure()) return;
    seen.insert(integer_distance(pair[0], pair[1]).features);
  }
  // Corners and edges with everything, and the face with corners and edges: 48 in all.
  EXPECT_GE(seen.size(), static_cast<std::size_t>(trials(40, 10)));
  EXPECT_FALSE(seen.contains({6, 6}));
}

TEST(Fraction, RootAboveIsAboveAndHardlyMore) {
  std::mt19937_64 random(5);
  for (int n = 0; n < 2000; ++n) {
    const double x = std::ldexp(static_cast<double>(random() >> 11),
                                static_cast<int>(random() % 2090) - 1090 - 52);
    if (!std::isfinite(x) || x == 0) continue;
    EXPECT_EQ(root_above(square_of(x)), x);
    Fraction more = square_of(x);
    more.over = more.over * 1'000'000 + 1;
    more.under *= 1'000'000;
    EXPECT_EQ(root_above(more), std::nextafter(x, std::numeric_limits<double>::infinity())) << x;
  }
  EXPECT_EQ(root_above({0, 7}), 0);
  EXPECT_EQ(root_above({2, 1}), std::sqrt(2.0));  // 1.4142135623730951, rounded up
  EXPECT_EQ(root_above({3, 1}), std::nextafter(std::sqrt(3.0), 2));  // rounded down
  Fraction huge = square_of(std::numeric_limits<double>::max());
  huge.over += 1;
  EXPECT_EQ(root_above(huge), std::numeric_limits<double>::infinity());
}

TEST(Fraction, ReadsItsOwnTextAndNothingElse) {
  for (const char* text : {"0/1", "5/4", "1/123456789012345678901234567890"})
    EXPECT_EQ(text_of(*parse_fraction(text)), text);
  EXPECT_EQ(text_of({6, 4}), "3/2");
  EXPECT_EQ(text_of({0, 4}), "0/1");
  const std::string longest(kMostDigits, '9');
  EXPECT_TRUE(parse_fraction(longest + "/1"));
  for (const std::string& text :
       {std::string(),        std::string("5"),     std::string("5/"),       std::string("/5"),
        std::string("5/0"),   std::string("-5/4"),  std::string("5/-4"),     std::string("+5/4"),
        std::string("05/4"),  std::string("5/04"),  std::string("10/8"),     std::string("0/2"),
        std::string("5 /4"),  std::string("5/4 "),  std::string("5/4/1"),    std::string("0x5/4"),
        std::string("5.0/4"), std::string("5e0/4"), std::string("5/4\0", 4), longest + "9/1"})
    EXPECT_FALSE(parse_fraction(text)) << text;
}

}  // namespace
}  // namespace farcull
