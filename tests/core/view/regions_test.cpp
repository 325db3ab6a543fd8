#include "core/view/regions.h"

#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/lab/reference.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using reference::Triangle;

Box box_of(const std::vector<Triangle>& triangles) {
  Box box = Box::empty();
  for (const Triangle& t : triangles)
    for (const Vec3& p : t) box.add(p);
  return box;
}

bool meet(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i)
    if (!(std::max(a.lo[i], b.lo[i]) <= std::min(a.hi[i], b.hi[i]))) return false;
  return true;
}

/// The plan recomputed from the definitions, over all objects and triangles.
bool as_defined(const std::vector<std::vector<Triangle>>& objects) {
  const Scene scene = reference::scene_of(objects);
  const Regions plan = find_regions(scene);
  std::vector<Box> boxes, regions;
  for (const auto& triangles : objects) boxes.push_back(box_of(triangles));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (meet(boxes[i], boxes[j]))
        regions.push_back({boxes[i].lo.cwiseMax(boxes[j].lo), boxes[i].hi.cwiseMin(boxes[j].hi)});
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0, t = 0; i < objects.size(); ++i) {
    for (const Triangle& triangle : objects[i]) {
      bool takes_part = false;
      for (std::size_t j = 0; j < boxes.size(); ++j)
        takes_part |= i != j && meet(box_of({triangle}), boxes[j]);
      if (takes_part) triangles.push_back(static_cast<std::uint32_t>(t));
      ++t;
    }
  }
  const auto same = [](const Box& a, const Box& b) { return a.lo == b.lo && a.hi == b.hi; };
  return plan.triangles == triangles &&
         std::equal(plan.places.begin(), plan.places.end(), regions.begin(), regions.end(), same) &&
         std::equal(plan.object_boxes.begin(), plan.object_boxes.end(), boxes.begin(), boxes.end(),
                    same) &&
         plan.triangle_boxes.size() == scene.triangles.size();
}

Triangle tile(double x, double y = 0, double z = 0) {
  return {Vec3(x, y, z), Vec3(x + 1, y, z), Vec3(x, y + 1, z)};
}

TEST(Regions, OfNothingIsNothing) {
  EXPECT_TRUE(as_defined({}));
  EXPECT_TRUE(as_defined({{}, {}, {}}));
  EXPECT_TRUE(as_defined({{}, {tile(0), tile(0)}, {}}));
  const Regions alone = find_regions(reference::scene_of({{tile(0), tile(0)}}));
  EXPECT_TRUE(alone.triangles.empty());  // an object is no partner of itself
  EXPECT_TRUE(alone.places.empty());
}

TEST(Regions, TouchingCountsAndRegionsMayBePoints) {
  const Regions plan = find_regions(reference::scene_of({{tile(0), tile(-9)}, {tile(1, 1)}}));
  EXPECT_EQ(plan.triangles, (std::vector<std::uint32_t>{0, 2}));
  ASSERT_EQ(plan.places.size(), 1u);
  EXPECT_EQ(plan.places[0].lo, Vec3(1, 1, 0));
  EXPECT_EQ(plan.places[0].hi, Vec3(1, 1, 0));
}

// The box of the partner decides, not the region of the pair: the region of 0 and 1 is met by the
// first triangle of 0, and so is nothing else.
TEST(Regions, KeepsOneTriangleOfAnObjectOnceWithManyPartners) {
  EXPECT_TRUE(as_defined({{tile(0)}, {tile(0.5)}, {tile(0.25)}, {tile(0.1), tile(7)}}));
  const Regions plan =
      find_regions(reference::scene_of({{tile(0), tile(5)}, {tile(0)}, {tile(0)}}));
  EXPECT_EQ(plan.triangles, (std::vector<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(plan.places.size(), 3u);
}

RC_GTEST_PROP(PlanProperty, AsDefinedOnTheGrid, ()) {
  const auto sizes =
      *rc::gen::resize(7, rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 12)));
  const auto extent = *rc::gen::inRange<unsigned>(1, 30);
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::vector<std::vector<Triangle>> objects;
  for (const int size : sizes) {
    auto& triangles = objects.emplace_back(size);
    const Vec3 at(random() % extent, random() % extent, random() % 3);
    for (Triangle& t : triangles) {
      const Vec3 base = at + Vec3(random() % 4, random() % 4, random() % 2);
      for (Vec3& p : t) p = base + Vec3(random() % 3, random() % 3, random() % 2);
    }
  }
  RC_ASSERT(as_defined(objects));
}

// What culling relies on: of every pair of triangles that meet, both take part, and a common point
// lies in a region.
RC_GTEST_PROP(PlanProperty, EveryMeetingPairTakesPart, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::vector<std::vector<Triangle>> objects(4);
  for (auto& triangles : objects) {
    triangles.resize(random() % 6);
    for (Triangle& t : triangles)
      for (Vec3& p : t) p = Vec3(random() % 6, random() % 6, random() % 6);
  }
  const Scene scene = reference::scene_of(objects);
  const Regions plan = find_regions(scene);
  reference::for_each_pair(scene, [&](const TrianglePair& pair, bool overlapping) {
    if (!overlapping || !reference::intersects(scene.corners(pair.a), scene.corners(pair.b)))
      return;
    for (const std::uint32_t t : {pair.a, pair.b})
      RC_ASSERT(std::ranges::binary_search(plan.triangles, t));
    const Box common = intersection(plan.triangle_boxes[pair.a], plan.triangle_boxes[pair.b]);
    RC_ASSERT(std::ranges::any_of(plan.places, [&](const Box& region) {
      return (region.lo.array() <= common.lo.array()).all() &&
             (common.hi.array() <= region.hi.array()).all();
    }));
  });
}

}  // namespace
}  // namespace farcull
