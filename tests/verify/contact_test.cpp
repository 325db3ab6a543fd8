// Kinds of contact, each from triangles made for it.
#include "verify/contact.h"

#include "tests/lab/rational.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using rational::Random;
using reference::kMax;
using reference::kPermutations;
using reference::kTiny;
using reference::reordered;
using reference::Triangle;

/// The definition by the difference A - B: penetrating iff 0 is an interior point of it, that is,
/// iff no d != 0 has d . p >= 0 for all nine differences p of corners. If the p span less than all
/// directions, some d is perpendicular to all. Else such d form a pointed cone, which has an
/// extreme ray if it is not {0}, and that is perpendicular to two independent p: a multiple of
/// their cross product. No plane, no interval and no orientation is shared with what is tested.
/// `keep` (of 9) is for the twin: how many differences are looked at.
template <typename Integer>
bool differences_penetrate(const std::array<reference::Vector<Integer>, 3>& a,
                           const std::array<reference::Vector<Integer>, 3>& b, int keep = 9) {
  std::vector<reference::Vector<Integer>> p;
  for (int k = 0; k < keep; ++k) p.push_back(reference::minus(a[k / 3], b[k % 3]));
  bool spans = false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      const auto d = reference::cross(p[i], p[j]);
      if (d[0] == 0 && d[1] == 0 && d[2] == 0) continue;
      bool below = false, above = false;
      for (const auto& q : p) {
        const Integer side = reference::dot(d, q);
        below = below || side < 0;
        above = above || side > 0;
      }
      if (!below || !above) return false;
      spans = true;
    }
  }
  return spans;
}

bool by_reference(const Triangle& a, const Triangle& b) {
  using reference::converted;
  if (!reference::small_integers(a) || !reference::small_integers(b))
    return differences_penetrate(converted(a, reference::scaled), converted(b, reference::scaled));
  const auto small = [](double x) { return std::int64_t(x); };
  return differences_penetrate(converted(a, small), converted(b, small));
}

/// The answer under every order of arguments and corners, and the reference's.
void expect_contact(bool expected, const Triangle& a, const Triangle& b) {
  EXPECT_TRUE(intersects(a, b));
  EXPECT_EQ(by_reference(a, b), expected);
  for (const auto& i : kPermutations) {
    for (const auto& j : kPermutations) {
      EXPECT_EQ(penetrate(reordered(a, i), reordered(b, j)), expected);
      EXPECT_EQ(penetrate(reordered(b, j), reordered(a, i)), expected);
    }
  }
}

const Triangle kPlate = {Vec3(0, 0, 0), Vec3(8, 0, 0), Vec3(0, 8, 0)};
constexpr bool kTouching = false, kPenetrating = true;

TEST(Contact, CrossingTrianglesPenetrate) {
  // A corner through the plate; an edge of each through the other; a shared corner and beyond.
  expect_contact(kPenetrating, kPlate, {Vec3(2, 2, -1), Vec3(2, 3, 4), Vec3(3, 2, 4)});
  expect_contact(kPenetrating, kPlate, {Vec3(2, -2, -1), Vec3(2, -2, 1), Vec3(2, 4, 0)});
  expect_contact(kPenetrating, kPlate, {Vec3(0, 0, 0), Vec3(5, 5, 2), Vec3(5, 5, -2)});
}

TEST(Contact, WhatMeetsInAnEdgeOrACornerTouches) {
  // Corner on face, corner on edge, corner on corner, edge on face, edge across edge, edge on edge,
  // and two that cross each other's planes and end at one point of the common line.
  expect_contact(kTouching, kPlate, {Vec3(2, 2, 0), Vec3(2, 3, 4), Vec3(3, 2, 4)});
  expect_contact(kTouching, kPlate, {Vec3(4, 4, 0), Vec3(9, 9, 4), Vec3(9, 9, 5)});
  expect_contact(kTouching, kPlate, {Vec3(0, 0, 0), Vec3(-1, 0, 4), Vec3(0, -1, 4)});
  expect_contact(kTouching, kPlate, {Vec3(1, 1, 0), Vec3(3, 3, 0), Vec3(2, 2, 5)});
  expect_contact(kTouching, kPlate, {Vec3(1, 0, -1), Vec3(1, 0, 1), Vec3(1, -5, 0)});
  expect_contact(kTouching, kPlate, {Vec3(0, 0, 0), Vec3(8, 0, 0), Vec3(4, 0, 5)});
  expect_contact(kTouching, kPlate, {Vec3(2, 0, -3), Vec3(2, 0, 3), Vec3(2, -4, 1)});
  expect_contact(kTouching, kPlate, {Vec3(3, 5, 0), Vec3(5, 5, 2), Vec3(5, 5, -2)});
}

