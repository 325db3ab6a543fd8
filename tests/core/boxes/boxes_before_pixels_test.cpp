#include "core/boxes/meetings.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/view/regions.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/reference.h"

namespace farcull {
namespace {

// Objects of small triangles that are scattered in a cube, and of some that cross it.
Scene scattered(std::uint64_t seed) {
  RandomNumbers random(seed);
  Scene scene;
  const auto point = [&](double size) {
    return Vec3(random.between(-size, size), random.between(-size, size),
                random.between(-size, size));
  };
  const std::size_t objects = 1 + random.below(5);
  for (std::size_t o = 0; o < objects; ++o) {
    Object object{.name = std::to_string(o)};
    object.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    object.self = random.below(3) == 0;
    object.triangle_count = static_cast<std::uint32_t>(random.below(120));
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      const Vec3 at = point(1);
      const double size = random.below(20) ? 0.1 : 1;
      const auto first = static_cast<std::uint32_t>(scene.vertices.size());
      for (int corner = 0; corner < 3; ++corner) scene.vertices.push_back(at + point(size));
      scene.triangles.push_back({first, first + 1, t % 2 ? first - 1 : first + 2});
    }
    scene.objects.push_back(object);
  }
  return scene;
}

std::vector<TrianglePair> expected(const Scene& scene, std::span<const ObjectPair> ignored,
                                   bool neighbours) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<TrianglePair> out;
  reference::for_each_pair(scene, [&](const TrianglePair& pair, bool boxes_overlap) {
    const bool ask = neighbours || !reference::neighbours(scene, pair);
    if (boxes_overlap && ask &&
        !std::ranges::count(ignored, ObjectPair{owner[pair.a], owner[pair.b]}))
      out.push_back(pair);
  });
  return out;
}

// Of the triangles of a scene without some of them, and without an object.
void expect_pairs_of_a_part(const Scene& scene, std::uint64_t seed) {
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<std::uint32_t> some;
  for (std::uint32_t t = 0; t < boxes.size(); ++t) {
    if (t % 3 != seed % 3 && owner[t] != seed % 7) some.push_back(t);
  }
  EXPECT_EQ(pairs_of_some(scene, some, 1), box_join(boxes, join_owners(scene), some)) << seed;
}

TEST(BoxesBeforePixels, FindAllPairsWhoseBoxesOverlap) {
  std::size_t found = 0, undecided = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Scene scene = scattered(seed);
    std::vector<ObjectPair> ignored;
    if (seed % 3 == 0 && scene.objects.size() > 1) ignored.push_back({0, 1});
    const bool neighbours = seed % 2 == 0;
    expect_pairs_of_a_part(scene, seed);
    const auto pairs = pairs_of_boxes(scene, ignored, neighbours, 1);
    if (!pairs) {
      ++undecided;
      continue;
    }
    EXPECT_EQ(*pairs, expected(scene, ignored, neighbours)) << seed;
    found += pairs->size();
  }
  EXPECT_GT(found, 10000u);
  EXPECT_LT(undecided, 100u);
  // Here a tree over the triangles would find the pairs, not the blocks.
  const Scene needles = make_builtin_scene("needles:2000");
  EXPECT_FALSE(pairs_of_boxes(needles, {}, true, 1));
  expect_pairs_of_a_part(needles, 6);
}

TEST(BoxesBeforePixels, PlacesAreWhereTheBoxesOfTwoTrianglesMeet) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Scene scene = scattered(seed);
    const auto pairs = pairs_of_boxes(scene, {}, true, 1);
    if (!pairs) continue;
    const Regions regions = regions_of(scene, *pairs);
    EXPECT_EQ(regions.triangles, members_of(*pairs, scene.triangles.size()));
    const std::vector<std::uint32_t> owner = owners(scene);
    std::map<std::uint32_t, Box> places;  // by the object of the first triangle
    for (const auto& [a, b] : *pairs) {
      EXPECT_EQ(regions.triangle_boxes[a].lo, grown_box(scene, a, 0).lo);
      places.try_emplace(owner[a], Box::empty())
          .first->second.add(intersection(grown_box(scene, a, 0), grown_box(scene, b, 0)));
    }
    ASSERT_EQ(regions.places.size(), places.size()) << seed;
    std::size_t at = 0;
    for (const auto& [object, place] : places) {
      EXPECT_EQ(regions.places[at].lo, place.lo) << seed;
      EXPECT_EQ(regions.places[at++].hi, place.hi) << seed;
    }
  }
}

}  // namespace
}  // namespace farcull
