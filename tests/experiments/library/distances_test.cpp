// Distances as users of the library see them, held against those of the method.
#include "experiments/method/distances.h"
#include "experiments/library/farcull.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/experiments/method/distance_lab.h"
#include "tests/lab/flat.h"

namespace farcull {
namespace {

void expect_same(const std::vector<DistanceAnswer>& found, const DistanceRecord& record) {
  ASSERT_EQ(found.size(), record.distances.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const DistanceAnswer& x = found[k];
    const Distance& y = record.distances[k];
    EXPECT_EQ((ObjectPair{x.object_a, x.object_b}), y.objects);
    EXPECT_EQ((TrianglePair{x.triangle_a, x.triangle_b}), y.triangles);
    EXPECT_EQ(x.distance, y.closest.distance);
    EXPECT_EQ(x.squared, y.closest.squared.text());
    EXPECT_EQ(x.feature_a, to_string(y.closest.features[0]));
    EXPECT_EQ(x.feature_b, to_string(y.closest.features[1]));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(x.point_a[axis], y.closest.points[0][axis]);
      EXPECT_EQ(x.point_b[axis], y.closest.points[1][axis]);
    }
    EXPECT_EQ(static_cast<int>(x.inside), static_cast<int>(y.inside));
  }
}

TEST(LibraryDistances, AreThoseOfTheMethodSceneAfterScene) {
  rational::Draws random(1);
  DistanceFinder all_pairs;
  DistanceFinder near({.kind = DistanceKind::nearest, .k = 2});
  DistanceFinder within({.kind = DistanceKind::all, .within = 3, .threads = 2});
  for (int k = 0; k < 20; ++k) {
    Scene scene = distance_lab::random_scene(random, 4, 12);
    for (Object& object : scene.objects) object.self = false;
    if (!nothing_asked(scene, {}).empty()) {
      EXPECT_TRUE(all_pairs.find(Flat(scene).input()).empty());
      continue;
    }
    expect_same(all_pairs.find(Flat(scene).input()), distances(scene, {}));
    expect_same(near.find(Flat(scene).input()),
                distances(scene, {.pairs = DistancePairs::nearest, .k = 2}));
    expect_same(within.find(Flat(scene).input()),
                distances(scene, {.pairs = DistancePairs::all, .within = 3}));
  }
}

TEST(LibraryDistances, OfObjectsThatAreAskedAboutByThemselves) {
  Scene scene = make_builtin_scene("degenerate");
  scene.objects[1].self = true;
  DistanceFinder finder({.self_objects = {false, true}});
  expect_same(finder.find(Flat(scene).input()), distances(scene, {}));
  EXPECT_THROW(DistanceFinder({.self_objects = {true}}).find(Flat(scene).input()), ColliderError);
}

TEST(LibraryDistances, OfACallerThatRoundsUpwardAreTheSame) {
  const Scene scene = make_builtin_scene("degenerate");
  const Flat flat(scene);
  const auto expected = distances(flat.input());
  std::fesetround(FE_UPWARD);
  const auto found = distances(flat.input());
  EXPECT_EQ(std::fegetround(), FE_UPWARD);
  std::fesetround(FE_TONEAREST);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].distance, expected[0].distance);
  EXPECT_EQ(found[0].squared, expected[0].squared);
}

TEST(LibraryDistances, RefuseWhatIsBad) {
  const auto where = [](const auto& call) { return refusal(call)[0]; };
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = HUGE_VAL;
  EXPECT_EQ(where([&] { DistanceFinder({.within = nan}); }), "within");
  EXPECT_EQ(where([] { DistanceFinder({.kind = DistanceKind::all}); }), "within");
  EXPECT_EQ(where([&] { DistanceFinder({.kind = DistanceKind::all, .within = infinite}); }),
            "within");
  EXPECT_EQ(where([] { DistanceFinder({.kind = DistanceKind::nearest, .k = 0}); }), "k");
  EXPECT_EQ(where([] { DistanceFinder({.threads = 1025}); }), "threads");
  const std::vector<double> vertices = {0, 0, nan};
  const std::vector<std::uint32_t> triangles = {0, 0, 0}, wrong = {0, 0, 7};
  EXPECT_EQ(where([&] { distances({vertices, triangles, {}}); }), "vertices");
  const std::vector<double> good = {0, 0, 0};
  EXPECT_EQ(where([&] { distances({good, wrong, {}}); }), "triangles");
  EXPECT_TRUE(distances({good, triangles, {}}).empty());
}

}  // namespace
}  // namespace farcull
