// Pairs in order, some at a time, against all pairs of triangles whose boxes overlap.
#include "core/boxes/join.h"

#include "core/boxes/block.h"
#include "tests/lab/rational.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using rational::Random;

/// Objects of small triangles, some of them `self`, and one triangle that meets nearly all others.
Scene some_scene(Random& random, int triangles) {
  Scene scene;
  for (int t = 0; t < triangles; ++t) {
    const Vec3 at(random.below(7), random.below(7), random.below(3));
    std::array<Vec3, 3> corners;
    for (Vec3& p : corners) p = t == 5 ? Vec3(random.cube(9)) : Vec3(at + random.cube(0.7));
    add_triangle(scene, corners);
  }
  for (int first = 0; first < triangles;) {
    const int count = std::min(random.below(triangles / 2 + 2), triangles - first);
    scene.objects.push_back(
        {"", static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), random.coin()});
    first += count;
  }
  return scene;
}

std::vector<TrianglePair> by_search(const Scene& scene, double clearance,
                                    const std::vector<ObjectPair>& ignored) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<TrianglePair> out;
  for (std::uint32_t a = 0; a < owner.size(); ++a) {
    for (std::uint32_t b = a + 1; b < owner.size(); ++b) {
      if (owner[a] == owner[b] && !scene.objects[owner[a]].self) continue;
      if (std::ranges::find(ignored, ObjectPair{owner[a], owner[b]}) != ignored.end()) continue;
      if (overlap(grown_box(scene, a, clearance), grown_box(scene, b, clearance)))
        out.push_back({a, b});
    }
  }
  return out;
}

std::vector<TrianglePair> streamed(const Scene& scene, double clearance,
                                   const std::vector<ObjectPair>& ignored, unsigned threads,
                                   std::size_t most) {
  OrderedPairs pairs(scene, clearance, ignored, threads);
  std::vector<TrianglePair> out, part;
  while (!pairs.at_end()) {
    pairs.next(most, part);
    EXPECT_LE(part.size(), most + threads * scene.triangles.size());
    out.insert(out.end(), part.begin(), part.end());
  }
  pairs.next(most, part);
  EXPECT_TRUE(part.empty());
  return out;
}

TEST(OrderedPairs, AreAllPairsInOrderWhateverThePartsAndThreads) {
  Random random(621);
  std::size_t found = 0;
  for (const int triangles : {0, 1, 2, 15, 16, 17, 300, 700}) {
    const Scene scene = some_scene(random, triangles);
    std::vector<ObjectPair> ignored;
    if (scene.objects.size() > 2) ignored = {{0, 2}};
    const double clearance = random.coin() ? 0 : 0.25;
    const std::vector<TrianglePair> expected = by_search(scene, clearance, ignored);
    found += expected.size();
    for (const std::size_t most : {std::size_t{1}, std::size_t{40}, std::size_t{100'000}})
      for (const unsigned threads : {1u, 3u})
        EXPECT_EQ(streamed(scene, clearance, ignored, threads, most), expected) << triangles;
    // The twin: the search notices a pair of objects that is not ignored.
    if (!ignored.empty() && by_search(scene, clearance, {}) != expected) {
      EXPECT_NE(streamed(scene, clearance, {}, 1, 40), expected);
    }
  }
  EXPECT_GT(found, 200u);
}

TEST(OrderedPairs, OfAClearanceBeyondTheDoublesAreAllPairs) {
  Random random(622);
  Scene scene = some_scene(random, 40);
  for (Vec3& p : scene.vertices) p *= 1e307;
  constexpr double kMax = std::numeric_limits<double>::max();
  const std::vector<TrianglePair> expected = by_search(scene, kMax, {});
  EXPECT_GT(expected.size(), 500u);
  EXPECT_EQ(streamed(scene, kMax, {}, 2, 64), expected);
}

}  // namespace
}  // namespace farcull
