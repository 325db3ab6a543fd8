// Oriented boxes of blocks: no colliding pair is lost, on every instruction set and whatever the
// order of the triangles, and slivers leave few pairs. Each property has a twin that must fail.
#include "core/boxes/oriented.h"

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/lanes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::missed, lab::random_scene, lab::truth_of, lab::with_self;

// All pairs of blocks of a scene whose oriented boxes may meet.
BlockPairs block_pairs(const Scene& scene, const OrientedBlocks& blocks) {
  BlockPairs out;
  const auto n = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t a = 0; a < n; ++a) {
    const std::uint32_t first = blocks.blocks.first[a], end = first + blocks.blocks.count(a);
    for (std::uint32_t b = a; b < n; ++b) {
      if (a == b && !scene.objects[a].self) continue;
      pair_oriented(blocks, a, b, first, end, SIZE_MAX, a == b ? out.inside : out.between);
    }
  }
  return out;
}

std::shared_ptr<const OrientedBlocks> oriented(const Scene& scene, double clearance) {
  return make_oriented(scene, clearance, make_blocks(scene, clearance, 1).objects, 2);
}

std::vector<TrianglePair> pairs_of(const Scene& scene, const OrientedBlocks& blocks,
                                   double clearance, bool neighbours = true) {
  return sorted_pairs(2, [&](const TakePairs& take) {
    return give_pairs_of_oriented(scene, blocks, block_pairs(scene, blocks), clearance, neighbours,
                                  2, take);
  });
}

std::vector<Scene> some_scenes() {
  std::vector<Scene> out;
  for (const char* name :
       {"cad-cut:2000", "cad-cut:3000", "needles", "crowd", "cad-cut:2000@far"}) {
    out.push_back(make_builtin_scene(name));
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    out.push_back(seed % 2 ? with_self(random_scene(seed)) : random_scene(seed));
  return out;
}

TEST(Oriented, LoseNoPairThatCollides) {
  std::size_t found = 0;
  for (const Scene& scene : some_scenes()) {
    SCOPED_TRACE(scene.name);
    for (const double clearance : {0.0, 0.003}) {
      const auto blocks = oriented(scene, clearance);
      if (!blocks) continue;
      const std::vector<TrianglePair> truth = truth_of(scene, clearance);
      const std::vector<TrianglePair> pairs = pairs_of(scene, *blocks, clearance);
      EXPECT_EQ(missed(truth, pairs), 0u);
      for (const TrianglePair& pair : pairs)
        ASSERT_TRUE(boxes_meet(scene, pair, half_of(clearance)));
      found += truth.size();
      on_every_target([&] { EXPECT_EQ(pairs_of(scene, *blocks, clearance), pairs); });
    }
  }
  EXPECT_GT(found, 5000u);
}

// Two objects of triangles whose tips are the same vertices, so that the boxes of two touch there.
// Each object is tested against itself as well.
Scene sharing_tips(std::uint32_t count) {
  Scene scene;
  lab::Random random(5);
  std::vector<std::array<std::uint32_t, 3>> above;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vec3 tip(random.unit(), random.unit(), random.unit());
    for (const Vec3& to :
         {Vec3(0, 0, 0), Vec3(-1, -2, -3), Vec3(-2, -1, -1), Vec3(1, 2, 3), Vec3(2, 1, 1)}) {
      scene.vertices.push_back(tip + 1e-3 * to);
    }
    scene.triangles.push_back({5 * k, 5 * k + 1, 5 * k + 2});
    above.push_back({5 * k, 5 * k + 3, 5 * k + 4});
  }
  scene.triangles.insert(scene.triangles.end(), above.begin(), above.end());
  scene.source_face.resize(2 * count);
  for (const std::uint32_t first : {0u, count})
    scene.objects.push_back(
        {.name = {}, .first_triangle = first, .triangle_count = count, .self = true});
  return scene;
}

// Neighbours that are left out are those of one object: others may share a vertex index and count.
TEST(Oriented, LeaveOutNoPairOfDifferentObjectsThatShareAVertex) {
  for (const std::uint32_t count : {20u, 2000u}) {
    const Scene scene = sharing_tips(count);
    const std::vector<TrianglePair> truth = all_colliding_pairs(scene, {}).pairs;
    EXPECT_GE(truth.size(), count);
    const auto blocks = oriented(scene, 0);
    ASSERT_NE(blocks, nullptr);
    EXPECT_EQ(missed(truth, pairs_of(scene, *blocks, 0, false)), 0u);
  }
}

