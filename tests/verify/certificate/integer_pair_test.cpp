// The integer pair agrees with rational arithmetic, direction by direction.
#include "verify/certificate/integer_pair.h"
#include "tests/lab/drawn_pairs.h"

#include "tests/lab/reference.h"
#include "tests/lab/test.h"
#include "verify/certificate/box_pairs.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using reference::text, reference::Triangle;

/// True where the direction of docs/certificate.md separates, written from that page alone.
bool page_separates(const Triangle& s, const Triangle& t, int direction) {
  using Integer = mpz_class;
  using V = reference::Vector<Integer>;
  const std::array<V, 3> a = reference::converted(s, reference::scaled);
  const std::array<V, 3> b = reference::converted(t, reference::scaled);
  const auto gap = [&](const V& d) { return reference::gap(a, b, d) > 0; };
  const auto edge = [](const std::array<V, 3>& c, int i) {
    return reference::minus(c[(i + 1) % 3], c[i]);
  };
  const auto perpendicular = [](const V& w, const V& e) {
    const Integer ee = reference::dot(e, e);
    const Integer we = reference::dot(w, e);
    return V{Integer(w[0] * ee - e[0] * we), Integer(w[1] * ee - e[1] * we),
             Integer(w[2] * ee - e[2] * we)};
  };
  if (direction == 0) return gap(reference::cross(edge(a, 0), edge(a, 1)));
  if (direction == 1) return gap(reference::cross(edge(b, 0), edge(b, 1)));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const V w = reference::minus(b[j], a[i]);
      if (direction == 2 + 3 * i + j) return gap(reference::cross(edge(a, i), edge(b, j)));
      if (direction == 11 + 3 * i + j) return gap(perpendicular(w, edge(a, i)));
      if (direction == 20 + 3 * i + j) return gap(perpendicular(w, edge(b, j)));
      if (direction == 29 + 3 * i + j) return gap(w);
    }
  }
  throw std::logic_error("no such direction");
}

void expect_every_direction_as_on_the_page(const Triangle& a, const Triangle& b) {
  IntegerPair pair(a, b);
  for (int direction = 0; direction < kDirections; ++direction) {
    ASSERT_EQ(pair.separated_by(direction), page_separates(a, b, direction))
        << direction << ": " << text(a, b);
  }
}

TEST(IntegerPair, EveryDirectionIsTheOneOfThePage) {
  for (const PairGenerator& generator : pair_generators()) {
    SCOPED_TRACE(generator.name);
    RandomDraws random(5);
    for (int n = 0; n < 100; ++n) {
      const DrawnPair pair = generator.make(random);
      expect_every_direction_as_on_the_page(pair.a, pair.b);
    }
  }
}

// Machine integers give way to GMP at differences of 30, 41 and 62 bits and coordinates of 125.
// Corners of a cube whose side just has that many bits come closest to overflow; the 1 pins the
// common scale.
TEST(IntegerPair, MachineIntegersNeverOverflow) {
  std::mt19937_64 random(17);
  for (const int bits :
       {29, 30, 31, 32, 33, 40, 41, 42, 43, 53, 61, 62, 63, 64, 124, 125, 126, 127, 128, 129}) {
    SCOPED_TRACE(bits);
    const double lo = -std::ldexp(1, bits - 1);
    const double hi = bits <= 53 ? -lo - 1 : std::nextafter(-lo, 0);  // hi - lo < 2^bits
    for (int n = 0; n < 250; ++n) {
      std::array<Triangle, 2> pair;
      for (Triangle& t : pair) {
        for (Vec3& p : t) {
          for (int k = 0; k < 3; ++k) {
            p[k] = random() % 2 == 0 ? lo : hi;
            if (random() % 16 == 0) p[k] = static_cast<double>(random() % 3) - 1;
            if (random() % 16 == 0) p[k] = std::nextafter(p[k], 0);
            if (n % 5 == 0) p[k] = random() % 2 == 0 ? lo : -lo;
            if (n % 5 < 2 && k > 0) p[k] = static_cast<double>(random() % 3) - 1;
          }
        }
      }
      pair[random() % 2][random() % 3][1 + static_cast<int>(random() % 2)] = 1;
      expect_every_direction_as_on_the_page(pair[0], pair[1]);
    }
  }
}

