// Sweep and prune on scenes, and of boxes: as brute force, from frame to frame. Its twins are the
// mutants of core/sweep (tests/mutants).

#include "tests/lab/boxes.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

using namespace lab;
using rational::Random;

// ---- triangles ----

/// Triangles whose boxes are the given ones, which are not empty.
Scene scene_of(const Boxes& boxes, const Indices& sizes, const std::vector<bool>& self) {
  Scene scene;
  for (const Box& box : boxes)
    add_triangle(scene, {box.lo, box.hi, Vec3(box.lo.x(), box.hi.y(), box.lo.z())});
  std::uint32_t first = 0;
  for (std::size_t o = 0; o < sizes.size(); ++o) {
    scene.objects.push_back({"o", first, sizes[o], self[o]});
    first += sizes[o];
  }
  return scene;
}

struct Expected {
  Pairs object_pairs;
  Indices triangles;
  Pairs candidates;
};

Expected expected_of(const Scene& scene, const Boxes& boxes) {
  const Indices owner = owners(scene);
  Expected out;
  out.object_pairs = brute_force(object_boxes(scene, boxes));
  out.candidates = brute_force(boxes, [&](std::uint32_t a, std::uint32_t b) {
    return owner[a] != owner[b] || scene.objects[owner[a]].self;
  });
  for (const TrianglePair& pair : out.candidates)
    out.triangles.insert(out.triangles.end(), {pair.a, pair.b});
  std::ranges::sort(out.triangles);
  out.triangles.erase(std::unique(out.triangles.begin(), out.triangles.end()), out.triangles.end());
  return out;
}

void expect_right(const SweepPruneResult& found, const Scene& scene) {
  const Boxes boxes = triangle_boxes(scene);
  const Expected expected = expected_of(scene, boxes);
  ASSERT_EQ(found.object_pairs, expected.object_pairs);
  ASSERT_EQ(found.candidates, expected.candidates);
  ASSERT_EQ(found.triangles, expected.triangles);
  EXPECT_EQ(found.counts.object_pairs, expected.object_pairs.size());
  EXPECT_EQ(found.counts.triangle_pairs, expected.candidates.size());
  EXPECT_EQ(found.counts.triangles, expected.triangles.size());
}

/// Objects that are clusters of boxes; `kind` as in move().
struct Moving {
  Boxes boxes;
  Indices sizes;
  std::vector<bool> self;

  Scene scene() const { return scene_of(boxes, sizes, self); }
};

Moving some_objects(Random& random, int objects, int kind) {
  Moving out;
  for (int o = 0; o < objects; ++o) {
    const auto size = static_cast<std::uint32_t>(random.below(12));  // some have no triangles
    const Vec3 at = random.cube(3);
    for (std::uint32_t i = 0; i < size; ++i) {
      Vec3 lo = at + random.cube(0.7), length = random.cube(0.2).cwiseAbs();
      if (kind == 0) lo = lo.array().round();
      if (kind == 0) length = Vec3(random.below(2), random.below(2), random.below(2));
      if (kind == 2) length[random.below(3)] = 4;  // long in one direction: many columns
      out.boxes.push_back({lo, lo + length});
    }
    out.sizes.push_back(size);
    out.self.push_back(random.below(5) == 0);
  }
  return out;
}

void move_objects(Moving& moving, Random& random, int kind) {
  std::size_t first = 0;
  for (const std::uint32_t size : moving.sizes) {
    Vec3 by = random.cube(0.05);
    if (kind == 0) by = Vec3(random.below(3) - 1, random.below(3) - 1, random.below(3) - 1);
    if (random.below(30) == 0) by = random.cube(5);
    for (std::size_t t = first; t < first + size; ++t) {
      moving.boxes[t] = {moving.boxes[t].lo + by, moving.boxes[t].hi + by};
      const int change = random.below(200);
      if (change == 0) moving.boxes[t].lo = moving.boxes[t].hi;
      if (change == 1) moving.boxes[t] = cube(-0.0, 0.0);
      if (change == 2) moving.boxes[t] = moving.boxes[0];
    }
    first += size;
  }
}

