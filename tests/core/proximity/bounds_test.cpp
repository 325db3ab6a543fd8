// The bounds that the search for near pairs rests on, against exact arithmetic. Each has a twin
// without its slack, which must fail.
#include "core/proximity/scene_trees.h"

#include "tests/lab/grid_distance.h"
#include "tests/lab/rational.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using rational::Q;
using rational::Random;

double moved_by_ulps(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, HUGE_VAL);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, 0);
  return x;
}

// Boxes with a gap along one axis or more; limits about as long as the gap.
TEST(NearBounds, BoxesBeyondTheSquareLimitAreFartherApart) {
  Random random(1);
  int beyond = 0, wrong = 0, twin_wrong = 0, within = 0;
  const auto seen = [&] { return twin_wrong > 20 && beyond > 200 && within > 200; };
  for (int k = 0; more_cases(k, trials(200'000), seen()); ++k) {
    const int axes = 1 + random.below(3);
    double square = 0;
    Q exact = 0;
    const double size = std::exp2(random.uniform(-30, 0));
    for (int axis = 0; axis < axes; ++axis) {
      const double hi = random.uniform(-1, 1) * size, lo = random.uniform(1, 2) * size;
      const double g = lo - hi;
      square += g * g;
      exact += (Q(lo) - Q(hi)) * (Q(lo) - Q(hi));
    }
    const double limit = moved_by_ulps(std::sqrt(square), random.below(20) - 14);
    const bool is_beyond = exact > Q(limit) * Q(limit);
    beyond += square > near::square_limit(limit);
    within += !is_beyond;
    wrong += square > near::square_limit(limit) && !is_beyond;
    twin_wrong += square > limit * limit && !is_beyond;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LT(near::square_limit(HUGE_VAL), HUGE_VAL);
  EXPECT_GT(near::square_limit(HUGE_VAL), 3 * 8.0 * 8.0);
  EXPECT_GT(near::square_limit(0), 0);
}

// Two points, relative to an origin; the gap along a direction of about the limit's length.
TEST(NearBounds, PointsBeyondTheGapLimitAreFartherApartAlongTheDirection) {
  Random random(2);
  int beyond = 0, wrong = 0, twin_wrong = 0;
  for (int k = 0; more_cases(k, trials(200'000), twin_wrong > 20 && beyond > 200); ++k) {
    const Vec3 origin = random.cube(4), p = origin + random.cube(1e-3), q = random.cube(4);
    const Vec3 d = random.scaled3(-20, 2);
    const Vec3 x = p - origin, y = q - origin;
    const double gap =
        (d[0] * y[0] + d[1] * y[1] + d[2] * y[2]) - (d[0] * x[0] + d[1] * x[1] + d[2] * x[2]);
    if (!(gap > 0)) continue;
    const double doubt = near::kGap * d.cwiseAbs().dot(x.cwiseAbs().cwiseMax(y.cwiseAbs()));
    const double limit = (gap - doubt * random.uniform(-0.5, 1.5)) / d.norm();
    if (!(limit > 0)) continue;
    Q exact = 0, squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      exact += Q(d[axis]) * (Q(q[axis]) - Q(p[axis]));
      squared += Q(d[axis]) * Q(d[axis]);
    }
    const bool is_beyond = exact > 0 && exact * exact > Q(limit) * Q(limit) * squared;
    const bool says = gap > near::gap_limit(limit, d.squaredNorm(), doubt);
    beyond += says;
    wrong += says && !is_beyond;
    twin_wrong += gap > limit * d.norm() && !is_beyond;
  }
  EXPECT_EQ(wrong, 0);
}

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
  switch (random.below(6)) {
    case 0:  // a needle
      a[2] = a[1] + random.cube(size * 0x1p-25);
      break;
    case 1:  // a corner a little beside a corner, or at it
      b[0] = a[0] + random.cube(1) * std::exp2(random.uniform(-60, -20));
      break;
    case 2:  // a corner a little beside the face, or on it
      b[0] = (a[0] + a[1] + a[2]) / 3 + random.cube(1) * std::exp2(random.uniform(-60, -20));
      break;
    case 3:  // nearly parallel
      for (int k = 0; k < 3; ++k) b[k] = a[k] + Vec3(0, 0, size) + random.cube(0x1p-40);
      break;
    case 4:  // an edge beside an edge
      b[0] = 0.5 * (a[0] + a[1]) + random.cube(size * 0x1p-30);
      b[1] = 2 * b[0] - a[2] + random.cube(size * 0x1p-30);
      break;
    default:
      break;
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
    memory.forget();
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