// Completeness: a direction for every disjoint pair, a point for every other one, never both, never
// neither.
TEST(IntegerPair, ADirectionOrAPointForEveryPair) {
  for (const PairGenerator& generator : pair_generators()) {
    RandomDraws random(99);
    int met = 0;
    for (int n = 0; n < 4'000; ++n) {
      const auto [a, b] = generator.make(random);
      IntegerPair pair(a, b);
      const bool expected = intersects(a, b);
      ASSERT_EQ(pair.separating_direction().has_value(), !expected)
          << generator.name << ": " << text(a, b);
      ASSERT_EQ(pair.has_common_point(), expected) << generator.name << ": " << text(a, b);
      met += expected;
    }
    // A generator whose pairs all meet, or none, would test nothing.
    EXPECT_TRUE(met > 80 && met < 3'920) << generator.name << ": " << met;
  }
}

TEST(IntegerPair, ADirectionOrAPointForEveryPairOnSmallGrids) {
  std::mt19937 random(23);
  for (int n = 0; n < 60'000; ++n) {
    std::array<Triangle, 2> t;
    const int flat = n % 3 == 0 ? 1 : 3;  // every third pair in one plane
    for (Triangle& corners : t)
      for (Vec3& p : corners)
        p = Vec3(random() % 3, random() % 3, static_cast<double>(random() % flat));
    IntegerPair pair(t[0], t[1]);
    const bool expected = reference::intersects(t[0], t[1]);
    ASSERT_EQ(pair.separating_direction().has_value(), !expected) << text(t[0], t[1]);
    ASSERT_EQ(pair.has_common_point(), expected) << text(t[0], t[1]);
  }
}

TEST(IntegerPair, TheWholeRangeOfDoubles) {
  constexpr double kMost = std::numeric_limits<double>::max();
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  const Triangle plate = {Vec3(-kMost, -kMost, 0), Vec3(kMost, -kMost, -0.0), Vec3(0, kMost, 0)};
  const Triangle through = {Vec3(0, 0, 0), Vec3(0, 1, kMost), Vec3(1, 0, kMost)};
  EXPECT_FALSE(IntegerPair(plate, through).separating_direction());
  const Triangle above = {Vec3(0, 0, kLeast), Vec3(0, 1, kMost), Vec3(1, 0, kMost)};
  EXPECT_TRUE(IntegerPair(plate, above).separating_direction());
  EXPECT_FALSE(IntegerPair(plate, above).has_common_point());
  const Triangle zero = {Vec3(0, 0, 0), Vec3(-0.0, 0, 0), Vec3(0, -0.0, 0)};
  EXPECT_FALSE(IntegerPair(zero, zero).separating_direction());
  EXPECT_TRUE(IntegerPair(zero, plate).has_common_point());
}

// ---- the enumeration ----

std::vector<TrianglePair> enumerated(const Scene& scene, std::size_t enough) {
  BoxPairs enumeration(scene);
  std::vector<TrianglePair> all;
  std::vector<TrianglePair> some;
  while (enumeration.next(some, enough)) {
    EXPECT_FALSE(some.empty());
    all.insert(all.end(), some.begin(), some.end());
  }
  EXPECT_TRUE(some.empty());
  return all;
}

TEST(IntegerPair, DecidesNeighboursAsTheReference) {
  std::array<int, 2> answers = {0, 0};
  for (const PairGenerator& generator : pair_generators()) {
    RandomDraws random(8);
    for (int n = 0; n < 150; ++n) {
      auto [a, b] = generator.make(random);
      b[random.below(3)] = a[random.below(3)];
      if (n % 2 == 0) b[random.below(3)] = a[random.below(3)];
      IntegerPair pair(a, b);
      ASSERT_TRUE(pair.shares_position());
      const bool expected = reference::intersects_beyond_shared(a, b);
      ASSERT_EQ(pair.meets_beyond_shared(), expected) << generator.name << " " << n;
      ++answers[expected];
    }
  }
  EXPECT_GT(answers[0], 200);
  EXPECT_GT(answers[1], 200);
}

TEST(BoxPairs, AreThoseOfAllPairsInOrder) {
  std::mt19937 random(31);
  std::size_t total = 0;
  for (int n = 0; n < 300; ++n) {
    std::vector<std::vector<Triangle>> objects(random() % 6);
    const int extent = 2 + static_cast<int>(random() % 30);
    for (auto& triangles : objects) {
      if (random() % 4 == 0) continue;  // objects without triangles, also at both ends
      triangles = reference::on_grid(random, random() % 40, extent);
    }
    Scene scene = reference::scene_of(objects);
    for (Object& object : scene.objects) object.self = random() % 3 == 0;
    std::vector<TrianglePair> expected;
    reference::for_each_pair(scene, [&](const TrianglePair& pair, bool overlap) {
      if (overlap) expected.push_back(pair);
    });
    for (const std::size_t enough : {1, 10, 1'000'000})
      EXPECT_EQ(enumerated(scene, enough), expected);
    total += expected.size();
  }
  EXPECT_GT(total, 5'000u);
}

}  // namespace
}  // namespace farcull
