// Blocks of triangles and the comparisons on lanes: all boxes that overlap are found, on every
// instruction set, whatever the order of the triangles. Each property has a twin that must fail.
#include "core/boxes/triangle_blocks.h"

#include "core/boxes/oriented.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/lanes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::missed, lab::overlapping, lab::random_scene, lab::shuffled, lab::truth_of,
    lab::with_self;

std::vector<Scene> small_scenes() {
  std::vector<Scene> out;
  for (const char* name : {"two-spheres", "crowd", "field:1000", "spheres:1000", "crumpled:1000",
                           "crowd@far", "degenerate", "degenerate@huge"}) {
    Scene scene = make_builtin_scene(name);
    if (scene.triangles.size() > 12'000) continue;
    out.push_back(shuffled(scene, 1));
    out.push_back(std::move(scene));
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    out.push_back(seed % 2 ? with_self(random_scene(seed)) : random_scene(seed));
  return out;
}

// The middle half of each object's box.
std::vector<Box> middles_of(const TriangleBlocks& blocks) {
  std::vector<Box> out = blocks.objects;
  for (Box& box : out) {
    if (box.is_empty()) continue;
    const Vec3 size = box.hi - box.lo;
    box = {box.lo + 0.25 * size, box.hi - 0.25 * size};
  }
  return out;
}

TEST(Blocks, HoldEachTriangleOnceInItsBox) {
  std::size_t gathered = 0, outside = 0;
  for (const Scene& scene : small_scenes()) {
    for (const double clearance : {0.0, 0.01}) {
      for (const bool all : {true, false}) {
        TriangleBlocks blocks = make_blocks(scene, clearance, 2);
        const std::vector<Box> regions = all ? blocks.objects : middles_of(blocks);
        gather_scattered(scene, clearance, regions, 2, blocks);
        std::set<std::uint32_t> seen;
        for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
          const Object& object = scene.objects[o];
          gathered += blocks.is_gathered(o);
          for (std::uint32_t k = 0; k < blocks.first[o + 1] - blocks.first[o]; ++k) {
            const TriangleBlock& block = blocks.ranges[blocks.first[o] + k];
            for (std::uint32_t i = 0; i < block.count; ++i) {
              const std::uint32_t t = blocks.triangle(block.first + i);
              ASSERT_TRUE(seen.insert(t).second);
              ASSERT_LT(t - object.first_triangle, object.triangle_count);
              const Box box = grown_box(scene, t, clearance);
              const FloatBox own = relative(box, blocks.origin);
              if (k >= blocks.count(o)) {
                ++outside;
                ASSERT_FALSE(overlap(box, regions[o]));
                continue;
              }
              const FloatBox bound = blocks.bound(o, k);
              const bool holds =
                  !blocks.is_gathered(o) ||
                  blocks.lanes[blocks.gathered[o].first + k].boxes.get(i).lo != kNowhere.lo;
              if (!holds) {  // the last block may go on behind those that meet the region
                ASSERT_EQ(k + 1, blocks.count(o));
                ASSERT_FALSE(overlap(box, regions[o]));
                ++outside;
                continue;
              }
              for (std::size_t axis = 0; axis < 3; ++axis) {
                ASSERT_LE(bound.lo[axis], own.lo[axis]);
                ASSERT_GE(bound.hi[axis], own.hi[axis]);
              }
              if (!blocks.is_gathered(o)) continue;
              const BlockLanes& block = blocks.lanes[blocks.gathered[o].first + k];
              ASSERT_EQ(block.triangles[i], t);
              ASSERT_EQ(block.boxes.get(i).lo, own.lo);
              ASSERT_EQ(block.boxes.get(i).hi, own.hi);
            }
          }
        }
        ASSERT_EQ(seen.size(), scene.triangles.size());
      }
    }
  }
  EXPECT_GT(gathered, 20u);
  EXPECT_GT(outside, 1000u);
}

TEST(Blocks, ThatOverlapAreFoundInTheTrees) {
  std::size_t found = 0;
  for (const Scene& scene : small_scenes()) {
    const TriangleBlocks blocks = make_blocks(scene, 0, 1);
    const BlockTrees trees(blocks, blocks.objects);
    const auto objects = static_cast<std::uint32_t>(scene.objects.size());
    for (std::uint32_t a = 0; a < objects; ++a) {
      for (std::uint32_t b = a; b < std::min(objects, a + 8); ++b) {
        std::vector<BlockPair> expected;
        for (std::uint32_t r = blocks.first[a]; r < blocks.first[a + 1]; ++r) {
          for (std::uint32_t s = a == b ? r : blocks.first[b]; s < blocks.first[b + 1]; ++s)
            if (overlap(blocks.boxes[r], blocks.boxes[s])) expected.push_back({r, s});
        }
        std::vector<BlockPair> first;
        on_every_target([&] {
          std::vector<BlockPair> pairs;
          pair_blocks(trees, a, b, blocks.first[a], blocks.first[a + 1], SIZE_MAX, pairs);
          if (first.empty()) first = pairs;
          ASSERT_EQ(pairs, first);
          std::ranges::sort(pairs);
          ASSERT_TRUE(std::ranges::includes(pairs, expected));
          found += pairs.size();
        });
      }
    }
  }
  EXPECT_GT(found, 100'000u);
}

// The pairs of blocks along the axes of all meetings, also where something else would decide.
BlockMeetings along_axes(const Scene& scene, double clearance,
                         std::span<const ObjectPair> ignored = {}) {
  const auto blocks = std::make_shared<TriangleBlocks>(make_blocks(scene, clearance, 2));
  const ObjectOverlaps meetings = find_meetings(scene, *blocks, ignored);
  const std::vector<Box> regions = boxes_of_meetings(*blocks, meetings.all);
  gather_scattered(scene, clearance, regions, 2, *blocks);
  const BlockTrees trees(*blocks, regions);
  BlockMeetings out;
  out.of = blocks;
  out.meetings = meetings.all.size();
  for (const auto& [a, b] : meetings.all) {
    pair_blocks(trees, a, b, blocks->first[a], blocks->first[a] + blocks->count(a), SIZE_MAX,
                a == b ? out.pairs.inside : out.pairs.between);
  }
  return out;
}

TEST(Blocks, GiveThePairsWhoseBoxesOverlap) {
  std::size_t pairs = 0, by_blocks = 0;
  for (const Scene& scene : small_scenes()) {
    for (const double clearance : {0.0, 0.01}) {
      for (const bool neighbours : {true, false}) {
        const BlockMeetings blocks = along_axes(scene, clearance);
        if (blocks.empty()) continue;
        ++by_blocks;
        const std::vector<TrianglePair> expected = overlapping(scene, clearance, neighbours);
        pairs += expected.size();
        on_every_target([&] {
          for (const unsigned threads : {1u, 3u})
            ASSERT_EQ(pairs_of_blocks(scene, blocks, clearance, neighbours, threads), expected)
                << scene.name;
        });
      }
    }
  }
  EXPECT_GT(by_blocks, 20u);
  EXPECT_GT(pairs, 100'000u);
}

// Each pair is given once, so that it is decided and counted once. The twin: a pair of blocks that
// is there twice gives its pairs twice.
TEST(Blocks, GiveEachPairOnce) {
  std::size_t twice = 0;
  for (const Scene& scene : small_scenes()) {
    const BlockMeetings blocks = along_axes(scene, 0);
    if (blocks.empty()) continue;
    const auto given = [&](const BlockPairs& some) {
      std::mutex mutex;
      std::vector<TrianglePair> all;
      const std::uint64_t count =
          give_pairs_of_blocks(scene, blocks, some, 0, true, 3, [&](const auto& pairs) {
            const std::scoped_lock lock(mutex);
            all.insert(all.end(), pairs.begin(), pairs.end());
          });
      EXPECT_EQ(all.size(), count);
      std::ranges::sort(all);
      return all;
    };
    ASSERT_EQ(given(blocks.pairs), pairs_of_blocks(scene, blocks, 0, true, 2)) << scene.name;
    BlockPairs more = blocks.pairs;
    more.between.insert(more.between.end(), more.between.begin(), more.between.end());
    more.inside.insert(more.inside.end(), more.inside.begin(), more.inside.end());
    const std::vector<TrianglePair> repeated = given(more);
    twice += std::ranges::adjacent_find(repeated) != repeated.end();
  }
  EXPECT_GT(twice, 4u);
}

TEST(Blocks, OfIgnoredObjectsAreNoPairs) {
  std::size_t removed = 0;
  for (const Scene& scene : small_scenes()) {
    std::vector<ObjectPair> ignored;
    for (std::uint32_t b = 1; b < scene.objects.size(); ++b)
      for (std::uint32_t a = b % 2; a < b; a += 2) ignored.push_back({a, b});
    ignored = in_order(std::move(ignored));
    const BlockMeetings blocks = along_axes(scene, 0, ignored);
    if (blocks.empty()) continue;
    std::vector<TrianglePair> expected = overlapping(scene, 0, true);
    removed += remove_ignored(scene, ignored, expected);
    ASSERT_EQ(pairs_of_blocks(scene, blocks, 0, true, 2), expected) << scene.name;
  }
  EXPECT_GT(removed, 100u);
}

TEST(Blocks, DecideAlikeWhateverTheThreads) {
  std::vector<Scene> scenes = small_scenes();
  scenes.push_back(
      shuffled(make_builtin_scene("crumpled:60000"), 1));  // ordered in several threads
  scenes.push_back(make_builtin_scene("needles"));
  scenes.push_back(make_builtin_scene("needles:2000"));  // left to a tree
  std::size_t ordered = 0, trees = 0;
  for (const Scene& scene : scenes) {
    const BlockDecision one = decide_by_blocks(scene, 0, 1), five = decide_by_blocks(scene, 0, 5);
    ASSERT_EQ(one.blocks.pairs.between, five.blocks.pairs.between);
    ASSERT_EQ(one.blocks.pairs.inside, five.blocks.pairs.inside);
    ASSERT_EQ(one.blocks.of != nullptr, five.blocks.of != nullptr);
    if (one.blocks.of) {
      ASSERT_EQ(one.blocks.of->order, five.blocks.of->order);
      ordered += one.blocks.of->order.size() > 50'000;
    }
    ASSERT_EQ(one.tree, five.tree);
    trees += one.tree != Reason::none;
  }
  EXPECT_GT(ordered, 0u);
  EXPECT_GT(trees, 0u);
}

// Two objects of `count` blocks each. Along x, block k of the first reaches from k to k + reach,
// and block k of the second half a unit further; in y and z all reach from 0 to 1. One triangle of
// each block is in its middle and large enough to meet those of other blocks.
Scene ladders(int count, int reach) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (std::size_t o = 0; o < 2; ++o) {
    for (int k = 0; k < count; ++k) {
      const Vec3 from(k + 0.5 * static_cast<double>(o), 0, 0), size(reach, 1, 1);
      for (std::uint32_t i = 0; i < kWide; ++i) {
        const Vec3 at = from + size * (i / (kWide - 1.0));
        const Vec3 half = i == kWide / 2 ? Vec3(0.3, 0.3, 0.3) : Vec3::Zero();
        objects[o].push_back({at - half, at, at + half});
      }
    }
  }
  return lab::scene_of(objects);
}

// Blocks i and j of the two objects meet iff -reach < i - j <= reach. These are 2 count reach -
// reach^2 pairs, which is kPairsPerBlock for each block where count is 162 and reach 36.
TEST(Blocks, AsManyPairsAsAreAllowedAreAllFound) {
  const Scene scene = ladders(162, 36);
  for (const unsigned threads : {1u, 2u}) {
    const BlockMeetings blocks = decide_by_blocks(scene, 0, threads).blocks;
    EXPECT_EQ(blocks.oriented, nullptr);
    ASSERT_EQ(blocks.pairs.between.size(), kPairsPerBlock * 2 * 162);
    const std::vector<TrianglePair> expected = overlapping(scene, 0, true);
    EXPECT_GT(expected.size(), 162u);
    EXPECT_EQ(pairs_of_blocks(scene, blocks, 0, true, threads), expected);
  }
  // The twin: beyond it boxes along the axes are given up, and oriented ones tried.
  EXPECT_NE(decide_by_blocks(ladders(162, 37), 0, 1).blocks.oriented, nullptr);
}

// Boxes that touch in one point, edge or face, wherever they lie; or with a gap between them.
Scene touching(double at, double gap = 0) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (int n = 0; n < 40; ++n) {
    const Vec3 p(at + n, at, at);
    objects[0].push_back({p, p + Vec3(0.5, 0, 0.5), p + Vec3(0, 0.5, 0.5)});
    const Vec3 q = p + Vec3(0.5, n % 2 ? 0.5 : 0, (n % 3 ? 0.5 : 0) + gap);
    objects[1].push_back({q, q + Vec3(0.25, 0, 0.25), q + Vec3(0, 0.25, 0.25)});
  }
  return lab::scene_of(objects);
}

TEST(Blocks, CountBoxesThatTouch) {
  for (const double at : {0.0, 3.0, -1e3, 1e9, 1e15}) {
    const Scene scene = touching(at);
    const BlockMeetings blocks = decide_by_blocks(scene, 0, 1).blocks;
    ASSERT_FALSE(blocks.empty());
    const std::vector<TrianglePair> expected = overlapping(scene, 0, true);
    ASSERT_GE(expected.size(), 40u);
    on_every_target([&] { ASSERT_EQ(pairs_of_blocks(scene, blocks, 0, true, 1), expected) << at; });
  }
}

TEST(Blocks, GoBeyondWhatFloatHolds) {
  for (const double scale : {1e-320, 1e-50, 1e38, 1e60, 1e300}) {
    Scene scene = make_builtin_scene("two-spheres");
    for (Vec3& v : scene.vertices) v *= scale;
    const BlockMeetings blocks = along_axes(scene, 0);
    ASSERT_FALSE(blocks.empty()) << scale;
    EXPECT_EQ(pairs_of_blocks(scene, blocks, 0, true, 2), overlapping(scene, 0, true)) << scale;
  }
}

// Boxes that grow beyond the range of doubles are infinite, and still meet.
TEST(Blocks, GrowBeyondWhatDoubleHolds) {
  for (const double size : {1e300, 1e308}) {
    const Scene scene = lab::scene_of(
        {{{Vec3(-size, 0, 0), Vec3(-size, size, 0), Vec3(-size, 0, size)}},
         {{Vec3(-0.5 * size, 0, 0), Vec3(-0.5 * size, size, 0), Vec3(-0.5 * size, 0, size)},
          {Vec3(size, 0, 0), Vec3(size, size, 0), Vec3(size, 0, size)}}});
    for (const double clearance : {0.7 * size, 1.7e308}) {
      const BlockMeetings blocks = decide_by_blocks(scene, clearance, 1).blocks;
      ASSERT_FALSE(blocks.empty());
      const auto found = pairs_of_blocks(scene, blocks, clearance, true, 1);
      EXPECT_EQ(found, overlapping(scene, clearance, true)) << size << " and " << clearance;
      EXPECT_TRUE(std::ranges::count(found, TrianglePair{0, 1})) << size << " and " << clearance;
      EXPECT_EQ(lab::missed(scene, {.clearance = clearance}), 0u);
    }
  }
}

// Twins: what each ingredient is there for.
// Every triangle of a block lies in the block's box, also in the one of floats.
void expect_boxes_hold(const Scene& scene, const TriangleBlocks& blocks, double clearance) {
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    for (std::uint32_t k = 0; k < blocks.count(o); ++k) {
      const std::uint32_t at = blocks.first[o] + k;
      const FloatBox bound = blocks.bound(o, k);
      for (std::uint32_t i = 0; i < blocks.ranges[at].count; ++i) {
        const Box own = grown_box(scene, blocks.triangle(blocks.ranges[at].first + i), clearance);
        EXPECT_TRUE((own.lo.array() >= blocks.boxes[at].lo.array()).all());
        EXPECT_TRUE((own.hi.array() <= blocks.boxes[at].hi.array()).all());
        const FloatBox floats = relative(own, blocks.origin);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_GE(floats.lo[axis], bound.lo[axis]);
          EXPECT_LE(floats.hi[axis], bound.hi[axis]);
        }
      }
    }
  }
}

