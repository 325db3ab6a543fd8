// The nearest of many pairs, against all of them one by one; and the bounds that leave pairs out.
#include "tests/lab/closest.h"
#include "tests/lab/hard_pairs.h"
#include "tests/lab/scenes.h"
#include "verify/filter_scalars.h"

namespace farcull {
namespace {

using reference::Rational, reference::Triangle;

std::vector<TrianglePair> pairs_between(const Scene& scene) {
  std::vector<TrianglePair> pairs;
  reference::for_each_pair(scene, [&](const TrianglePair& pair, bool) { pairs.push_back(pair); });
  return pairs;
}

/// Two objects of triangles that `corner` gives the corners of, the second moved by a vector.
template <class Corner>
Scene two_objects(int count, const Vec3& by, Corner corner) {
  std::vector<std::vector<Triangle>> objects(2);
  for (int n = 0; n < 2 * count; ++n) {
    Triangle t;
    for (Vec3& p : t) p = n < count ? corner() : Vec3(corner() + by);
    objects[n / count].push_back(t);
  }
  return reference::scene_of(objects);
}

TrianglePair first_by_all(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  TrianglePair best = pairs[0];
  SquaredDistance least;
  for (const TrianglePair& pair : pairs) {
    const SquaredDistance d = squared_distance(scene.corners(pair.a), scene.corners(pair.b));
    if (pair == pairs[0] || d < least) {
      least = d;
      best = pair;
    }
  }
  return best;
}

void expect_nearest(const Scene& scene, std::vector<TrianglePair> pairs) {
  for (int order = 0; order < 2; ++order) {
    const auto nearest = nearest_pair(scene, pairs);
    ASSERT_TRUE(nearest.has_value());
    EXPECT_EQ(nearest->pair, first_by_all(scene, pairs));
    const Closest one =
        closest_points(scene.corners(nearest->pair.a), scene.corners(nearest->pair.b));
    EXPECT_EQ(nearest->closest.squared, one.squared);
    EXPECT_EQ(nearest->closest.points, one.points);
    EXPECT_EQ(nearest->closest.features, one.features);
    std::ranges::reverse(pairs);
  }
}

TEST(NearestPair, TheFirstOfThoseThatAreAsNear) {
  RandomDraws random(1);
  for (int n = 0; n < trials(200); ++n) {
    const int most = random.whole(1, 6);
    const double size = std::ldexp(1, random.chance(3) ? random.whole(-1000, 1000) : 0);
    const Vec3 by = size * Vec3(random.whole(0, 8), random.whole(0, 8), random.whole(0, 8));
    const Scene scene = two_objects(random.whole(1, 12), by, [&] {
      Vec3 p;
      for (double& x : p) x = size * random.whole(0, most);
      return p;
    });
    expect_nearest(scene, pairs_between(scene));
  }
}

TEST(NearestPair, OfTrianglesInGeneralPosition) {
  RandomDraws random(2);
  for (int n = 0; n < trials(200); ++n) {
    const Vec3 by = random.whole(0, 4) * hard_pairs::point(random);
    const Scene scene =
        two_objects(random.whole(1, 12), by, [&] { return hard_pairs::point(random); });
    expect_nearest(scene, pairs_between(scene));
  }
}

// Distances that differ by less than doubles show: 1 + 2^-100 k, k random.
TEST(NearestPair, OfDistancesThatDoublesCannotTellApart) {
  RandomDraws random(3);
  const auto point = [](const Vec3& p) { return Triangle{p, p, p}; };
  std::vector<Triangle> others;
  for (int n = 0; n < 500; ++n) others.push_back(point({0x1p-100 * random.whole(1, 300), 1, 0}));
  const Scene scene = reference::scene_of({{point({0, 0, 0})}, others});
  expect_nearest(scene, pairs_between(scene));
}

TEST(NearestPair, ThousandsOfTies) {
  std::vector<Triangle> low, high;
  for (int i = 0; i < 60; ++i) {
    const Vec3 p(i % 8, i / 8, 0);
    low.push_back({p, p + Vec3(1, 0, 0), p + Vec3(0, 1, 0)});
    high.push_back({p + Vec3(0, 0, 1), p + Vec3(1, 0, 1), p + Vec3(0, 1, 1)});
  }
  const Scene scene = reference::scene_of({low, high});
  expect_nearest(scene, pairs_between(scene));
  std::vector<TrianglePair> same(5000, TrianglePair{3, 63});
  same.insert(same.begin(), {0, 119});
  const auto nearest = nearest_pair(scene, same);
  EXPECT_EQ(nearest->pair, same[1]);
  EXPECT_EQ(nearest->closest.distance, 1);
}

// Of a face and a point over it. Both distances are less than half of the least double, so they are
// rounded to 0, and neither is 0.
TEST(NearestPair, OfDistancesThatAreRoundedToZero) {
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), p(1, 2, 1), q(2, 1, 1);
  Scene scene = lab::scene_of({{{4 * x, 4 * y, 2 * z}},  // p is 1 / sqrt(6) over it
                               {{p, p, p}},
                               {{6 * x, 3 * y, 2 * z}},  // q is 1 / sqrt(14) over it
                               {{q, q, q}}});
  for (Vec3& v : scene.vertices) v = v * 0x1p-1074;
  const auto found = nearest_pair(scene, std::vector<TrianglePair>{{0, 1}, {2, 3}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pair, (TrianglePair{2, 3}));
  EXPECT_EQ(found->closest.distance, 0);
  EXPECT_FALSE(found->closest.squared.is_zero());
}

// A product of the test for the same closest points is -infinity here, and its bound is finite.
TEST(NearestPair, WhereProductsOverflow) {
  const double s = 0x1p512, x = 127.0 / 128 * s;
  const Scene scene =
      reference::scene_of({{{Vec3(0, 0, 0), Vec3(0, -s, 0), Vec3(0, 0, -s)},
                            {Vec3(0, 0, 0), Vec3(x, -s, x), Vec3(0, -s, 0)}},
                           {{Vec3(s, s, s), Vec3(0x1p561, s, s), Vec3(s, 2 * s, s)}}});
  expect_nearest(scene, pairs_between(scene));
}

TEST(NearestPair, RefusesWhatTheSceneLacks) {
  const Scene scene = reference::scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}});
  EXPECT_FALSE(nearest_pair(scene, {}).has_value());
  const std::vector<TrianglePair> bad = {{0, 1}};
  EXPECT_THROW(nearest_pair(scene, bad), std::logic_error);
}

