// FAR pairs where one rule alone keeps a pair: each scene loses it when that rule is taken away.
#include "core/base/stopwatch.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::Changed;
using lab::missed;
using lab::Random;
using lab::scene_of;
using lab::truth_of;
using Corners = std::array<Vec3, 3>;

// Two objects with the same box, so that the pixel grid is known.
std::vector<std::vector<Corners>> two_objects(const Vec3& lo, const Vec3& hi) {
  return {{{lo, lo, lo}, {hi, hi, hi}}, {{lo, lo, lo}, {hi, hi, hi}}};
}

// Small triangles in a box, for each object in turn, that fill its pixels.
void fill(std::vector<std::vector<Corners>>& objects, int count, const Vec3& lo, const Vec3& hi,
          double size, Random& random) {
  for (int n = 0; n < count; ++n) {
    const Vec3 p(random.between(lo.x(), hi.x()), random.between(lo.y(), hi.y()),
                 random.between(lo.z(), hi.z()));
    objects[n % 2].push_back({p, p + Vec3(size, 0, size / 2), p + Vec3(0, size, size / 4)});
  }
}

TEST(PairsEdges, NoViewResolvesWhatIsBeyondDouble) {
  constexpr double m = 1.5e308;
  const Scene scene = scene_of({{{Vec3(-m, 0, 0), Vec3(m, 0, 0), Vec3(0, m, m)}},
                                {{Vec3(-m, -m, 0), Vec3(m, 1, 0), Vec3(0, m, 0)}}});
  const auto backend = cpu_pair_backend(2);
  ASSERT_EQ(truth_of(scene).size(), 1u);
  EXPECT_EQ(missed(scene, {}, *backend), 0u);
  const PairSettings given{.views = parse_views("z")};
  EXPECT_EQ(missed(scene, given, *backend), 0u);
  EXPECT_EQ(find_pairs(scene, given, *backend).stages.back().kind, StageKind::join);
}

// A triangle that no view can show is compared with all others, and they are not joined for its
// sake: the boxes of these needles overlap 45 million times.
TEST(PairsEdges, ATriangleThatNoViewShowsCostsLittle) {
  Scene scene = make_builtin_scene("needles-layers");
  const auto backend = cpu_pair_backend(2);
  const auto timed = [&](PairResult& result) {
    const Stopwatch watch;
    result = find_pairs(scene, {}, *backend);
    return watch.ms();
  };
  PairResult before, after;
  const double without = std::min(timed(before), timed(before));
  const Vec3 far = Vec3(1, 1, 1) * 0x1p60;
  add_triangle(scene, {-far, far, far + Vec3(0, 0, 0x1p10)});
  ++scene.objects.back().triangle_count;
  const double with = std::min(timed(after), timed(after));
  ASSERT_EQ(after.views.size(), 1u);
  EXPECT_EQ(after.views[0].counts.undrawable, 1u);
  EXPECT_GT(after.candidates.size(), before.candidates.size());
  EXPECT_EQ(missed(decide(scene, before.candidates).pairs, after.candidates), 0u);
  // A join of all boxes takes more than twenty times as long.
  EXPECT_LT(with, 8 * without);
}

TEST(PairsEdges, TheLeastClearanceIsOne) {
  constexpr double least = 5e-324;
  const Scene scene = scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                                {{Vec3(0, 0, least), Vec3(1, 0, least), Vec3(0, 1, least)}}});
  const auto backend = cpu_pair_backend(2);
  ASSERT_EQ(truth_of(scene, least).size(), 1u);
  EXPECT_EQ(missed(scene, {.clearance = least}, *backend), 0u);
}

// Two whole triangles that start in a crowded pixel, where finer intervals part them, and meet in
// the next one.
TEST(PairsEdges, APairThatMeetsBesideACrowdedPixel) {
  Random random(3);
  auto objects = two_objects(Vec3(0, 0, -1), Vec3(8, 8, 2));
  fill(objects, 3000, Vec3(3.02, 3.02, 0), Vec3(3.96, 3.96, 1), 0.02, random);
  objects[0].push_back({Vec3(3.2, 3.2, 0), Vec3(4.8, 3.2, 1), Vec3(4.8, 3.8, 1)});
  objects[1].push_back({Vec3(3.2, 3.8, 0.9), Vec3(4.8, 3.8, 0.6), Vec3(4.8, 3.2, 0.6)});
  const Scene scene = scene_of(objects);
  const PairSettings settings{.views = parse_views("z"), .resolution = 8};
  // With so little memory each pixel is a tile of its own.
  for (const std::size_t memory : {std::size_t{256} << 20, std::size_t{1}}) {
    const auto backend = cpu_pair_backend(2, memory);
    EXPECT_EQ(missed(scene, settings, *backend), 0u) << memory;
    EXPECT_GT(find_pairs(scene, settings, *backend).views[0].counts.crowded, 0u);
  }
}

