// Placements stand apart in every view, collide as they are meant to, and are missed where the ball
// is far too small.
#include "experiments/studies/run_point.h"

#include "experiments/measure/lab.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

TEST(Placements, LengthsOfIntersections) {
  const std::array<Vec3, 3> flat = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const std::array<Vec3, 3> through = {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(-9, 1, 0)};
  EXPECT_NEAR(intersection_length(flat, through), 1, 1e-12);
  EXPECT_EQ(intersection_length(through, flat), intersection_length(flat, through));
  std::array<Vec3, 3> above = through;
  for (Vec3& p : above) p[2] += 3;
  EXPECT_EQ(intersection_length(flat, above), 0) << "the twin: they do not meet";
}

// The two patches of each placement, as a box.
std::vector<Box> boxes_of(const PlacedPatches& placed) {
  std::vector<Box> out(placed.placements, Box::empty());
  const std::size_t half = placed.scene.triangles.size() / 2;
  for (std::uint32_t t = 0; t < placed.scene.triangles.size(); ++t)
    for (const Vec3& p : placed.scene.corners(t)) out[t % half / kPatchTriangles].add(p);
  return out;
}

// Placements that overlap in the image of a view, two units of room around each.
int crowded(const std::vector<Box>& boxes, int depth) {
  int out = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis) {
        if (axis == depth) continue;
        apart |=
            boxes[i].lo[axis] > boxes[k].hi[axis] + 2 || boxes[k].lo[axis] > boxes[i].hi[axis] + 2;
      }
      out += !apart;
    }
  }
  return out;
}

TEST(Placements, StandApartInEveryView) {
  const PatchSource source(make_builtin_scene("random-soup"));
  for (const bool grazing : {false, true}) {
    const PlacedPatches placed = source.place(grazing, 1, 160, 1000, 3);
    ASSERT_EQ(placed.placements, 100u);
    ASSERT_EQ(placed.scene.triangles.size(), 2 * 100 * kPatchTriangles);
    std::vector<Box> boxes = boxes_of(placed);
    for (int depth = 0; depth < 3; ++depth) EXPECT_EQ(crowded(boxes, depth), 0) << depth;
    boxes[0] = boxes[1];
    EXPECT_GT(crowded(boxes, 2), 0) << "the twin: two in one place are seen";
    // Most placements collide, and nothing collides across placements.
    std::vector<int> collides(placed.placements);
    for (const TrianglePair& pair : all_colliding_pairs(placed.scene, {.threads = 1}).pairs) {
      const std::size_t at = pair.a / kPatchTriangles;
      EXPECT_EQ(pair.b / kPatchTriangles, at + placed.placements);
      collides[at] = 1;
    }
    EXPECT_GT(std::ranges::count(collides, 1), 90) << grazing;
  }
}

TEST(Placements, AreTheSameForASeed) {
  const PatchSource source(make_builtin_scene("random-soup"));
  const auto vertices = [&](std::uint64_t seed) {
    return source.place(true, 0.25, 64, 20, seed).scene.vertices;
  };
  EXPECT_EQ(vertices(5), vertices(5));
  EXPECT_NE(vertices(5), vertices(6));
}

// Rows of other sizes, resolutions and kinds are added up as if each placement were drawn anew.
TEST(Placements, AreDrawnAnewForWhatIsAddedUp) {
  const PlacementPoint point{.from = "random-soup",
                             .grazing = true,
                             .side = 0x1p-5,
                             .placements = 500,
                             .subpixel_bits = 8,
                             .radius = {},
                             .resolution = 256};
  std::set<std::uint64_t> seeds;
  for (const std::uint64_t seed : {1, 2}) {
    for (const bool grazing : {false, true}) {
      for (const double side : {0x1p-5, 0.25, 1.0, 16.0}) {
        for (const int resolution : {256, 1024, 4096}) {
          for (const std::uint64_t window : {0, 1, 100}) {
            PlacementPoint other = point;
            other.seed = seed;
            other.grazing = grazing;
            other.side = side;
            other.resolution = resolution;
            seeds.insert(placement_seed(other, window));
          }
        }
      }
    }
  }
  EXPECT_EQ(seeds.size(), 2u * 2 * 4 * 3 * 3);
  PlacementPoint other = point;
  other.subpixel_bits = 0;
  other.radius = parse_radius("0.5");
  EXPECT_EQ(placement_seed(other, 3), placement_seed(point, 3)) << "these look at the same ones";
}

PlacementCounts measured(const RadiusRule& radius, int bits) {
  Lab lab("native");
  const PlacementPoint point{.from = "random-soup",
                             .grazing = true,
                             .side = 1,
                             .placements = 500,
                             .subpixel_bits = bits,
                             .radius = radius,
                             .resolution = 256};
  return std::get<PlacementCounts>(measure_placements(point, lab).counts);
}

TEST(Placements, AreMissedOnlyBelowTheBudget) {
  for (const int bits : {0, 4, 8}) {
    const PlacementCounts budget = measured({}, bits);
    EXPECT_EQ(budget.placements, 500u);
    EXPECT_GT(budget.colliding_placements, 400u);
    EXPECT_TRUE(budget.promises);
    EXPECT_EQ(budget.missed, 0u) << bits;
    EXPECT_EQ(budget.radius_px, budget.budget_px);
  }
  const PlacementCounts small = measured({.published = false, .factor = 0.1}, 8);
  EXPECT_FALSE(small.promises);
  EXPECT_GT(small.missed, 0u) << "the twin: a small ball misses";
  EXPECT_GT(small.missed_placements, 0u);
  EXPECT_LE(small.missed_placements, small.colliding_placements);
  EXPECT_GT(small.largest_miss_px, 0);
}

}  // namespace
}  // namespace farcull