struct BoundsTally {
  int wrong = 0;
  int tight = 0;  // of pairs apart
  int apart = 0;
};

// A twin has no least number of pairs, and ends at the first bound that is wrong.
template <class Bounds>
BoundsTally tally(int least = 0) {
  const auto all = hard_pairs::generators();
  RandomDraws random(4);
  BoundsTally out;
  for (std::size_t n = 0; more_cases(n, least, least > 0 || out.wrong > 0, 100'000); ++n) {
    DrawnPair pair = all[n % all.size()].second(random);
    if (!hard_pairs::finite(pair)) continue;
    if (random.chance(2)) {  // apart by their size, more or less
      const Vec3 by = 4 * (pair.a[0] - pair.b[1]);
      for (Vec3& p : pair.b) p -= by;
    }
    if (!hard_pairs::finite(pair)) continue;
    const auto bounds = filters::distance_bounds<Bounds>(pair.a, pair.b);
    const Rational square(squared_distance(pair.a, pair.b).text());
    const Rational lower(bounds.lower);
    const bool held =
        lower * lower <= square &&
        (std::isinf(bounds.upper) || Rational(bounds.upper) * Rational(bounds.upper) >= square);
    out.wrong += !held;
    out.apart += square > 0;
    out.tight += bounds.lower > 0 && bounds.upper < bounds.lower * 1.0001;
  }
  return out;
}

TEST(DistanceBounds, EncloseTheDistance) {
  const BoundsTally t = tally<FilterBounds>(trials(20000, 1000));
  EXPECT_EQ(t.wrong, 0);
  EXPECT_GT(t.tight, t.apart / 2);
}

TEST(DistanceBoundsTwin, WithoutTheirErrorsTheyDoNot) {
  tally<hard_pairs::NoPoint>();
  tally<hard_pairs::NoGap>();
}

}  // namespace
}  // namespace farcull
