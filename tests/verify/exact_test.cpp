// The exact predicates agree with rational arithmetic, degenerate triangles included.
#include "verify/exact.h"

#include <rapidcheck/gtest.h>

#include "tests/lab/rational.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using reference::kMax, reference::kPermutations, reference::kTiny, reference::reordered,
    reference::text, reference::Triangle;

double up(double x) { return std::nextafter(x, kMax); }
double down(double x) { return std::nextafter(x, -kMax); }

Triangle segment(const Vec3& a, const Vec3& b) { return {a, b, a}; }
Triangle single_point(const Vec3& a) { return {a, a, a}; }

Triangle with_axes(const Triangle& t, const std::array<int, 3>& axes) {
  Triangle result;
  for (int i = 0; i < 3; ++i) result[i] = {t[i][axes[0]], t[i][axes[1]], t[i][axes[2]]};
  return result;
}

/// The answer, under every order of arguments and corners and every permutation of axes, and the
/// reference's.
void expect_intersects(bool expected, const Triangle& a, const Triangle& b) {
  EXPECT_EQ(reference::intersects(a, b), expected) << "the reference: " << text(a, b);
  for (const auto& axes : kPermutations) {
    for (const auto& i : kPermutations) {
      for (const auto& j : kPermutations) {
        const Triangle s = with_axes(reordered(a, i), axes);
        const Triangle t = with_axes(reordered(b, j), axes);
        EXPECT_EQ(intersects(s, t), expected) << text(s, t);
        EXPECT_EQ(intersects(t, s), expected) << text(t, s);
      }
    }
  }
}

const Triangle kUnit = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

TEST(Shape, SeesPointsSegmentsAndTriangles) {
  EXPECT_EQ(shape(kUnit), Shape::triangle);
  EXPECT_EQ(shape(single_point({1, 2, 3})), Shape::point);
  EXPECT_EQ(shape({Vec3(0.0, -0.0, 0.0), Vec3(-0.0, 0.0, 0.0), Vec3(0, 0, 0)}), Shape::point);
  EXPECT_EQ(shape({Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(kTiny, 0, 0)}), Shape::segment);
  EXPECT_EQ(shape({Vec3(1, 1, 1), Vec3(3, 3, 3), Vec3(2, 2, 2)}), Shape::segment);
  EXPECT_EQ(shape({Vec3(1, 1, 1), Vec3(3, 3, 3), Vec3(2, 2, up(2))}), Shape::triangle);
}

TEST(Shape, IsExactWhereProductsUnderflowOrOverflow) {
  EXPECT_EQ(shape({Vec3(0, 0, 0), Vec3(kTiny, 0, 0), Vec3(0, kTiny, 0)}), Shape::triangle);
  EXPECT_EQ(shape({Vec3(0, 0, 0), Vec3(kTiny, kTiny, 0), Vec3(3 * kTiny, 3 * kTiny, 0)}),
            Shape::segment);
  EXPECT_EQ(shape({Vec3(-kMax, -kMax, -kMax), Vec3(0, 0, 0), Vec3(kMax, kMax, kMax)}),
            Shape::segment);
  EXPECT_EQ(shape({Vec3(-kMax, -kMax, -kMax), Vec3(0, 0, kTiny), Vec3(kMax, kMax, kMax)}),
            Shape::triangle);
  EXPECT_EQ(shape({Vec3(1e300, 0, 0), Vec3(0, 1e300, 0), Vec3(0, 0, 1e-300)}), Shape::triangle);
}

TEST(Intersects, OneUlpDecides) {
  const auto standing = [](double z) {
    return Triangle{Vec3(1, 1, z), Vec3(1, 1, z + 1), Vec3(2, 1, z + 1)};
  };
  const Triangle plate = {Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 1)};
  expect_intersects(true, plate, standing(down(1)));
  expect_intersects(true, plate, standing(1));
  expect_intersects(false, plate, standing(up(1)));
  // The hypotenuse x + y = 4 against a corner just beyond, on and inside it.
  const auto corner = [](double x) {
    return Triangle{Vec3(x, 2, 0), Vec3(5, 5, 0), Vec3(5, 4, 0)};
  };
  expect_intersects(true, kUnit, corner(down(2)));
  expect_intersects(true, kUnit, corner(2));
  expect_intersects(false, kUnit, corner(up(2)));
}