TEST(Contact, OneUlpDecides) {
  const auto spike = [](double z) { return Triangle{Vec3(2, 2, z), Vec3(2, 3, 4), Vec3(3, 2, 4)}; };
  expect_contact(kTouching, kPlate, spike(0));
  expect_contact(kPenetrating, kPlate, spike(-kTiny));
  // The end of the common segment at the edge y = 0, and beyond it.
  const auto blade = [](double y) {
    return Triangle{Vec3(2, -4, -3), Vec3(2, -4, 3), Vec3(2, y, 0)};
  };
  expect_contact(kTouching, kPlate, blade(0));
  expect_contact(kPenetrating, kPlate, blade(kTiny));
}

TEST(Contact, TrianglesOfOnePlaneTouch) {
  expect_contact(kTouching, kPlate, kPlate);
  expect_contact(kTouching, kPlate, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)});
  expect_contact(kTouching, kPlate, {Vec3(4, 4, 0), Vec3(9, 9, 0), Vec3(8, 9, 0)});
  const double up = std::nextafter(1.0, 2.0);  // a plane that is none by one ulp
  const Triangle low = {Vec3(0, 0, 1), Vec3(8, 0, 1), Vec3(0, 8, 1)};
  expect_contact(kPenetrating, low, {Vec3(1, 1, up), Vec3(2, 1, up), Vec3(1, 2, 2 - up)});
}

TEST(Contact, DegenerateTrianglesAreSegmentsAndPoints) {
  const auto segment = [](const Vec3& p, const Vec3& q) { return Triangle{p, (p + q) / 2, q}; };
  expect_contact(kPenetrating, kPlate, segment({2, 2, -1}, {2, 2, 1}));
  expect_contact(kPenetrating, kPlate, {Vec3(2, 2, -1), Vec3(2, 2, -1), Vec3(2, 2, 1)});
  expect_contact(kTouching, kPlate, segment({2, 2, 0}, {2, 2, 2}));   // ends on the face
  expect_contact(kTouching, kPlate, segment({2, 0, -1}, {2, 0, 1}));  // through an edge
  expect_contact(kTouching, kPlate, segment({0, 0, -1}, {0, 0, 1}));  // through a corner
  expect_contact(kTouching, kPlate, segment({1, 1, 0}, {3, 2, 0}));   // in the plane
  expect_contact(kTouching, segment({-1, 0, 0}, {1, 0, 0}), segment({0, -1, 0}, {0, 1, 0}));
  expect_contact(kTouching, segment({-1, 0, 0}, {1, 0, 0}), segment({0, 0, 0}, {4, 0, 0}));
  const Triangle point = {Vec3(2, 2, 0), Vec3(2, 2, -0.0), Vec3(2, 2, 0)};
  expect_contact(kTouching, kPlate, point);
  expect_contact(kTouching, segment({2, 2, -2}, {2, 2, 2}), point);
  expect_contact(kTouching, point, point);
}

TEST(Contact, TheEndsOfTheDoubles) {
  const Triangle wide = {Vec3(-kMax, -kMax, 0), Vec3(kMax, -kMax, 0), Vec3(0, kMax, 0)};
  expect_contact(kPenetrating, wide,
                 {Vec3(0, 0, -kTiny), Vec3(kTiny, 0, kTiny), Vec3(0, 0, kTiny)});
  expect_contact(kTouching, wide, {Vec3(0, 0, 0), Vec3(kTiny, 0, kTiny), Vec3(0, 0, kTiny)});
  expect_contact(kPenetrating, wide, {Vec3(0, 0, -kMax), Vec3(kMax, 1, kMax), Vec3(0, 3, kMax)});
  const Triangle small = {Vec3(0, 0, 0), Vec3(2 * kTiny, 0, 0), Vec3(0, 2 * kTiny, 0)};
  expect_contact(kPenetrating, {Vec3(0, 0, 0), Vec3(4 * kTiny, 0, 0), Vec3(0, 4 * kTiny, 0)},
                 {Vec3(kTiny, kTiny, -kTiny), Vec3(kTiny, kTiny, kTiny), Vec3(9, 9, 0)});
  expect_contact(kTouching, small, small);
}

/// All triangles, segments and points on a grid.
std::vector<Triangle> on_grid(int x, int y, int z) {
  std::vector<Vec3> points;
  for (int i = 0; i < x * y * z; ++i) points.emplace_back(i % x, i / x % y, i / x / y);
  std::vector<Triangle> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i; j < points.size(); ++j)
      for (std::size_t k = j; k < points.size(); ++k)
        out.push_back({points[i], points[j], points[k]});
  }
  return out;
}

