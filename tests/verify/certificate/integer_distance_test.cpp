// Exact distances in integers agree with brute force in rationals, and so do their features; the 38
// directions prove just what is as far.
#include "verify/certificate/integer_distance.h"

#include "experiments/method/distances.h"
#include "tests/lab/grid_distance.h"
#include "tests/lab/hard_pairs.h"
#include "tests/lab/parts.h"

namespace farcull {
namespace {

using near_lab::squared_distance_of, reference::Rational, reference::Triangle;

Rational value(const Fraction& x) {
  Rational out(x.over, x.under);
  out.canonicalize();
  return out;
}

Fraction fraction(const Rational& x) { return {x.get_num(), x.get_den()}; }

/// A corner, an edge or the triangle itself, as a triangle.
Triangle part(const Triangle& t, int feature) {
  if (feature < 3) return {t[feature], t[feature], t[feature]};
  return feature < 6 ? Triangle{t[feature - 3], t[(feature - 2) % 3], t[(feature - 2) % 3]} : t;
}

/// The first two features that are as near as the triangles, the square of whose distance is given.
std::array<std::uint8_t, 2> features(const Triangle& a, const Triangle& b, const Rational& least) {
  for (std::uint8_t i = 0; i < 7; ++i) {
    for (std::uint8_t j = 0; j < 7; ++j) {
      if (squared_distance_of(part(a, i), part(b, j)) == least) return {i, j};
    }
  }
  throw std::logic_error("no features");
}

/// Of the pair: the distance, the features, and what is beyond lengths at and beside it.
void expect_distance(const Triangle& a, const Triangle& b) {
  const Rational expected = squared_distance_of(a, b);
  const IntegerDistance found = integer_distance(a, b);
  ASSERT_EQ(value(found.squared), expected);
  ASSERT_EQ(found.features, features(a, b, expected));
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

/// That verify/closest.h says the same.
void expect_the_same_of_closest_points(const Triangle& a, const Triangle& b) {
  const Closest closest = closest_points(a, b);
  const IntegerDistance found = integer_distance(a, b);
  ASSERT_EQ(found.squared, *parse_fraction(closest.squared.text()));
  for (int side = 0; side < 2; ++side)
    ASSERT_EQ(found.features[side], number_of(closest.features[side]));
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
  // Corners and edges with everything, and the face with corners and edges: 48 in all.
  const auto most = static_cast<std::size_t>(trials(40, 10));
  for (int n = 0; more_cases(n, trials(3000), seen.size() >= most); ++n) {
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

TEST(Fraction, ReadsTextInLowestTermsAndNothingElse) {
  EXPECT_EQ(*parse_fraction("0/1"), (Fraction{0, 1}));
  EXPECT_EQ(*parse_fraction("5/4"), (Fraction{5, 4}));
  EXPECT_EQ(parse_fraction("1/123456789012345678901234567890")->under,
            mpz_class("123456789012345678901234567890"));
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

// ---- What lies inside what, in integers: against tetrahedra of small whole numbers, whose rays
// meet edges and corners all the time, and against the answer of the program.

using Whole = std::array<long, 3>;
using Tetrahedron = std::array<Whole, 4>;
constexpr std::array<std::array<std::uint32_t, 3>, 4> kFaces = {
    {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};

long determinant(const Whole& o, const Whole& p, const Whole& q, const Whole& r) {
  std::array<Whole, 3> m{};
  for (int k = 0; k < 3; ++k) m[0][k] = p[k] - o[k], m[1][k] = q[k] - o[k], m[2][k] = r[k] - o[k];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Strictly: on the same side of each face as the corner across.
bool holds(const Tetrahedron& t, const Whole& x) {
  for (const auto& [i, j, k] : kFaces) {
    const std::uint32_t across = 6 - i - j - k;
    const long of_x = determinant(t[i], t[j], t[k], x);
    const long of_t = determinant(t[i], t[j], t[k], t[across]);
    if (of_x == 0 || (of_x > 0) != (of_t > 0)) return false;
  }
  return true;
}

/// The number of faces that the ray along the first axis crosses, where an edge or a corner that it
/// meets counts as crossed: what happens without the shift of the ray.
bool odd_without_shift(const Tetrahedron& t, const Whole& x) {
  bool odd = false;
  for (const auto& [i, j, k] : kFaces) {
    const auto side = [&](const Whole& p, const Whole& q) {
      return (p[1] - x[1]) * (q[2] - x[2]) - (p[2] - x[2]) * (q[1] - x[1]);
    };
    const std::array<long, 3> s = {side(t[i], t[j]), side(t[j], t[k]), side(t[k], t[i])};
    const bool left = s[0] >= 0 && s[1] >= 0 && s[2] >= 0;
    const bool right = s[0] <= 0 && s[1] <= 0 && s[2] <= 0;
    if (!left && !right) continue;
    const long ahead = determinant(x, t[i], t[j], t[k]);
    if (left ? ahead > 0 : ahead < 0) odd = !odd;
  }
  return odd;
}

Tetrahedron random_tetrahedron(rational::Draws& random, long from, long below) {
  Tetrahedron t{};
  do {
    for (Whole& p : t)
      for (long& x : p) x = from + random.below(static_cast<unsigned>(below));
  } while (determinant(t[0], t[1], t[2], t[3]) == 0);
  return t;
}

/// An object of some tetrahedra, then another one.
Scene scene_of(const std::vector<Tetrahedron>& a, const std::vector<Tetrahedron>& b, double unit) {
  lab::Parts parts;
  for (const auto* object : {&a, &b}) {
    for (const Tetrahedron& t : *object) {
      const std::uint32_t first = parts.next();
      for (const auto& [x, y, z] : t)
        parts.vertex(double(x) * unit, double(y) * unit, double(z) * unit);
      for (const auto& [i, j, k] : kFaces) parts.triangle(first + i, first + j, first + k);
    }
    parts.end("");
  }
  return parts.scene;
}

bool meet(const Scene& scene) {
  for (std::uint32_t s = 0; s < scene.objects[0].triangle_count; ++s) {
    for (std::uint32_t t = scene.objects[1].first_triangle; t < scene.triangles.size(); ++t)
      if (integer_distance(scene.corners(s), scene.corners(t)).squared.over == 0) return true;
  }
  return false;
}

// The outer object has one or two tetrahedra, which may overlap: then what is in both is outside.
TEST(IntegerInside, IsThatOfTetrahedraOfWholeNumbers) {
  rational::Draws random(31);
  int in = 0, out = 0, twin_wrong = 0;
  for (int n = 0; more_cases(n, trials(1'200), in > 5 && out > 5 && twin_wrong > 1); ++n) {
    std::vector<Tetrahedron> outer = {random_tetrahedron(random, 0, 13)};
    if (random.below(3) == 0) outer.push_back(random_tetrahedron(random, 0, 13));
    Tetrahedron inner{};
    const Whole at = {4 + random.below(5), 4 + random.below(5), 4 + random.below(5)};
    for (std::size_t i = 0; i < 4; ++i) {
      inner[i] = at;
      if (i > 0) ++inner[i][i - 1];
    }
    const double unit = std::exp2(random.below(4) == 0 ? random.uniform(-1060, 1000) : 0);
    const bool swapped = random.coin();
    const Scene scene = swapped ? scene_of({inner}, outer, unit) : scene_of(outer, {inner}, unit);
    if (meet(scene)) continue;
    bool expected = false, naive = false;
    for (const Tetrahedron& t : outer) {
      expected = expected != holds(t, at);
      naive = naive != odd_without_shift(t, at);
    }
    const InsideClaim yes = swapped ? InsideClaim::a : InsideClaim::b;
    const auto found = IntegerInside(scene).which(0, 1);
    ASSERT_EQ(found, expected ? yes : InsideClaim::none) << n;
    ASSERT_EQ(found, Insides(scene).which(0, 1)) << n;
    (expected ? in : out) += 1;
    twin_wrong += naive != expected;
  }
}

TEST(IntegerInside, AllPartsHaveToBeInside) {
  const Tetrahedron large = {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}};
  const Tetrahedron inside = {{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}}};
  const Tetrahedron outside = {{{7, 7, 7}, {8, 7, 7}, {7, 8, 7}, {7, 7, 8}}};
  const auto which = [](const Scene& scene) { return IntegerInside(scene).which(0, 1); };
  EXPECT_EQ(which(scene_of({large}, {inside, inside}, 1)), InsideClaim::b);
  EXPECT_EQ(which(scene_of({large}, {inside, outside}, 1)), InsideClaim::none);
  EXPECT_EQ(which(scene_of({large}, {outside, inside}, 1)), InsideClaim::none);
  // Positions decide what is closed, with zeros of either sign.
  Scene scene = scene_of({large}, {inside}, 1);
  for (auto& t : scene.triangles) {
    for (std::uint32_t& v : t) {
      scene.vertices.push_back(scene.vertices[v]);
      for (double& x : scene.vertices.back())
        if (x == 0 && v % 2 == 0) x = -0.0;
      v = static_cast<std::uint32_t>(scene.vertices.size() - 1);
    }
  }
  EXPECT_EQ(which(scene), InsideClaim::b);
  EXPECT_THROW(IntegerInside(scene).which(0, 0), std::logic_error);
  EXPECT_THROW(IntegerInside(scene).which(0, 2), std::logic_error);
}

}  // namespace
}  // namespace farcull