TEST(Intersects, CoordinatesAtTheEndsOfTheDoubles) {
  for (const double s : {kTiny, 0x1p-1000, 0x1p-340, 0x1p330, 0x1p500, 0x1p1020}) {
    const auto scaled = [s](const Triangle& t) { return Triangle{s * t[0], s * t[1], s * t[2]}; };
    expect_intersects(true, scaled(kUnit), scaled({Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(9, 9, 1)}));
    expect_intersects(false, scaled(kUnit), scaled({Vec3(3, 3, -1), Vec3(3, 3, 1), Vec3(9, 9, 1)}));
    expect_intersects(true, scaled(kUnit), scaled(segment({2, 2, -1}, {2, 2, 1})));
    expect_intersects(false, scaled(kUnit), scaled(segment({2, 3, -1}, {2, 3, 1})));
    expect_intersects(true, scaled(segment({0, 0, 0}, {4, 4, 4})),
                      scaled(segment({0, 4, 0}, {4, 0, 4})));
  }
  // Huge and subnormal in one pair: a plate of 1e300 with a needle's tip on it, then just above it.
  const Triangle plate = {Vec3(-1e300, -1e300, 0), Vec3(1e300, -1e300, -0.0), Vec3(0, 1e300, 0)};
  expect_intersects(true, plate, {Vec3(0, 0, -0.0), Vec3(0, 1, 1e300), Vec3(1, 0, 1e300)});
  expect_intersects(false, plate, {Vec3(0, 0, kTiny), Vec3(0, 1, 1e300), Vec3(1, 0, 1e300)});
  const Triangle all = {Vec3(-kMax, -kMax, -kMax), Vec3(kMax, kMax, kMax), Vec3(kMax, -kMax, 0)};
  expect_intersects(true, all, single_point({0, 0, 0}));
  expect_intersects(false, all, single_point({0, kTiny, 0}));
}

/// All triangles with corners in the list, each set of corners once.
std::vector<Triangle> all_triangles(const std::vector<Vec3>& corners) {
  std::vector<Triangle> result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = i; j < corners.size(); ++j)
      for (std::size_t k = j; k < corners.size(); ++k)
        result.push_back({corners[i], corners[j], corners[k]});
  }
  return result;
}

void expect_all_pairs_as_reference(const std::vector<Vec3>& corners) {
  std::mt19937 random(20240601);  // varies the order of corners, on which CGAL's cases depend
  const std::vector<Triangle> triangles = all_triangles(corners);
  for (const Triangle& s : triangles) {
    for (const Triangle& t : triangles) {
      const Triangle a = reordered(s, kPermutations[random() % 6]);
      const Triangle b = reordered(t, kPermutations[random() % 6]);
      ASSERT_EQ(intersects(a, b), reference::intersects(a, b)) << text(a, b);
    }
  }
}

TEST(Intersects, EveryPairOnAPlanarGridUprightAndOblique) {
  for (int plane = 0; plane < 4; ++plane) {
    std::vector<Vec3> corners;
    for (double x = 0; x < 3; ++x) {
      for (double y = 0; y < 3; ++y) {
        corners.push_back(plane == 0   ? Vec3(x, y, 1)
                          : plane == 1 ? Vec3(1, x, y)
                          : plane == 2 ? Vec3(y, 1, x)
                                       : Vec3(x, y, 2 * x - y));
      }
    }
    expect_all_pairs_as_reference(corners);
  }
}

TEST(Intersects, EveryPairOnTheCornersAndCentreOfACube) {
  std::vector<Vec3> corners = {{1, 1, 1}};
  for (int i = 0; i < 8; ++i) corners.push_back(2 * Vec3(i & 1, i >> 1 & 1, i >> 2));
  expect_all_pairs_as_reference(corners);
}