TEST(Oriented, DecideAPartThatIsCut) {
  const Scene scene = make_builtin_scene("cad-cut:4000");
  const BlockMeetings blocks = decide_by_blocks(scene, 0, 2).blocks;
  ASSERT_NE(blocks.oriented, nullptr);
  const std::vector<TrianglePair> pairs = pairs_of_blocks(scene, blocks, 0, true, 2);
  EXPECT_EQ(missed(truth_of(scene), pairs), 0u);
  EXPECT_LT(pairs.size(), 16 * scene.triangles.size());
  EXPECT_EQ(pairs_of_boxes(scene, {}, true, 2), std::nullopt) << "boxes along the axes alone";
  EXPECT_GT(all_colliding_pairs(scene).box_pairs, 10 * pairs.size());
}

TEST(Oriented, AreNotMadeOfCoordinatesThatFloatsCannotHold) {
  for (const double scale : {0x1p70, 0x1p-80}) {
    const Scene scene = transformed(make_builtin_scene("cad-cut:2000"), scale, Vec3::Zero());
    EXPECT_EQ(oriented(scene, 0), nullptr);
    EXPECT_NE(oriented(transformed(scene, 1 / scale, Vec3::Zero()), 0), nullptr);
  }
}

// The boxes of triangles as they are without a margin.
std::shared_ptr<OrientedBlocks> without_margin(const OrientedBlocks& blocks) {
  auto out = std::make_shared<OrientedBlocks>(blocks);
  for (OrientedLanes& lanes : out->lanes) {
    for (std::size_t lane = 0; lane < kWide; ++lane) {
      FloatBox box = kNowhere;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& d = lanes.frame[k];
        for (const auto& c : lanes.corner) {
          const float at = d[0] * c[0][lane] + d[1] * c[1][lane] + d[2] * c[2][lane];
          box.lo[k] = std::min(box.lo[k], at);
          box.hi[k] = std::max(box.hi[k], at);
        }
      }
      lanes.boxes.set(lane, box);
    }
  }
  return out;
}

TEST(OrientedTwin, WithoutAMarginPairsThatTouchAreLost) {
  const Scene scene = lab::standing(400, 1);
  const std::vector<TrianglePair> truth = truth_of(scene);
  ASSERT_GE(truth.size(), 400u);
  const auto blocks = oriented(scene, 0);
  EXPECT_EQ(missed(truth, pairs_of(scene, *blocks, 0)), 0u);
  EXPECT_GT(missed(truth, pairs_of(scene, *without_margin(*blocks), 0)), 0u);
}

TEST(OrientedTwin, BlocksThatAreNotGrownMissPairsOfAClearance) {
  const Scene scene = make_builtin_scene("cad-cut:2000");
  constexpr double kClearance = 0.01;
  const std::vector<TrianglePair> truth = truth_of(scene, kClearance);
  EXPECT_EQ(missed(truth, pairs_of(scene, *oriented(scene, kClearance), kClearance)), 0u);
  EXPECT_GT(missed(truth, pairs_of(scene, *oriented(scene, 0), kClearance)), 0u);
}

TEST(OrientedTwin, BoxesOfHalfTheirSizeMiss) {
  const Scene scene = make_builtin_scene("cad-cut:4000");
  const auto blocks = oriented(scene, 0);
  const std::vector<TrianglePair> truth = truth_of(scene);
  const auto with = [&](auto&& change) {
    OrientedBlocks smaller = *blocks;
    change(smaller);
    return missed(truth, pairs_of(scene, smaller, 0));
  };
  EXPECT_EQ(with([](OrientedBlocks&) {}), 0u);
  const auto halve = [](std::array<std::array<float, kWide>, 3>& half) {
    for (auto& column : half)
      for (float& side : column) side *= 0.5f;
  };
  EXPECT_GT(with([&](OrientedBlocks& b) {
              for (WideOriented& node : b.nodes) halve(node.half);
            }),
            0u);
}

}  // namespace
}  // namespace farcull