TEST(Blocks, FollowWhatMoved) {
  for (const double by : {0.001, 1.0, 1e6}) {
    for (const auto& [scattered, step] : {std::pair(false, 2), {true, 2}, {false, 1}, {true, 1}}) {
      Scene scene = make_builtin_scene("two-tori");
      if (scattered) scene = shuffled(scene, 7);
      TriangleBlocks blocks = make_ordered_blocks(scene, 0.01, 1);
      // Half of the blocks, of which every vertex moves; or all of them.
      std::vector<std::uint8_t> moved(blocks.ranges.size(), 0);
      std::set<std::uint32_t> vertices;
      for (std::size_t r = 0; r < blocks.ranges.size(); r += step) {
        for (std::uint32_t i = 0; i < blocks.ranges[r].count; ++i) {
          const auto& corners = scene.triangles[blocks.triangle(blocks.ranges[r].first + i)];
          vertices.insert(corners.begin(), corners.end());
        }
      }
      for (const std::uint32_t v : vertices) scene.vertices[v].x() += by;
      for (std::size_t r = 0; r < blocks.ranges.size(); ++r) {
        for (std::uint32_t i = 0; i < blocks.ranges[r].count; ++i)
          for (const std::uint32_t v : scene.triangles[blocks.triangle(blocks.ranges[r].first + i)])
            moved[r] = moved[r] || vertices.contains(v);
      }
      for (const unsigned threads : {1u, 2u}) {
        TriangleBlocks updated = blocks;
        update_boxes(scene, 0.01, moved, threads, updated);
        expect_boxes_hold(scene, updated, 0.01);
        // Where all move far, the origin goes with them, and all boxes are relative to it.
        EXPECT_EQ(updated.origin.x() > 1e5, by > 1e5 && step == 1);
      }
    }
  }
}

