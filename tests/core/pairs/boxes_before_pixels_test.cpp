#include "core/pairs/boxes_before_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "core/boxes/block.h"
#include "tests/core/pairs/pairs_lab.h"

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
    object.triangle_count = static_cast<std::uint32_t>(random.below(120));
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      const Vec3 at = point(1);
      const double size = random.below(20) ? 0.1 : 1;
      const auto first = static_cast<std::uint32_t>(scene.vertices.size());
      for (int corner = 0; corner < 3; ++corner) scene.vertices.push_back(at + point(size));
      scene.triangles.push_back({first, first + 1, first + 2});
    }
    scene.objects.push_back(object);
  }
  return scene;
}

struct Expected {
  std::vector<std::uint32_t> triangles;
  std::uint64_t pairs = 0;
};

// By comparing all boxes of triangles of different objects.
Expected expected(const Scene& scene, std::span<const ObjectPair> ignored) {
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<std::uint32_t> owner = owners(scene);
  Expected out;
  std::vector<std::uint8_t> meets(boxes.size(), 0);
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (owner[a] == owner[b] || !overlap(boxes[a], boxes[b]) ||
          std::ranges::count(ignored, ObjectPair{owner[a], owner[b]}))
        continue;
      ++out.pairs;
      meets[a] = meets[b] = 1;
    }
  }
  for (std::uint32_t t = 0; t < boxes.size(); ++t) {
    if (meets[t]) out.triangles.push_back(t);
  }
  return out;
}

TEST(BoxesBeforePixels, LeaveWhatMeetsABoxOfAnotherObject) {
  std::size_t taken_out = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Scene scene = scattered(seed);
    std::vector<ObjectPair> ignored;
    if (seed % 3 == 0 && scene.objects.size() > 1) ignored.push_back({0, 1});
    Regions regions = find_regions(scene);
    const std::size_t before = regions.triangles.size();
    const NarrowedRegions result = narrow_regions(scene, ignored, 1, regions);
    if (!result.narrowed) continue;
    const Expected all = expected(scene, ignored);
    // Objects that are left to views keep what meets their regions.
    EXPECT_TRUE(std::ranges::includes(regions.triangles, all.triangles)) << seed;
    EXPECT_LE(result.pairs, all.pairs) << seed;
    if (result.pairs == all.pairs && !all.triangles.empty()) {
      EXPECT_EQ(regions.triangles, all.triangles) << seed;
    }
    taken_out += before - regions.triangles.size();
  }
  EXPECT_GT(taken_out, 1000u);
}

TEST(BoxesBeforePixels, PlacesHoldWhereTheBoxesOfTwoTrianglesMeet) {
  std::size_t smaller = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Scene scene = scattered(seed);
    Regions regions = find_regions(scene);
    const std::vector<Box> whole = regions.places;
    if (!narrow_regions(scene, {}, 1, regions).narrowed) continue;
    const std::vector<std::uint32_t> owner = owners(scene);
    for (const std::uint32_t a : regions.triangles) {
      for (const std::uint32_t b : regions.triangles) {
        const std::vector<Box>& boxes = regions.triangle_boxes;
        if (owner[a] >= owner[b] || !overlap(boxes[a], boxes[b])) continue;
        const Box common = intersection(boxes[a], boxes[b]);
        EXPECT_TRUE(std::ranges::any_of(regions.places, [&](const Box& place) {
          return (place.lo.array() <= common.lo.array()).all() &&
                 (place.hi.array() >= common.hi.array()).all();
        })) << seed;
      }
    }
    for (const Box& place : regions.places) {
      smaller += std::ranges::none_of(
          whole, [&](const Box& box) { return box.lo == place.lo && box.hi == place.hi; });
    }
  }
  EXPECT_GT(smaller, 50u);
}

}  // namespace
}  // namespace farcull
