// The bounds that the search for near pairs rests on, against exact arithmetic. Each has a twin
// without its slack, which must fail.
#include "core/proximity/scene_trees.h"

#include "tests/lab/grid_distance.h"
#include "tests/lab/rational.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using rational::Q, rational::Random;

using Triangle = std::array<Vec3, 3>;

// Two triangles of very different shapes and places, some nearly touching, some with parts in
// common.
std::array<Triangle, 2> random_pair(Random& random) {
  Triangle a, b;
  const double size = std::exp2(random.uniform(-20, 0)), other = std::exp2(random.uniform(-20, 0));
  const Vec3 place = random.cube(2);
  for (int k = 0; k < 3; ++k) {
    a[k] = place + random.cube(size);
    b[k] = place + random.cube(other) + Vec3(random.below(2) * 0.5, 0, 0);
  }
  const int kind = random.below(6);
  if (kind == 0) a[2] = a[1] + random.cube(size * 0x1p-25);  // a needle
  if (kind == 1)  // a corner a little beside a corner, or at it
    b[0] = a[0] + random.cube(1) * std::exp2(random.uniform(-60, -20));
  if (kind == 2)  // a corner a little beside the face, or on it
    b[0] = (a[0] + a[1] + a[2]) / 3 + random.cube(1) * std::exp2(random.uniform(-60, -20));
  if (kind == 3)  // nearly parallel
    for (int k = 0; k < 3; ++k) b[k] = a[k] + Vec3(0, 0, size) + random.cube(0x1p-40);
  if (kind == 4) {  // an edge beside an edge
    b[0] = 0.5 * (a[0] + a[1]) + random.cube(size * 0x1p-30);
    b[1] = 2 * b[0] - a[2] + random.cube(size * 0x1p-30);
  }
  return {a, b};
}

near_lab::Corners<Q> exact_corners(const Triangle& t) {
  return {rational::exact(t[0]), rational::exact(t[1]), rational::exact(t[2])};
}

Scene scene_of(const std::array<Triangle, 2>& pair) {
  return reference::scene_of({{pair[0]}, {pair[1]}});
}

TEST(NearBounds, EncloseTheDistanceOfTwoTriangles) {
  Random random(3);
  SearchMemory memory;
  int wrong = 0, tight = 0, upper_twin = 0, lower_twin = 0;
  int pairs = 0;
  for (; more_cases(pairs, trials(4000), upper_twin > 10 && lower_twin > 10); ++pairs) {
    const std::array<Triangle, 2> pair = random_pair(random);
    const Scene scene = scene_of(pair);
    const SceneTrees trees(scene, 1);
    memory = SearchMemory();
    Search search = begin_search(trees, {0, 1}, HUGE_VAL, nullptr, memory);
    go_on(trees, 100, search, memory);
    ASSERT_EQ(search.kept.size(), 1u);
    const KeptPair& kept = search.kept.front();
    EXPECT_EQ(kept.upper, search.upper);
    const auto [numerator, denominator] =
        near_lab::squared_distance(exact_corners(pair[0]), exact_corners(pair[1]));
    const Q squared = numerator / denominator;
    const auto at_most = [&](double x) {  // is the distance at most x, in scaled units?
      const Q world = Q(x) / Q(trees.scale());
      return x >= 0 && squared <= world * world;
    };
    const auto at_least = [&](double x) {
      const Q world = Q(x) / Q(trees.scale());
      return x <= 0 || world * world <= squared;
    };
    wrong += !at_most(kept.upper) || !at_least(kept.lower);
    double most = 0;
    for (const Triangle& t : pair)
      for (const Vec3& p : t) most = std::max(most, (p - pair[0][0]).cwiseAbs().maxCoeff());
    most *= trees.scale();
    tight += kept.upper - kept.lower < 200 * near::kUnit * most;
    upper_twin += !at_most(kept.upper - near::kPoint * most);
    lower_twin += !at_least(kept.lower + near::kGap * most);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(tight, pairs / 2);
  std::cout << tight << " of " << pairs << " tight; without slack " << upper_twin << " and "
            << lower_twin << " are wrong\n";
}

}  // namespace
}  // namespace farcull
