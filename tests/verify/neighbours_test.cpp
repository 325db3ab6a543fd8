// Neighbours: what they share as neighbours is no collision, whatever is more is one. Every case
// against rational arithmetic that shares no code with verify/.
#include <rapidcheck/gtest.h>

#include "tests/lab/drawn_pairs.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using reference::kPermutations, reference::reordered, reference::Triangle;

/// In all orders of corners and triangles, and alone in a scene, where the filter decides first.
void expect_beyond(bool expected, const Triangle& a, const Triangle& b) {
  EXPECT_EQ(reference::intersects_beyond_shared(a, b), expected);
  for (const auto& i : kPermutations) {
    for (const auto& j : kPermutations) {
      const Triangle s = reordered(a, i);
      const Triangle t = reordered(b, j);
      EXPECT_EQ(intersects_beyond_shared(s, t), expected);
      EXPECT_EQ(intersects_beyond_shared(t, s), expected);
      for (const bool indexed : {false, true}) {
        const Scene scene = reference::welded(reference::scene_of({{s, t}}), indexed);
        const Collisions c = decide(scene, std::vector<TrianglePair>{{0, 1}});
        EXPECT_EQ(c.neighbours, 1u);
        EXPECT_EQ(c.neighbour_pairs.size(), expected ? 1u : 0u);
        EXPECT_TRUE(c.pairs.empty());
      }
    }
  }
}

const Vec3 kO(0, 0, 0), kX(4, 0, 0), kY(0, 4, 0);
const Triangle kUnit = {kO, kX, kY};

TEST(Neighbours, OfOneSharedVertex) {
  expect_beyond(false, kUnit, {kO, Vec3(-1, 0, 1), Vec3(0, -1, 1)});     // off to the other side
  expect_beyond(false, kUnit, {kO, Vec3(1, 1, 1), Vec3(1, 2, 2)});       // above
  expect_beyond(true, kUnit, {kO, Vec3(1, 1, 1), Vec3(1, 1, -1)});       // through the face
  expect_beyond(false, kUnit, {kO, Vec3(-1, -1, 1), Vec3(-1, -1, -1)});  // behind the vertex
  expect_beyond(true, kUnit, {kO, Vec3(1, 1, 0), Vec3(1, 1, 1)});        // a corner on the face
  expect_beyond(true, kUnit, {kO, Vec3(9, 9, 0), Vec3(1, 1, 1)});        // an edge along the face
  expect_beyond(true, kUnit, {kO, Vec3(1, 0, 0), Vec3(1, -1, 1)});       // a corner on an edge
  expect_beyond(true, kUnit, {kX, Vec3(0, 2, 1), Vec3(0, 2, -1)});       // through the far edge
  expect_beyond(false, kUnit, {kX, Vec3(0, 5, 1), Vec3(0, 5, -1)});      // past it
  // In one plane.
  expect_beyond(false, kUnit, {kO, Vec3(-4, 0, 0), Vec3(0, -4, 0)});
  expect_beyond(true, kUnit, {kO, Vec3(1, -1, 0), Vec3(1, 1, 0)});
  expect_beyond(true, kUnit, {kO, Vec3(2, 0, 0), Vec3(2, -1, 0)});   // along an edge
  expect_beyond(true, kUnit, {kO, Vec3(2, -1, 0), Vec3(-1, 2, 0)});  // around it
}

TEST(Neighbours, NegativeZeroIsZero) {
  expect_beyond(false, kUnit, {Vec3(-0.0, 0.0, -0.0), Vec3(-1, 0, 1), Vec3(0, -1, 1)});
}

TEST(Neighbours, AtTheEndsOfTheDoubles) {
  for (const double s : {0x1p-1072, 0x1p-500, 0x1p330, 0x1p1019}) {
    const auto at = [s](double x, double y, double z) { return Vec3(s * x, s * y, s * z); };
    const Triangle unit = {at(0, 0, 0), at(4, 0, 0), at(0, 4, 0)};
    expect_beyond(true, unit, {at(0, 0, 0), at(1, 1, 1), at(1, 1, -1)});
    expect_beyond(false, unit, {at(0, 0, 0), at(-1, -1, 1), at(-1, -1, -1)});
    expect_beyond(true, unit, {at(0, 0, 0), at(4, 0, 0), at(1, 1, 0)});
    expect_beyond(false, unit, {at(0, 0, 0), at(4, 0, 0), at(1, 1, 1)});
  }
}