TEST(Intersects, RandomPairsOnSmallGrids) {
  std::mt19937_64 random(test_seed(7));
  std::array<int, 2> answers = {0, 0};
  for (int n = 0; more_cases(n, 300'000, std::ranges::min(answers) > 25'000); ++n) {
    const int size = 2 + n % 5;
    std::array<Triangle, 2> pair;
    for (Triangle& t : pair)
      for (Vec3& p : t) p = Vec3(random() % size, random() % size, random() % size);
    const bool expected = reference::intersects(pair[0], pair[1]);
    ASSERT_EQ(intersects(pair[0], pair[1]), expected) << text(pair[0], pair[1]);
    ++answers[expected];
  }
}

// Any finite double is as likely as any other, so coordinates of one pair differ by hundreds of
// orders of magnitude; corners put on an edge or at a rounded mean of the other's make about half
// of the pairs meet.
TEST(Intersects, RandomPairsOfArbitraryBits) {
  std::mt19937_64 random(test_seed(13));
  std::array<int, 2> answers = {0, 0};
  for (int n = 0; more_cases(n, 2'000, std::ranges::min(answers) > 250); ++n) {
    std::array<Triangle, 2> pair;
    for (Triangle& t : pair) {
      for (Vec3& p : t) {
        for (int axis = 0; axis < 3; ++axis) do {
            p[axis] = std::bit_cast<double>(random());
          } while (!std::isfinite(p[axis]));
      }
    }
    auto& [a, b] = pair;
    if (n % 3 == 0) b[0] = a[1];
    if (n % 4 == 0) b[1] = a[0] / 2 + a[2] / 2;
    if (n % 5 == 0) b[2] = b[1];
    if (n % 7 == 0) b[0] = a[0] / 4 + a[1] / 4 + a[2] / 2;
    const bool expected = reference::intersects(a, b);
    ASSERT_EQ(intersects(a, b), expected) << text(a, b);
    ++answers[expected];
  }
}

/// Tenths (which are rounded) and their neighbours: planes and lines missed by an ulp.
rc::Gen<double> nearly_grid_coordinate() {
  return rc::gen::map(rc::gen::pair(rc::gen::inRange(-4, 5), rc::gen::inRange(-1, 2)),
                      [](const std::pair<int, int>& x) {
                        const double tenth = x.first * 0.1;
                        return x.second == 0 ? tenth : x.second < 0 ? down(tenth) : up(tenth);
                      });
}

Triangle generated(const rc::Gen<double>& coordinate) {
  Triangle t;
  for (Vec3& p : t)
    for (int axis = 0; axis < 3; ++axis) p[axis] = *coordinate;
  return t;
}

void check_pair_and_its_symmetries(const Triangle& a, const Triangle& b) {
  const bool expected = reference::intersects(a, b);
  const auto axes = *rc::gen::elementOf(kPermutations);
  const auto i = *rc::gen::elementOf(kPermutations);
  const auto j = *rc::gen::elementOf(kPermutations);
  RC_ASSERT(intersects(a, b) == expected);
  RC_ASSERT(intersects(b, a) == expected);
  RC_ASSERT(intersects(with_axes(reordered(a, i), axes), with_axes(reordered(b, j), axes)) ==
            expected);
}

void check_many_pairs(const rc::Gen<double>& coordinate) {
  for (int n = 0; n < 20; ++n) {
    const Triangle a = generated(coordinate);
    Triangle b = generated(coordinate);
    if (*rc::gen::arbitrary<bool>()) b[0] = a[1];                 // touch at a corner
    if (*rc::gen::arbitrary<bool>()) b[2] = b[1];                 // a segment
    if (*rc::gen::arbitrary<bool>()) b[1] = a[0] / 2 + a[2] / 2;  // on (or an ulp off) an edge
    check_pair_and_its_symmetries(a, b);
  }
}

RC_GTEST_PROP(IntersectsProperty, AsTheReferenceAnUlpOffTheGrid, ()) {
  check_many_pairs(nearly_grid_coordinate());
}

TEST(Exact, CountsDegenerateTriangles) {
  EXPECT_EQ(degenerate_triangles(Scene{}), 0u);
  const Scene scene = reference::scene_of(
      {{kUnit, single_point({1, 1, 1})}, {}, {segment({0, 0, 0}, {1, 0, 0}), kUnit}});
  EXPECT_EQ(degenerate_triangles(scene), 2u);
}

TEST(Exact, RefusesCandidatesOutOfRange) {
  const Scene scene = reference::scene_of({{kUnit}, {kUnit}});
  EXPECT_THROW(decide(scene, std::vector<TrianglePair>{{0, 2}}), std::logic_error);
  EXPECT_THROW(decide(Scene{}, std::vector<TrianglePair>{{0, 1}}), std::logic_error);
  EXPECT_TRUE(decide(scene, {}).pairs.empty());
}

/// Objects of small triangles on a coarse grid: boxes are flat, points, touching and equal again
/// and again.
std::vector<std::vector<Triangle>> grid_objects(const std::vector<int>& sizes, int extent, int size,
                                                unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::vector<Triangle>> objects;
  for (const int count : sizes) {
    auto& triangles = objects.emplace_back(count);
    for (Triangle& t : triangles) {
      const Vec3 corner(random() % extent, random() % extent, random() % extent);
      for (Vec3& p : t) p = corner + Vec3(random() % size, random() % size, random() % size);
    }
  }
  return objects;
}

void expect_join_as_brute_force(const Scene& scene) {
  std::uint64_t box_pairs = 0;
  std::vector<TrianglePair> expected;
  reference::for_each_pair(scene, [&](const TrianglePair& pair, bool overlapping) {
    if (!overlapping) return;
    ++box_pairs;
    if (reference::intersects(scene.corners(pair.a), scene.corners(pair.b)))
      expected.push_back(pair);
  });
  const ExactResult result = all_colliding_pairs(scene);
  EXPECT_EQ(result.box_pairs, box_pairs);
  EXPECT_EQ(result.pairs, expected);
}

// Overlapping pairs are decided in portions of 2^18.
TEST(BoxJoin, KeepsEveryPortion) {
  const Scene scene = reference::scene_of(
      {std::vector<Triangle>(700, kUnit), {}, std::vector<Triangle>(700, kUnit)});
  const ExactResult result = all_colliding_pairs(scene);
  EXPECT_EQ(result.box_pairs, 490'000u);
  ASSERT_EQ(result.pairs.size(), 490'000u);
  std::size_t i = 0;
  reference::for_each_pair(
      scene, [&](const TrianglePair& pair, bool) { ASSERT_EQ(result.pairs[i++], pair); });
  EXPECT_GE(result.join_ms, 0);
  EXPECT_GT(result.predicates_ms, 0);
}

// Beyond the cutoff the join divides space; with every coordinate repeated hundreds of times it
// divides at equal values.
TEST(BoxJoin, AsBruteForceBeyondTheCutoff) {
  expect_join_as_brute_force(reference::scene_of(grid_objects({6000, 5000}, 40, 3, 3)));
  expect_join_as_brute_force(reference::scene_of(grid_objects({3000, 0, 4000, 2500}, 40, 2, 4)));
  auto flat = grid_objects({5000, 5000}, 400, 3, 5);
  for (auto& triangles : flat) {
    for (Triangle& t : triangles)
      for (Vec3& p : t) p.z() = 1;
  }
  expect_join_as_brute_force(reference::scene_of(flat));
}

// ---- The first colliding candidates: always a prefix of all of them, and no more is decided than
// that takes.

/// An object of triangles between points of a grid, against itself, and all its pairs.
struct Tangle {
  Scene scene;
  std::vector<TrianglePair> pairs;
};
Tangle tangle(std::uint32_t triangles) {
  rational::Random random(641);
  Tangle out;
  for (int i = 0; i < 125; ++i) out.scene.vertices.emplace_back(i % 5, i / 5 % 5, i / 25);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) corner = random.below(125u);
    out.scene.triangles.push_back(corners);
    out.scene.source_face.push_back(t);
    for (std::uint32_t a = 0; a < t; ++a) out.pairs.push_back({a, t});
  }
  out.scene.objects.push_back({"", 0, triangles, true});
  std::ranges::sort(out.pairs);
  return out;
}

TEST(DecideFirst, GivesAPrefixOfAllThatCollide) {
  const Tangle all = tangle(120);
  const std::vector<TrianglePair> expected = decide(all.scene, all.pairs).all();
  ASSERT_GT(expected.size(), 500u);
  for (const unsigned threads : {1u, 2u}) {
    for (const std::uint64_t limit : {std::uint64_t{1}, std::uint64_t{100}, expected.size() - 1,
                                      expected.size(), expected.size() + 1}) {
      const FirstCollisions first = decide_first(all.scene, all.pairs, limit, {.threads = threads});
      const std::vector<TrianglePair> found = first.collisions.all();
      const auto end = expected.begin() + static_cast<long>(std::min(limit, expected.size()));
      EXPECT_EQ(found, std::vector<TrianglePair>(expected.begin(), end)) << limit;
      EXPECT_EQ(first.complete, limit >= expected.size() && first.decided == all.pairs.size());
      if (limit == 1) {
        EXPECT_LT(first.decided, all.pairs.size() / 2);
      }
      if (limit > expected.size()) {
        EXPECT_TRUE(first.complete);
      }
      // The twin: what is decided ends at or behind the last pair; a block less does not suffice.
      EXPECT_GE(all.pairs[first.decided - 1], found.back());
    }
  }
}

// Exactly as many pairs collide as the limit allows, and the last of them stands before many
// candidates that do not.
TEST(DecideFirst, NumberOfThreadsDecidesNothing) {
  const Tangle all = tangle(120);
  const std::vector<TrianglePair> meet = decide(all.scene, all.pairs).all();
  const TrianglePair one = meet.front();
  std::vector<TrianglePair> candidates;
  for (const TrianglePair& pair : all.pairs)
    if (pair == one || (one < pair && !std::ranges::binary_search(meet, pair)))
      candidates.push_back(pair);
  ASSERT_GT(candidates.size(), 3000u);
  const FirstCollisions first = decide_first(all.scene, candidates, 1, {.threads = 1});
  EXPECT_EQ(first.collisions.all(), std::vector<TrianglePair>{one});
  EXPECT_FALSE(first.complete);
  for (const unsigned threads : {2u, 3u, 16u}) {
    const FirstCollisions other = decide_first(all.scene, candidates, 1, {.threads = threads});
    EXPECT_EQ(other.decided, first.decided);
    EXPECT_EQ(other.complete, first.complete);
  }
}

TEST(DecideFirst, OfNoCandidatesIsComplete) {
  const Tangle all = tangle(3);
  const FirstCollisions none = decide_first(all.scene, {}, 1);
  EXPECT_TRUE(none.complete);
  EXPECT_EQ(none.decided, 0u);
  EXPECT_THROW(decide_first(all.scene, {}, 0), std::logic_error);
  EXPECT_THROW(decide_first(all.scene, std::vector<TrianglePair>{{0, 3}}, 1), std::logic_error);
}

TEST(KeepFirst, CutsTheLastOfBothLists) {
  Collisions some;
  some.pairs = {{0, 1}, {0, 5}, {2, 3}};
  some.neighbour_pairs = {{0, 2}, {2, 4}};
  EXPECT_FALSE(keep_first(5, some));
  EXPECT_TRUE(keep_first(3, some));
  EXPECT_EQ(some.pairs, (std::vector<TrianglePair>{{0, 1}, {0, 5}}));
  EXPECT_EQ(some.neighbour_pairs, (std::vector<TrianglePair>{{0, 2}}));
  EXPECT_TRUE(keep_first(1, some));
  EXPECT_EQ(some.pairs, (std::vector<TrianglePair>{{0, 1}}));
  EXPECT_TRUE(some.neighbour_pairs.empty());
}

}  // namespace
}  // namespace farcull
