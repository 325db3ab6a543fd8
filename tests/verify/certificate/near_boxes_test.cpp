// Boxes that are proved far apart are, exactly; and what is not proved is nearly as near.
#include "verify/certificate/box_pairs.h"

#include "tests/lab/reference.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using reference::Rational;
using Bounds = BoundsTree::Bounds;

Rational squared(const Bounds& x, const Bounds& y) {
  Rational sum = 0;
  for (int k = 0; k < 3; ++k) {
    const Rational gap = std::max({Rational(Rational(y.lo[k]) - Rational(x.hi[k])),
                                   Rational(Rational(x.lo[k]) - Rational(y.hi[k])), Rational(0)});
    sum += gap * gap;
  }
  return sum;
}

/// Coordinates of about the size 2^exponent, some of them much smaller or equal.
Bounds random_box(std::mt19937_64& random, int exponent) {
  Bounds box;
  for (int k = 0; k < 3; ++k) {
    const auto one = [&] {
      const double x = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
      return std::ldexp(
          x, std::min(exponent - (random() % 4 == 0 ? static_cast<int>(random() % 60) : 0), 1024));
    };
    box.lo[k] = one();
    box.hi[k] = random() % 3 == 0 ? box.lo[k] : one();
    if (box.lo[k] > box.hi[k]) std::swap(box.lo[k], box.hi[k]);
  }
  return box;
}

/// Doubles at and around the root of a square.
std::vector<double> lengths_near(const Rational& square) {
  const double root = mpf_class(sqrt(mpf_class(square, 6000))).get_d();
  std::vector<double> out = {0, root, 2 * root, root / 2};
  for (const double step : {0x1p-53, 0x1p-52, 0x1p-50, 0x1p-49, 0x1p-48, 0x1p-47}) {
    out.push_back(root * (1 + step));
    out.push_back(root * (1 - step));
  }
  return out;
}

TEST(FarBoxes, ProveOnlyWhatIsExactlySo) {
  std::mt19937_64 random(29);
  int proved = 0, not_proved = 0;
  for (int n = 0; more_cases(n, trials(4000), proved > 300 && not_proved > 300); ++n) {
    const int exponent = static_cast<int>(random() % 2090) - 1070;
    const Bounds x = random_box(random, exponent);
    const Bounds y = random_box(random, exponent);
    const Rational square = squared(x, y);
    for (const double length : lengths_near(square)) {
      if (!std::isfinite(length)) continue;
      const bool far = FarBoxes(length).proved(x, y);
      const bool is_far = square > Rational(length) * Rational(length);
      ASSERT_TRUE(is_far || !far) << length;
      // A margin of 2^-48 of the square is all that is lost, where no length is subnormal.
      if (!far && length > 0x1p-1000) {
        ASSERT_LE(square, Rational(length) * Rational(length) * Rational(1 + 0x1p-46)) << length;
      }
      ++(far ? proved : not_proved);
    }
  }
}

// The same sum without the margin says of boxes that they are farther apart than they are.
TEST(FarBoxes, NeedTheMargin) {
  std::mt19937_64 random(31);
  int wrong = 0;
  for (int n = 0; n < 4000; ++n) {
    const Bounds x = random_box(random, 3);
    const Bounds y = random_box(random, 3);
    const Rational square = squared(x, y);
    for (const double length : lengths_near(square)) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        const double gap = std::max({y.lo[k] - x.hi[k], x.lo[k] - y.hi[k], 0.0});
        sum += gap * gap;
      }
      wrong += sum >= length * length && square < Rational(length) * Rational(length);
    }
  }
  EXPECT_GT(wrong, 0);
}

TEST(FarBoxes, OfTheLargestAndTheSmallestLengths) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
  const auto at = [](double x, double y, double z) { return Bounds{{x, y, z}, {x, y, z}}; };
  const Bounds origin = at(0, 0, 0);
  const auto proved = [&](double length, const Bounds& x, const Bounds& y) {
    const bool far = FarBoxes(length).proved(x, y);
    EXPECT_EQ(far, FarBoxes(length).proved(y, x));
    return far;
  };
  EXPECT_FALSE(
      proved(std::numeric_limits<double>::infinity(), at(-kLargest, 0, 0), at(kLargest, 0, 0)));
  EXPECT_TRUE(proved(kLargest, at(-kLargest, 0, 0), at(kLargest, 0, 0)));
  EXPECT_TRUE(proved(kLargest, origin, at(kLargest, kLargest, 0)));
  EXPECT_FALSE(proved(kLargest, origin, at(kLargest, 0, 0)));
  EXPECT_FALSE(proved(kSmallest, origin, at(kSmallest, 0, 0)));
  EXPECT_TRUE(proved(kSmallest, origin, at(kSmallest, kSmallest, 0)));
  EXPECT_TRUE(proved(kSmallest, origin, at(2 * kSmallest, 0, 0)));
  EXPECT_FALSE(proved(0, origin, origin));
  EXPECT_TRUE(proved(0, origin, at(kSmallest, 0, 0)));
}

// All pairs that boxes do not prove far apart, each once, whatever the size of the blocks.
TEST(NearBoxes, AreAllPairsThatAreNotProvedFar) {
  std::mt19937_64 random(37);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<std::vector<reference::Triangle>> objects(3);
  for (std::size_t o = 0; o < 3; ++o) {
    objects[o].resize(o == 2 ? 0 : 150);
    for (reference::Triangle& t : objects[o]) {
      const Vec3 at(10 * unit() + 12.0 * static_cast<double>(o), 10 * unit(), 10 * unit());
      for (Vec3& p : t) p = at + Vec3(unit(), unit(), unit());
    }
  }
  const Scene scene = reference::scene_of(objects);
  const BoundsTree all(scene);
  NearBoxes boxes(scene);
  for (const double length : {0.0, 1.0, 4.0, 30.0, std::numeric_limits<double>::infinity()}) {
    for (const std::uint32_t other : {1u, 0u}) {  // object 0 with the next one, or with itself
      const FarBoxes far(length);
      std::set<TrianglePair> expected;
      for (std::uint32_t a = 0; a < 150; ++a) {
        for (std::uint32_t b = other == 0 ? a + 1 : 150; b < (other == 0 ? 150u : 300u); ++b)
          if (!far.proved(all.bounds[a], all.bounds[b])) expected.insert({a, b});
      }
      for (const std::size_t enough : {std::size_t{1}, std::size_t{100}, std::size_t{1} << 20}) {
        std::vector<TrianglePair> found;
        boxes.ask(0, other, length);
        for (bool more = true; more;) {
          std::vector<TrianglePair> pairs;
          more = boxes.next(pairs, enough);
          found.insert(found.end(), pairs.begin(), pairs.end());
        }
        EXPECT_EQ(found.size(), expected.size());
        EXPECT_EQ(std::set<TrianglePair>(found.begin(), found.end()), expected);
      }
    }
  }
  boxes.ask(0, 2, 1);
  std::vector<TrianglePair> none;
  EXPECT_FALSE(boxes.next(none, 1));
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace farcull