/// Corners from a few points, so that every way of sharing and every degeneracy is common.
void expect_as_reference(const std::vector<Vec3>& points, int pairs, unsigned seed) {
  std::mt19937 random(seed);
  std::array<int, 2> answers = {0, 0};
  for (int n = 0; n < pairs; ++n) {
    Triangle a, b;
    for (Triangle* t : {&a, &b})
      for (Vec3& p : *t) p = points[random() % points.size()];
    b[random() % 3] = a[random() % 3];
    const bool expected = reference::intersects_beyond_shared(a, b);
    ASSERT_EQ(intersects_beyond_shared(a, b), expected) << n;
    const Scene scene = reference::welded(reference::scene_of({{a, b}}), n % 2 == 0);
    const Collisions c = decide(scene, std::vector<TrianglePair>{{0, 1}});
    ASSERT_EQ(c.neighbour_pairs.size(), expected ? 1u : 0u) << n;
    ++answers[expected];
  }
  EXPECT_GT(answers[0], pairs / 20);
  EXPECT_GT(answers[1], pairs / 20);
}

TEST(Neighbours, AsTheReferenceOnGrids) {
  std::vector<Vec3> line, plane, cube;
  for (int x = 0; x < 6; ++x) line.push_back(Vec3(x, 2 * x, 3 * x));
  for (int i = 0; i < 16; ++i) plane.push_back(Vec3(i % 4, i / 4, i % 4 + 2 * (i / 4)));
  for (int i = 0; i < 27; ++i) cube.push_back(Vec3(i % 3, i / 3 % 3, i / 9));
  expect_as_reference(line, 1000, 1);
  expect_as_reference(plane, 3000, 2);
  expect_as_reference(cube, 5000, 3);
}

TEST(Neighbours, AsTheReferenceOnHardPairs) {
  for (const PairGenerator& generator : pair_generators()) {
    RandomDraws random(5);
    for (int n = 0; n < 200; ++n) {
      auto [a, b] = generator.make(random);
      b[random.below(3)] = a[random.below(3)];
      if (n % 2 == 0) b[random.below(3)] = a[random.below(3)];
      ASSERT_EQ(intersects_beyond_shared(a, b), reference::intersects_beyond_shared(a, b))
          << generator.name << " " << n;
    }
  }
}

// The rule without the exception for degenerate triangles, which the design page warns of: wrong.
TEST(NeighboursTwin, TheOppositeEdgeAloneMisjudgesDegenerateTriangles) {
  const auto by_opposite_edge = [](const Triangle& a, const Triangle& b) {  // sharing a[0] = b[0]
    return intersects(a, {b[1], b[1], b[2]}) || intersects(b, {a[1], a[1], a[2]});
  };
  const Triangle pierced = {kO, Vec3(1, 1, 1), Vec3(1, 1, -1)};
  EXPECT_TRUE(by_opposite_edge(kUnit, pierced));
  const Triangle through = {kO, Vec3(1, 1, 1), Vec3(-1, -1, -1)};
  EXPECT_TRUE(by_opposite_edge(kUnit, through));
  EXPECT_FALSE(intersects_beyond_shared(kUnit, through));
}

TEST(Neighbours, ExistOnlyInOneObjectAndAreSkippedOnRequest) {
  const Triangle other = {kO, Vec3(1, 1, 1), Vec3(1, 1, -1)};
  const std::vector<TrianglePair> pair = {{0, 1}};
  const Collisions two = decide(reference::scene_of({{kUnit}, {other}}), pair);
  EXPECT_EQ(two.pairs, pair);
  EXPECT_EQ(two.neighbours, 0u);
  const Scene scene = reference::scene_of({{kUnit, other}});
  EXPECT_EQ(decide(scene, pair).neighbour_pairs, pair);
  const Collisions skipped = decide(scene, pair, {.neighbours = false});
  EXPECT_EQ(skipped.neighbours, 1u);
  EXPECT_TRUE(skipped.neighbour_pairs.empty());
  EXPECT_TRUE(skipped.pairs.empty());
}