TEST(BlocksTwin, WithoutThePairsThatTouchInFloatsPairsAreLost) {
  const Scene scene = touching(0);
  const BlockMeetings blocks = decide_by_blocks(scene, 0, 1).blocks;
  std::vector<BlockLanes> lanes(blocks.of->ranges.size());
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    std::vector<std::uint32_t> triangles(blocks.of->ranges[k].count);
    std::iota(triangles.begin(), triangles.end(), blocks.of->ranges[k].first);
    fill_lanes(scene, triangles, 0, blocks.of->origin, lanes[k]);
  }
  std::vector<LanePair> pairs;
  for (const BlockPair& pair : blocks.pairs.between) pairs.push_back({pair.a, pair.b, false});
  BlockFindings found;
  compare_blocks({.first = lanes, .second = {}}, {}, {}, pairs, found);
  std::ranges::sort(found.pairs);
  EXPECT_GT(missed(overlapping(scene, 0, true), found.pairs), 0u);
}

TEST(BlocksTwin, ADroppedPairOfBlocksMisses) {
  const Scene scene = make_builtin_scene("two-spheres");
  const BlockMeetings blocks = decide_by_blocks(scene, 0, 1).blocks;
  ASSERT_FALSE(blocks.pairs.between.empty());
  const std::vector<TrianglePair> truth = truth_of(scene);
  const auto without = [&](std::size_t k) {
    BlockMeetings fewer = blocks;
    fewer.pairs.between.erase(fewer.pairs.between.begin() + static_cast<std::ptrdiff_t>(k));
    return missed(truth, pairs_of_blocks(scene, fewer, 0, true, 1));
  };
  std::size_t lost = 0;
  for (std::size_t k = 0; k < blocks.pairs.between.size(); ++k) lost += without(k);
  EXPECT_GT(lost, 0u);
}

TEST(BlocksTwin, BlocksThatAreNotGrownMissPairsOfAClearance) {
  const Scene scene = touching(0, 0.6);
  constexpr double kClearance = 0.7;
  const BlockMeetings plain = decide_by_blocks(scene, 0, 1).blocks;
  const BlockMeetings grown = decide_by_blocks(scene, kClearance, 1).blocks;
  const std::vector<TrianglePair> truth = truth_of(scene, kClearance);
  EXPECT_EQ(missed(truth, pairs_of_blocks(scene, grown, kClearance, true, 1)), 0u);
  EXPECT_GT(missed(truth, pairs_of_blocks(scene, plain, 0, true, 1)), 0u);
}

}  // namespace
}  // namespace farcull