TEST(SweepPrune, AsBruteForceOverMovingObjects) {
  Random random(603);
  std::uint64_t candidates = 0;
  for (int kind = 0; kind < 3; ++kind) {
    SweepPrune sweep;
    Moving moving = some_objects(random, 30, kind);
    for (int frame = 0; frame < 25; ++frame) {
      const Scene scene = moving.scene();
      const SweepPruneResult found = sweep.find(scene);
      ASSERT_NO_FATAL_FAILURE(expect_right(found, scene)) << "kind " << kind << " frame " << frame;
      candidates += found.counts.triangle_pairs;
      move_objects(moving, random, kind);
    }
  }
  EXPECT_GT(candidates, 1000u);
}

// Pieces that break in two, grow together, appear, vanish and change places between frames.
TEST(SweepPrune, NothingThatIsKeptOutlivesItsTopology) {
  Random random(604);
  SweepPrune sweep;
  for (int frame = 0; frame < 40; ++frame) {
    Moving moving = some_objects(random, 5 + random.below(40), frame % 3);
    if (frame % 4 == 1) {  // all triangles of one object, then each its own
      moving.sizes = {static_cast<std::uint32_t>(moving.boxes.size())};
      moving.self = {frame % 8 == 1};
    } else if (frame % 4 == 2) {
      moving.sizes.assign(moving.boxes.size(), 1);
      moving.self.assign(moving.boxes.size(), true);
    }
    const Scene scene = moving.scene();
    ASSERT_NO_FATAL_FAILURE(expect_right(sweep.find(scene), scene)) << "frame " << frame;
  }
}

// Coherence is there: a scene that stands still is found sorted, whatever it took at first.
TEST(SweepPrune, WhatStandsStillIsNotSortedAgain) {
  Random random(606);
  SweepPrune sweep;
  Moving moving = some_objects(random, 300, 1);
  for (Box& box : moving.boxes) box = {box.lo / 3, box.hi / 3};  // all in each other's way
  const Scene scene = moving.scene();
  const SweepPruneCounts first = sweep.find(scene).counts;
  EXPECT_GT(first.sorts, 3u);  // of objects, and at least one more
  const SweepPruneCounts second = sweep.find(scene).counts;
  EXPECT_EQ(second.sorts, 0u);
  EXPECT_EQ(second.swaps, 0u);
}

// The short boxes make columns narrow. The long ones then are in so many columns that these are
// doubled in width, along both axes.
TEST(SweepPrune, AFewLongBoxesAmongManyShortOnes) {
  Random random(611);
  Moving moving;
  for (int o = 0; o < 3; ++o) {
    for (int k = 0; k < 1000; ++k) {
      const Vec3 at = random.cube(10);
      moving.boxes.push_back({at, at + Vec3::Constant(0x1p-10)});
    }
    moving.sizes.push_back(1000);
    moving.self.push_back(false);
  }
  for (int k = 0; k < 10; ++k) {
    moving.boxes.push_back(
        {Vec3::Constant(-9) + random.cube(1), Vec3::Constant(9) + random.cube(1)});
  }
  moving.sizes.push_back(10);
  moving.self.push_back(true);
  const Scene scene = moving.scene();
  SweepPrune sweep;
  for (int again = 0; again < 2; ++again) expect_right(sweep.find(scene), scene);
}

// Extents whose reciprocal overflows, extents that do so themselves, and a mean length of zero.
TEST(SweepPrune, TheEndsOfTheDoubles) {
  Random random(610);
  for (const double unit : {5e-324, 1e-310, 1.0, DBL_MAX / 4}) {
    for (const bool points : {false, true}) {
      SweepPrune sweep;
      for (int frame = 0; frame < 3; ++frame) {
        Moving moving;
        for (std::uint32_t o = 0; o < 100; ++o) {
          const Vec3 lo(random.below(8) - 4, random.below(8) - 4, random.below(8) - 4);
          const double length = points ? 0 : random.below(2);
          moving.boxes.push_back({lo * unit, (lo.array() + length).matrix() * unit});
          moving.sizes.push_back(1);
          moving.self.push_back(false);
        }
        const Scene scene = moving.scene();
        ASSERT_NO_FATAL_FAILURE(expect_right(sweep.find(scene), scene)) << "unit " << unit;
      }
    }
  }
}