// Two fans about one vertex, which both objects name by the same index. Pairs of one fan are
// neighbours. Pairs of both are none, also where so many neighbours came before that they are set
// aside first.
TEST(Neighbours, SharedIndicesOfTwoObjectsMakeNone) {
  constexpr std::uint32_t kFan = 60;
  Scene scene;
  scene.vertices.push_back(kO);
  for (std::uint32_t k = 0; k < 2 * kFan; ++k) {
    const auto v = static_cast<std::uint32_t>(scene.vertices.size());
    const double side = k < kFan ? 1 : -1, turn = 2 * k;
    scene.vertices.emplace_back(std::cos(turn), std::sin(turn), side);
    scene.vertices.emplace_back(std::cos(turn + 1), std::sin(turn + 1), side);
    scene.triangles.push_back({0, v, v + 1});
    scene.source_face.push_back(k);
  }
  scene.objects = {{"above", 0, kFan, true}, {"below", kFan, kFan, false}};
  std::vector<TrianglePair> candidates, of_both;
  for (std::uint32_t a = 0; a < kFan; ++a)
    for (std::uint32_t b = a + 1; b < kFan; ++b) candidates.push_back({a, b});
  const std::size_t neighbours = candidates.size();
  ASSERT_GT(neighbours, 1024u) << "a block of decide()";
  for (std::uint32_t a = 0; a < kFan; ++a)
    for (std::uint32_t b = kFan; b < 2 * kFan; ++b) of_both.push_back({a, b});
  candidates.insert(candidates.end(), of_both.begin(), of_both.end());
  for (const bool asked : {false, true}) {
    const Collisions found = decide(scene, candidates, {.threads = 1, .neighbours = asked});
    EXPECT_EQ(found.pairs, of_both);
    EXPECT_EQ(found.neighbours, neighbours);
  }
}

TEST(Neighbours, DecideRefusesATriangleWithItselfAndBadClearances) {
  const Scene scene = reference::scene_of({{kUnit}, {kUnit}});
  EXPECT_THROW(decide(scene, std::vector<TrianglePair>{{1, 1}}), std::logic_error);
  EXPECT_THROW(decide(scene, {}, {.clearance = -1}), std::logic_error);
  EXPECT_THROW(decide(scene, {}, {.clearance = std::nan("")}), std::logic_error);
}

RC_GTEST_PROP(AllCollidingPairsProperty, AsBruteForceWithSelfAndClearance, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  const int extent = *rc::gen::inRange(1, 8);
  Scene scene = reference::grid_scene(random, 1 + random() % 5, extent, 3);
  for (Object& object : scene.objects) object.self = random() % 2 == 0;
  const double clearance = *rc::gen::element(0.0, 0.0, 0.5, 1.0, 1.7320508075688772, 1e-300);
  ExactResult expected;
  reference::for_each_pair(
      scene,
      [&](const TrianglePair& pair, bool overlapping) {
        expected.box_pairs += overlapping;
        const bool neighbours = reference::neighbours(scene, pair);
        expected.neighbours += neighbours;
        if (!reference::collides(scene, pair, clearance)) return;
        (neighbours ? expected.neighbour_pairs : expected.pairs).push_back(pair);
      },
      clearance);
  for (const unsigned threads : {1u, 3u}) {
    const ExactResult found =
        all_colliding_pairs(scene, {.clearance = clearance, .threads = threads});
    RC_ASSERT(found.pairs == expected.pairs);
    RC_ASSERT(found.neighbour_pairs == expected.neighbour_pairs);
    RC_ASSERT(found.neighbours == expected.neighbours);
    RC_ASSERT(found.box_pairs == expected.box_pairs);
  }
}

}  // namespace
}  // namespace farcull