/// How many pairs on the grid differ. Ends at the first triangle with one where a corner is
/// forgotten.
std::uint64_t differences_on_grid(int keep, std::uint64_t& penetrating) {
  std::vector<std::array<reference::Vector<std::int64_t>, 3>> exact;
  const std::vector<Triangle> all = on_grid(3, 3, 2);
  for (const Triangle& t : all)
    exact.push_back(reference::converted(t, [](double x) { return std::int64_t(x); }));
  std::uint64_t differences = 0;
  for (std::size_t i = 0; i < all.size() && (keep == 9 || differences == 0); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) {
      const bool found = penetrate(all[i], all[j]);
      penetrating += found;
      differences += found != differences_penetrate(exact[i], exact[j], keep);
    }
  }
  return differences;
}

TEST(Contact, EveryPairOnAGridAsTheDifferenceOfTheTwoSays) {
  std::uint64_t penetrating = 0;
  EXPECT_EQ(differences_on_grid(9, penetrating), 0u);
  EXPECT_GT(penetrating, 0u);
}

// The twin: a reference that leaves out one difference of corners does not agree.
TEST(Contact, ADefinitionThatForgetsACornerIsCaught) {
  std::uint64_t penetrating = 0;
  EXPECT_GT(differences_on_grid(8, penetrating), 0u);
}

// The twin of strict signs: where closed triangles are asked instead of their interiors, as
// intersects() does, touching pairs come out as penetrating ones.
TEST(Contact, ClosedTrianglesInsteadOfInteriorsAreCaught) {
  const std::vector<Triangle> all = on_grid(2, 2, 2);
  int caught = 0;
  for (const Triangle& a : all) {
    for (const Triangle& b : all) {
      caught += intersects(a, b) && by_reference(a, b) == kTouching;
      EXPECT_TRUE(by_reference(a, b) == kTouching || intersects(a, b));
    }
  }
  EXPECT_GT(caught, 0);
}

// Coordinates of few values of all sizes, so that corners, edges and planes often coincide.
TEST(Contact, AsTheReferenceAmongDoublesOfEverySize) {
  Random random(test_seed(501));
  std::uint64_t penetrating = 0, touching = 0;
  for (int n = 0; more_cases(n, 4000, penetrating > 50 && touching > 50); ++n) {
    std::array<double, 5> values{};
    for (double& value : values)
      value = n % 2 == 0 ? random.uniform(-1, 1) : random.scaled(-40, 40);
    const auto triangle = [&] {
      Triangle t;
      for (Vec3& p : t)
        for (int axis = 0; axis < 3; ++axis) p[axis] = values[random.below(5)];
      return t;
    };
    const Triangle a = triangle(), b = triangle();
    const bool expected = by_reference(a, b);
    ASSERT_EQ(penetrate(a, b), expected) << "pair " << n;
    ASSERT_EQ(penetrate(b, a), expected) << "pair " << n;
    const auto& order = kPermutations[random.below(6)];
    ASSERT_EQ(penetrate(reordered(a, order), b), expected) << "pair " << n;
    if (intersects(a, b)) ++(expected == kPenetrating ? penetrating : touching);
  }
}

TEST(CountContacts, CountsEachPairWhateverTheThreads) {
  Random random(502);
  const Scene scene = reference::soup(random, 100, 5);
  std::vector<TrianglePair> pairs;
  ContactCounts expected;
  for (std::uint32_t a = 0; a < 100; ++a) {
    for (std::uint32_t b = a + 1; b < 100; ++b) {
      if (!intersects(scene.corners(a), scene.corners(b))) continue;
      pairs.insert(pairs.end(), 2, {a, b});  // a pair that is given twice counts twice
      const bool contact = by_reference(scene.corners(a), scene.corners(b));
      (contact == kPenetrating ? expected.penetrating : expected.touching) += 2;
    }
  }
  EXPECT_GT(pairs.size(), 2048u);  // enough for more than one thread
  EXPECT_GT(expected.touching, 0u);
  EXPECT_GT(expected.penetrating, 0u);
  for (const unsigned threads : {0u, 1u, 2u, 7u})
    EXPECT_EQ(count_contacts(scene, pairs, threads), expected);
  EXPECT_EQ(count_contacts(scene, {}), ContactCounts{});
}

TEST(CountContacts, RefusesPairsThatAreNone) {
  Scene scene;
  scene.vertices = {kPlate[0], kPlate[1], kPlate[2]};
  scene.triangles = {{0, 1, 2}, {0, 1, 2}};
  scene.source_face = {0, 1};
  scene.objects.push_back({"plate", 0, 2, true});
  EXPECT_THROW(count_contacts(scene, std::vector<TrianglePair>{{0, 2}}), std::logic_error);
  EXPECT_THROW(count_contacts(scene, std::vector<TrianglePair>{{1, 1}}), std::logic_error);
}

}  // namespace
}  // namespace farcull