// Two whole triangles, one of which begins a row before the other, in a tile with a crowded pixel.
TEST(PairsEdges, APairOfWhichOneBeginsEarlierBesideACrowdedPixel) {
  const auto backend = cpu_pair_backend(2);
  for (const int row : {1, 2, 3, 4, 5}) {
    for (const int first : {0, 1}) {
      Random random(3);
      auto objects = two_objects(Vec3(0, 0, -1), Vec3(8, 8, 2));
      fill(objects, 3000, Vec3(6.02, row + 0.02, 0), Vec3(6.96, row + 0.96, 1), 0.02, random);
      objects[first].push_back(
          {Vec3(3.2, row + 0.2, 0), Vec3(3.8, row + 1.8, 0.5), Vec3(3.2, row + 1.8, 0.5)});
      objects[1 - first].push_back(
          {Vec3(3.2, row + 1.5, 0.4), Vec3(3.8, row + 1.5, 0.6), Vec3(3.8, row + 1.7, 0.3)});
      const Scene scene = scene_of(objects);
      const PairSettings settings{.views = parse_views("z"), .resolution = 8};
      EXPECT_EQ(missed(scene, settings, *backend), 0u) << row;
      EXPECT_GT(find_pairs(scene, settings, *backend).views[0].counts.crowded, 0u);
      const std::vector<TrianglePair> truth = truth_of(scene);
      const TrianglePair last{scene.objects[1].first_triangle - 1,
                              static_cast<std::uint32_t>(scene.triangles.size()) - 1};
      EXPECT_TRUE(std::ranges::binary_search(truth, last));
    }
  }
}

// A large triangle is compared with small ones by itself, over their rectangles. Those here are a
// little nearer than the clearance, beside it along the depth.
TEST(PairsEdges, LargeTrianglesWithinAClearance) {
  const auto backend = cpu_pair_backend(2);
  for (const double slope : {0.0, 0.3}) {
    const Vec3 along(1, 0, slope), up(0, 1, 0);
    const Vec3 normal = along.cross(up).normalized();
    std::vector<std::vector<Corners>> objects(2);
    objects[0].push_back({Vec3(0, 0, 0), 100 * along, 100 * up});
    for (int n = 0; n < 40; ++n) {
      const Vec3 p = (2 + n) * along + 20 * up + (n % 2 ? 0.95 : -0.95) * normal;
      objects[1].push_back({p, p + 0.5 * along, p + 0.5 * up});
    }
    const Scene scene = scene_of(objects);
    const PairSettings settings{
        .views = parse_views("z"), .resolution = 1024, .clearance = 1, .blocks = false};
    ASSERT_EQ(truth_of(scene, 1).size(), 40u);
    EXPECT_EQ(missed(scene, settings, *backend), 0u) << slope;
    EXPECT_EQ(find_pairs(scene, settings, *backend).views[0].counts.large, 1u);
  }
}

// Triangles of many sub-pixels that touch in one point, among crumbs that make the pixels crowded.
TEST(PairsEdges, ContactsInCrowdedPixels) {
  const auto backend = cpu_pair_backend(2);
  for (const std::uint64_t seed : {1u, 2u}) {
    Random random(seed);
    auto objects = two_objects(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    constexpr std::uint32_t contacts = 200;
    for (std::uint32_t n = 0; n < contacts; ++n) {
      const Vec3 q(random.between(-0.7, 0.7), random.between(-0.7, 0.7), random.between(-0.9, 0.9));
      const auto away = [&](double sign) {
        return Vec3(q + Vec3(random.between(-0.16, 0.16), random.between(-0.16, 0.16),
                             sign * random.between(0.004, 0.2)));
      };
      objects[0].push_back({q, away(1), away(1)});
      objects[1].push_back({q, away(-1), away(-1)});
    }
    fill(objects, 40000, Vec3(-0.99, -0.99, -0.9), Vec3(0.98, 0.98, 0.9), 0.005, random);
    const Scene scene = scene_of(objects);
    const PairResult result =
        find_pairs(scene, {.views = parse_views("z"), .resolution = 4}, *backend);
    EXPECT_GT(result.views[0].counts.crowded, 0u);
    for (std::uint32_t n = 2; n < 2 + contacts; ++n) {
      const TrianglePair contact{n, scene.objects[1].first_triangle + n};
      EXPECT_TRUE(std::ranges::binary_search(result.candidates, contact));
    }
  }
}

// The double term of the widening: vertices may lie anywhere within it.
std::size_t missed_when_moved(Changed::Change change) {
  Changed backend(change);
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    auto objects = two_objects(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    for (int n = 0; n < 20; ++n) {  // the same sheet, parallel to the image, in both
      const Vec3 q(random.between(-0.9, 0.9), random.between(-0.9, 0.9), random.between(-0.9, 0.9));
      for (auto& object : objects)
        object.push_back({q, q + Vec3(0.05, 0, 0), q + Vec3(0, 0.05, 0)});
    }
    count += missed(scene_of(objects), {.views = parse_views("z"), .resolution = 16}, backend);
  }
  return count;
}

void move(PairTask& task) {
  static std::vector<PixelVertex> moved;
  moved.assign(task.vertices.begin(), task.vertices.end());
  for (std::size_t v = 0; v < moved.size(); ++v) moved[v].z += v / 3 % 2 ? 0x1.fp-11f : -0x1.fp-11f;
  task.vertices = moved;
}

TEST(PairsEdges, VerticesAnywhereWithinTheDoubleTerm) { EXPECT_EQ(missed_when_moved(move), 0u); }

TEST(PairsTwin, WithoutTheDoubleTermMovedVerticesMiss) {
  EXPECT_GT(missed_when_moved([](PairTask& task) {
              move(task);
              task.widening = {0x1p-40f, 0x1p-40f, 0x1p-40f, 0};
            }),
            0u);
}

}  // namespace
}  // namespace farcull