// More partners than a triangle is compared with one by one.
TEST(SweepPrune, AGroundUnderManyObjects) {
  Random random(609);
  Moving moving;
  for (int k = 0; k < 200; ++k) {
    const Vec3 at(k % 20, k / 20, 0);
    moving.boxes.push_back({at, at + Vec3(0.5, 0.5, 0)});
  }
  moving.sizes.push_back(200);
  for (int o = 0; o < 150; ++o) {
    const Vec3 at(random.uniform(0, 20), random.uniform(0, 10), random.uniform(-0.3, 0));
    for (int k = 0; k < 2; ++k) moving.boxes.push_back({at, at + random.cube(0.6).cwiseAbs()});
    moving.sizes.push_back(2);
  }
  moving.self.assign(151, false);
  SweepPrune sweep;
  for (int frame = 0; frame < 3; ++frame) {
    const Scene scene = moving.scene();
    const SweepPruneResult found = sweep.find(scene);
    ASSERT_NO_FATAL_FAILURE(expect_right(found, scene));
    EXPECT_GT(found.counts.object_pairs, 64u);
    EXPECT_LT(found.counts.triangles, 500u);  // what is kept unasked is not live for that
    move_objects(moving, random, 1);
  }
}

TEST(SweepPrune, CountsWhatSurvives) {
  // Two that overlap with one triangle each in the other's way, one apart, one apart and `self`.
  const Boxes boxes = {cube(0, 1),   cube(3, 4),   cube(3.5, 5), cube(9, 9.5),
                       cube(20, 21), cube(30, 31), cube(31, 32)};
  const Scene scene = scene_of(boxes, {2, 2, 1, 2}, {false, false, true, true});
  SweepPrune sweep;
  const SweepPruneResult found = sweep.find(scene);
  EXPECT_EQ(found.object_pairs, (Pairs{{0, 1}}));
  EXPECT_EQ(found.candidates, (Pairs{{1, 2}, {5, 6}}));
  EXPECT_EQ(found.triangles, (Indices{1, 2, 5, 6}));
  EXPECT_EQ(found.counts.objects, 3u);
  EXPECT_EQ(sweep.find(Scene{}).counts.triangle_pairs, 0u);
}

TEST(SweepPrune, TakesTheBoxesThatAreGiven) {
  const Boxes boxes = {cube(0, 1), cube(2, 3)};
  const Scene scene = scene_of(boxes, {1, 1}, {false, false});
  SweepPrune sweep;
  EXPECT_TRUE(sweep.find(scene, boxes).candidates.empty());
  EXPECT_EQ(sweep.find(scene, Boxes{cube(0, 1.5), cube(1.5, 3)}).candidates, (Pairs{{0, 1}}));
  EXPECT_THROW(sweep.find(scene, Boxes{cube(0, 1)}), std::logic_error);
}

// ---- boxes ----

TEST(BoxSweep, FollowsBoxesThatMeetAndPart) {
  BoxSweep sweep;
  EXPECT_TRUE(sweep.update({}).empty());
  EXPECT_TRUE(sweep.update(Boxes{along_x(0, 1), along_x(3, 4)}).empty());
  EXPECT_TRUE(sweep.sorted_from_scratch());
  EXPECT_TRUE(sweep.update(Boxes{along_x(0, 1), along_x(2, 4)}).empty());
  EXPECT_FALSE(sweep.sorted_from_scratch());
  EXPECT_EQ(sweep.swaps(), 0u);
  EXPECT_EQ(sweep.update(Boxes{along_x(0, 1), along_x(0.5, 4)}), (Pairs{{0, 1}}));
  EXPECT_EQ(sweep.swaps(), 1u);
  EXPECT_EQ(sweep.update(Boxes{along_x(2, 3), along_x(0.5, 4)}), (Pairs{{0, 1}}));
  EXPECT_TRUE(sweep.update(Boxes{along_x(5, 6), along_x(0.5, 4)}).empty());
  EXPECT_FALSE(sweep.sorted_from_scratch());
}

