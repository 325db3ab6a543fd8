// Inputs that were slow: objects whose triangles lie far apart, and many objects of which few are
// within the distance. The work is counted. Each count has a twin that exceeds it.
#include "experiments/method/distances.h"

#include "tests/experiments/method/distance_truth.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using CliffTriangle = reference::Triangle;

// Objects of two small triangles in opposite corners of the scene; joined: and one from the one to
// the other corner, so that no box is small.
Scene far_triangles(int count, bool joined) {
  rational::Draws random(41);
  std::vector<std::vector<CliffTriangle>> objects;
  for (int k = 0; k < count; ++k) {
    std::vector<CliffTriangle> object;
    for (const double corner : {0.0, 1e5}) {
      const auto along = [&] { return corner + random.below(1000); };
      const Vec3 p(along(), along(), along());
      object.push_back({p, p + Vec3(0.1, 0, 0), p + Vec3(0, 0.1, 0)});
    }
    if (joined) object.push_back({object[0][0], object[1][0], object[0][0]});
    objects.push_back(object);
  }
  return reference::scene_of(objects);
}

std::uint64_t pairs_for_nearest(const Scene& scene) {
  return distances(scene, {.pairs = DistancePairs::nearest}).counts.triangle_pairs;
}

TEST(DistanceCliffs, NearestOfObjectsWithDistantTrianglesTakesFewSearches) {
  EXPECT_LT(pairs_for_nearest(far_triangles(200, false)), 8u * 200u);
}
TEST(DistanceCliffsTwin, ObjectsOfOnePartAreAllCompared) {
  EXPECT_GT(pairs_for_nearest(far_triangles(200, true)), 8u * 200u);
}

// Slivers beside each other along the diagonal of one box, in any order. The box of each is nearly
// the whole. Each sliver is an object, with `copies` copies of it.
Scene slivers(int count, int copies) {
  std::vector<std::vector<CliffTriangle>> objects;
  for (int k = 0; k < count; ++k) {
    const int at = 37 * k % count;
    const Vec3 p(at, -at, 0), q = p + Vec3(1e5, 1e5, 1e5);
    objects.emplace_back(copies, CliffTriangle{p, q, q + Vec3(0.25, 0, 0)});
  }
  return reference::scene_of(objects);
}

TEST(DistanceCliffs, NearestOfSmallObjectsThatOverlapTakesFewPairs) {
  EXPECT_LT(pairs_for_nearest(slivers(200, 1)), 200u * 60u);
}
// Two cones tip to tip, of which each triangle is as near to all of the other one, and far from
// them small triangles that overlap. The cones do not ask about all triangles of the scene at once:
// their ties would be that many pairs.
TEST(DistanceCliffs, NearestOfLargeObjectsAmongSmallOnesTakesFewPairs) {
  constexpr int kSides = 200, kSmall = 60;
  std::vector<std::vector<CliffTriangle>> objects(2);
  for (int cone = 0; cone < 2; ++cone) {
    const Vec3 tip(0, 0, cone);
    const auto rim = [&](int i) {
      const double turn = 2 * std::numbers::pi * (i % kSides) / kSides;
      return Vec3(std::cos(turn), std::sin(turn), 3 * cone - 1);
    };
    for (int i = 0; i < kSides; ++i) objects[cone].push_back({tip, rim(i), rim(i + 1)});
  }
  for (int k = 0; k < kSmall; ++k) {
    const Vec3 p(100, 0, k);
    objects.push_back({{p, p + Vec3(9, 9 + k, 9), p + Vec3(0, 9, 99)}});
  }
  EXPECT_LT(pairs_for_nearest(reference::scene_of(objects)),
            16u * 2 * kSides + kSmall * kSmall);  // a leaf for each triangle, and all small ones
}
TEST(DistanceCliffsTwin, ObjectsOfMoreThanOneLeafAreAllCompared) {
  EXPECT_GT(pairs_for_nearest(slivers(200, 17)), 200u * 100u);
}

// Cubes in a row, 0.5 apart: of so many objects only those that follow one another are within 0.6.
TEST(DistanceCliffs, WithinADistanceOnlyObjectsInReachAreAsked) {
  std::vector<std::vector<CliffTriangle>> objects;
  for (int k = 0; k < 400; ++k) {
    const Vec3 p(1.5 * k, 0, 0);
    objects.push_back({{p, p + Vec3(1, 0, 0), p + Vec3(1, 1, 1)}});
  }
  const Scene scene = reference::scene_of(objects);
  const auto asked = [&](double within) {
    const DistanceRecord record = distances(scene, {.within = within});
    return std::pair(record.trace.front().n, record.distances.size());
  };
  EXPECT_EQ(asked(0.4), std::pair(std::uint64_t{0}, std::size_t{0}));
  EXPECT_EQ(asked(0.6), std::pair(std::uint64_t{399}, std::size_t{399}));
  // Twin: without a limit all are.
  EXPECT_EQ(asked(std::numeric_limits<double>::infinity()).first, 400u * 399u / 2);
  EXPECT_NO_THROW(distances(scene, {.within = 0.6, .most_pairs = 100}));
  EXPECT_THROW(distances(scene, {.within = 0.6, .most_pairs = 99}), Error);
}

}  // namespace
}  // namespace farcull
