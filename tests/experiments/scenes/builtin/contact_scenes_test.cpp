// The scenes of things in contact: their sizes, the shapes of their triangles, and what collides in
// them, decided exactly.
#include <Eigen/Geometry>

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Make = BuiltScene (*)(const SceneParameters&, std::uint64_t);

Scene of(Make make, std::uint64_t size, std::uint64_t seed) {
  return make({.size = size}, seed).scene;
}

std::array<double, 3> sides(const Scene& scene, std::uint32_t triangle) {
  const auto [a, b, c] = scene.corners(triangle);
  std::array<double, 3> out = {(b - a).norm(), (c - b).norm(), (a - c).norm()};
  std::ranges::sort(out);
  return out;
}

// Height over the longest side.
double thickness(const Scene& scene, std::uint32_t triangle) {
  const auto [a, b, c] = scene.corners(triangle);
  const double longest = sides(scene, triangle)[2];
  return (b - a).cross(c - a).norm() / (longest * longest);
}

double part_of(std::vector<double> values, double part) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

TEST(ContactScenes, HaveTheSizeOfTheirNameAndFollowTheirSeed) {
  const std::map<std::string, Make> makers = {{"crumpled", make_crumpled},
                                              {"rope", make_rope},
                                              {"spheres", make_spheres},
                                              {"fans", make_fans},
                                              {"funnel", make_funnel}};
  for (const auto& [name, make] : makers) {
    const BuiltinScene& entry = *find_builtin_scene(name);
    for (const std::uint64_t size :
         {entry.size->least, std::uint64_t{12'000}, std::uint64_t{50'000}}) {
      SCOPED_TRACE(name + ":" + std::to_string(size));
      const Scene scene = of(make, size, *entry.seed);
      EXPECT_NO_THROW(validate(scene, name));
      EXPECT_NEAR(static_cast<double>(scene.triangles.size()), static_cast<double>(size),
                  0.1 * static_cast<double>(size));
      EXPECT_EQ(scene_hash(scene),
                scene_hash(make_builtin_scene(name + ":" + std::to_string(size))));
      EXPECT_NE(scene_hash(scene), scene_hash(of(make, size, 1)));
      double thinnest = 1;
      for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
        thinnest = std::min(thinnest, thickness(scene, t));
      EXPECT_GT(thinnest, 1e-6) << "degenerate";
    }
  }
}

TEST(ContactScenes, CrumpledSheetGoesThroughItselfAndHardlyStretches) {
  for (const std::uint64_t seed : {16u, 1u, 2u}) {
    SCOPED_TRACE(seed);
    const Scene scene = of(make_crumpled, 20'000, seed);
    EXPECT_GT(all_colliding_pairs(scene).pairs.size(), scene.triangles.size() / 2);
    std::vector<double> lengths;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
      for (const double length : sides(scene, t)) lengths.push_back(length);
    EXPECT_LT(part_of(lengths, 0.99), 3 * part_of(lengths, 0.01));
    EXPECT_LT(part_of(lengths, 1), 3 * part_of(lengths, 0.5));
    const Box box = object_boxes(scene, triangle_boxes(scene))[0];
    EXPECT_LT((box.hi - box.lo).maxCoeff(), 0.5) << "of a sheet of side 1";
  }
}

TEST(ContactScenes, StrandsOfARopeLieCloselyAndDoNotMeet) {
  for (const std::uint64_t size : {2'000u, 4'000u, 15'000u, 50'000u, 120'000u}) {
    for (const std::uint64_t seed : {17u, 1u, 2u, 3u}) {
      SCOPED_TRACE(std::to_string(size) + " with seed " + std::to_string(seed));
      const Scene scene = of(make_rope, size, seed);
      const ExactResult result = all_colliding_pairs(scene);
      EXPECT_EQ(result.pairs.size(), 0u);
      EXPECT_EQ(result.neighbour_pairs.size(), 0u);
      EXPECT_EQ(result.neighbours, 6 * scene.triangles.size()) << "not closed, or too coarse";
      EXPECT_GT(result.box_pairs, result.neighbours + scene.triangles.size() / 4);
    }
  }
  // The twin: strands as wide as their distance, in their radii, do meet.
  EXPECT_GT(all_colliding_pairs(of(make_rope, 15'000, 17), {.clearance = 0.2}).pairs.size(), 1000u);
}

TEST(ContactScenes, SpheresOfAHeapTouchSeveralOthers) {
  for (const std::uint64_t seed : {18u, 1u}) {
    SCOPED_TRACE(seed);
    const Scene scene = of(make_spheres, 40'000, seed);
    EXPECT_EQ(scene.objects.size(), 125u);
    const std::vector<std::uint32_t> owner = owners(scene);
    std::set<std::pair<std::uint32_t, std::uint32_t>> touching;
    for (const TrianglePair& pair : all_colliding_pairs(scene).pairs)
      touching.emplace(owner[pair.a], owner[pair.b]);
    std::vector<int> contacts(scene.objects.size(), 0);
    const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
    for (const auto& [a, b] : touching) {
      ++contacts[a];
      ++contacts[b];
      const Vec3 d = (boxes[a].lo + boxes[a].hi - boxes[b].lo - boxes[b].hi) / 2;
      const double radii = ((boxes[a].hi - boxes[a].lo).x() + (boxes[b].hi - boxes[b].lo).x()) / 2;
      EXPECT_GT(d.norm(), 0.85 * radii) << "deep in each other";
    }
    EXPECT_LE(std::ranges::count(contacts, 0), 3);
    EXPECT_GT(touching.size(), 2 * scene.objects.size());
    EXPECT_LT(touching.size(), 6 * scene.objects.size());
  }
}

TEST(ContactScenes, FansAreSliversWhoseBoxesOverlapAndOnePinIsPressedIn) {
  for (const std::uint64_t seed : {19u, 1u, 2u}) {
    SCOPED_TRACE(seed);
    Scene scene = of(make_fans, 12'000, seed);
    const ExactResult between = all_colliding_pairs(scene);
    EXPECT_GT(between.pairs.size(), 200u);
    EXPECT_LT(between.pairs.size(), 2000u);
    const std::uint64_t pairs =
        std::uint64_t{scene.objects[0].triangle_count} * scene.objects[1].triangle_count;
    EXPECT_GT(between.box_pairs, pairs / 12);
    std::vector<double> thin;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) thin.push_back(thickness(scene, t));
    EXPECT_LT(part_of(thin, 0.4), 0.05);
    // Neither part meets itself.
    for (Object& object : scene.objects) object.self = true;
    const ExactResult all = all_colliding_pairs(scene);
    EXPECT_EQ(all.pairs.size(), between.pairs.size());
    EXPECT_EQ(all.neighbour_pairs.size(), 0u);
  }
}

TEST(ContactScenes, ClothInAFunnelIsCloseToItselfAndToTheFunnel) {
  for (const std::uint64_t seed : {20u, 1u, 2u}) {
    SCOPED_TRACE(seed);
    const Scene scene = of(make_funnel, 12'000, seed);
    EXPECT_TRUE(scene.objects[0].self);
    EXPECT_FALSE(scene.objects[1].self);
    EXPECT_EQ(all_colliding_pairs(scene).pairs.size(), 0u);
    const std::uint32_t cloth = scene.objects[0].triangle_count;
    std::size_t own = 0, other = 0;
    for (const TrianglePair& pair : all_colliding_pairs(scene, {.clearance = 0.02}).pairs)
      ++(pair.b < cloth ? own : other);
    EXPECT_GT(own, 1000u);
    EXPECT_GT(other, 10u);
  }
}

}  // namespace
}  // namespace farcull