TEST(BoxSweep, TouchingCountsWhicheverSideComes) {
  for (const double from : {-2.0, 0.0, 2.0}) {
    BoxSweep sweep;
    sweep.update(Boxes{along_x(0, 1), along_x(from, from + 0.5)});
    EXPECT_EQ(sweep.update(Boxes{along_x(0, 1), along_x(1, 1.5)}), (Pairs{{0, 1}}));
    EXPECT_EQ(sweep.update(Boxes{along_x(0, 1), along_x(-1, -0.0)}), (Pairs{{0, 1}}));
    EXPECT_EQ(sweep.update(Boxes{along_x(0, 0), along_x(-0.0, -0.0)}), (Pairs{{0, 1}}));
    EXPECT_TRUE(sweep.update(Boxes{along_x(5e-324, 1), along_x(-1, -0.0)}).empty());
    EXPECT_FALSE(sweep.sorted_from_scratch());
  }
}

// An empty box that stands where it stood, its sides exchanged along one axis, passes no other end.
TEST(BoxSweep, ABoxThatBecomesEmptyLeavesItsPairs) {
  for (int axis = 0; axis < 3; ++axis) {
    BoxSweep sweep;
    Boxes boxes = {cube(0, 9), cube(2, 3), cube(4, 5)};
    EXPECT_EQ(sweep.update(boxes), (Pairs{{0, 1}, {0, 2}}));
    std::swap(boxes[1].lo[axis], boxes[1].hi[axis]);
    EXPECT_EQ(sweep.update(boxes), (Pairs{{0, 2}}));
    boxes[0] = Box::empty();
    EXPECT_TRUE(sweep.update(boxes).empty());
    boxes[0] = cube(0, 9);
    EXPECT_EQ(sweep.update(boxes), (Pairs{{0, 2}}));
  }
}

TEST(BoxSweep, AsBruteForceOverMovingBoxes) {
  Random random(601);
  std::uint64_t swaps = 0;
  int coherent = 0;
  for (int kind = 0; kind < 4; ++kind) {
    BoxSweep sweep;
    Boxes boxes = some_boxes(random, 80);
    for (int frame = 0; frame < 60; ++frame) {
      ASSERT_EQ(sweep.update(boxes), brute_force(boxes)) << "kind " << kind << " frame " << frame;
      swaps += sweep.swaps();
      coherent += !sweep.sorted_from_scratch();
      if (frame % 20 == 19) boxes.resize(boxes.size() + 5 - frame / 2, cube(3, 4));
      if (frame % 20 == 5) std::ranges::reverse(boxes);  // others than before
      move(boxes, random, kind);
    }
  }
  // The answers came from the lists that were kept, not from beginning again.
  EXPECT_GT(swaps, 0u);
  EXPECT_GT(coherent, 20);
}

TEST(BoxSweep, BeginsAgainWhereTooMuchMoved) {
  Random random(602);
  BoxSweep sweep;
  for (int frame = 0; frame < 4; ++frame) {
    const Boxes boxes = [&] {
      Boxes out;
      for (int i = 0; i < 300; ++i) {
        const Vec3 at = random.cube(1);
        out.push_back({at, at + Vec3::Constant(0.1)});
      }
      return out;
    }();
    EXPECT_EQ(sweep.update(boxes), brute_force(boxes));
    EXPECT_TRUE(sweep.sorted_from_scratch());
    // It gave up in time: at most 8 moves for each of 600 ends, and one end's way, in each list.
    EXPECT_LE(sweep.swaps(), 3 * (8 * 600 + 600u));
  }
}

}  // namespace
}  // namespace farcull
