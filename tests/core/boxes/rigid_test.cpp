// Objects that move as a whole: boxes that move with them contain all that moves, and the pairs are
// those of a scene in which everything was moved. Each property has a twin that must fail.
#include "core/boxes/rigid.h"

#include "core/boxes/oriented.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/motions.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::random_motion, lab::random_scene;

// The vertices of each object's own, so that objects may move apart.
Scene unshared(const Scene& scene) {
  Scene out = scene;
  out.vertices.clear();
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (std::uint32_t& v : out.triangles[t]) {
      out.vertices.push_back(scene.vertices[v]);
      v = static_cast<std::uint32_t>(out.vertices.size() - 1);
    }
  }
  return out;
}

Scene moved(const Scene& scene, const std::vector<RigidMotion>& motions) {
  Scene out = scene;
  const std::vector<std::uint32_t> owner = owners(scene);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const std::uint32_t v : scene.triangles[t])
      out.vertices[v] = moved(motions[owner[t]], scene.vertices[v]);
  }
  return out;
}

// The candidates of the moved scene, by moved boxes. All other vertices are NaNs, so that one that
// is read makes no pair.
std::optional<std::vector<TrianglePair>> pairs_by_motions(const Scene& scene,
                                                          const std::vector<RigidMotion>& motions,
                                                          const BoxesSettings& settings,
                                                          RigidBlocks& rigid, unsigned threads) {
  const auto decision =
      decide_by_motions(scene, motions, settings.clearance, settings.ignored, threads, rigid);
  if (!decision) return std::nullopt;
  EXPECT_TRUE(decision->blocks.moved);
  Scene some = scene;
  for (Vec3& v : some.vertices) v.setConstant(std::numeric_limits<double>::quiet_NaN());
  move_vertices(scene.vertices, motions, rigid, decision->blocks.pairs, threads, some);
  const BoxesPlan plan = plan_boxes(some, settings, threads, nullptr, &*decision);
  BoxesResult found = find_boxes(some, plan);
  EXPECT_EQ(found.stage.reason,
            decision->blocks.empty() ? Reason::no_boxes_overlap : Reason::moved_pairs);
  return std::move(found.candidates);
}

TEST(RigidBlocks, GiveThePairsOfTheMovedScene) {
  RandomNumbers random(test_seed(61));
  const int scenes = trials(200), frames = 12;
  std::size_t found = 0, given_up = 0, far = 0, of_two_heights = 0;
  for (int n = 0; n < scenes; ++n) {
    // The trees of blob and ground have different heights.
    const char* const name = std::array{"two-spheres", "crowd:40", "ground"}.at(n / 3 % 3);
    const Scene scene =
        unshared(n % 3 > 0 ? random_scene(test_seed(62) + static_cast<std::uint64_t>(n))
                           : make_builtin_scene(name));
    const unsigned threads = 1 + static_cast<unsigned>(n % 2);
    RigidBlocks rigid = make_rigid_blocks(scene, threads);
    for (int frame = 0; frame < frames; ++frame) {
      const int kind = random.below(lab::kMotionKinds);
      std::vector<RigidMotion> motions;
      for (std::size_t o = 0; o < scene.objects.size(); ++o)
        motions.push_back(random_motion(random, kind));
      BoxesSettings settings;
      if (kind != lab::kTinyMotion && random.below(2) > 0)
        settings.clearance = std::exp2(-random.between(1, 9));
      if (random.below(3) == 0) settings.ignored = {{0, 1}};
      const auto pairs = pairs_by_motions(scene, motions, settings, rigid, threads);
      if (!pairs) {
        ++given_up;
        continue;
      }
      settings.full = true;
      const auto expected = lab::pairs_by_boxes(moved(scene, motions), settings);
      ASSERT_EQ(*pairs, expected) << n << " " << frame << " kind " << kind;
      found += expected.size();
      far += kind == lab::kFarMotion && !expected.empty();
      if (rigid.trees.front().levels != rigid.trees.back().levels)
        of_two_heights += expected.size();
    }
  }
  EXPECT_GT(found, 10'000u);
  EXPECT_GT(far, 0u);
  EXPECT_GT(of_two_heights, 1'000u);
  EXPECT_LT(given_up, static_cast<std::size_t>(scenes * frames / 4));
}

// A tree in which one child of a node is missing. A scene of one pair per block would be needed to
// lose it always, so some of the children are enough.
TEST(RigidBlocksTwin, WithoutAChildPairsAreLost) {
  const Scene scene = unshared(make_builtin_scene("two-spheres"));
  const std::vector<RigidMotion> motions(2);
  RigidBlocks rigid = make_rigid_blocks(scene, 1);
  const std::size_t all = pairs_by_motions(scene, motions, {}, rigid, 1)->size();
  ASSERT_GT(all, 0u);
  std::size_t losing = 0;
  for (WideBoxes<double>& node : rigid.nodes) {
    for (std::size_t lane = 0; lane < kWide; ++lane) {
      const Box child = node.get(lane);
      node.set(lane, Box::empty());
      losing += pairs_by_motions(scene, motions, {}, rigid, 1)->size() < all;
      node.set(lane, child);
    }
  }
  EXPECT_GT(losing, 0u);
  EXPECT_EQ(pairs_by_motions(scene, motions, {}, rigid, 1)->size(), all);
}

TEST(RigidBlocks, LeaveWhatTheyCannotDecide) {
  const Scene scene = unshared(make_builtin_scene("two-spheres"));
  RigidBlocks rigid = make_rigid_blocks(scene, 1);
  std::vector<RigidMotion> motions(2);
  EXPECT_TRUE(pairs_by_motions(scene, motions, {}, rigid, 1));
  motions[1].r[4] = std::numeric_limits<double>::max();
  EXPECT_FALSE(pairs_by_motions(scene, motions, {}, rigid, 1));
  motions[1] = {.r = {0, 0, 0, 0, 0, 0, 0, 0, 0}, .t = {}};  // all triangles in one point
  motions[0] = motions[1];
  EXPECT_FALSE(pairs_by_motions(scene, motions, {}, rigid, 1));
  EXPECT_FALSE(pairs_by_motions(lab::with_self(scene), std::vector<RigidMotion>(2), {}, rigid, 1));
}

// ---- moved boxes

// A box as the middle and half of the sides move, grown by `roundings` times 2^-53 times the sum of
// the magnitudes: 0 is a bound that is too small, and moved() needs none.
Box moved_by_middle(const RigidMotion& motion, const Box& box, double roundings) {
  const Vec3 middle = 0.5 * box.lo + 0.5 * box.hi, half = 0.5 * box.hi - 0.5 * box.lo;
  Box out;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double* const row = motion.r.data() + 3 * axis;
    const double t = motion.t[static_cast<std::size_t>(axis)];
    double side = 0, magnitude = std::abs(t);
    for (Eigen::Index k = 0; k < 3; ++k) {
      side += std::abs(row[k]) * half[k];
      magnitude += std::abs(row[k]) * (std::abs(middle[k]) + half[k]);
    }
    side += roundings * 0x1p-53 * magnitude;
    const double at = moved_coordinate(row, middle.x(), middle.y(), middle.z(), t);
    out.lo[axis] = at - side;
    out.hi[axis] = at + side;
  }
  return out;
}

struct Losses {
  int vertices = 0;  // moved corners beyond the moved box
  int pairs = 0;     // corners that touch a point, whose boxes do not overlap
};

// Corners of random boxes, and points in them, which are moved. The moved corner is also a point of
// another object that rests, and touches it.
template <class MoveBox>
Losses losses(const MoveBox& move_box) {
  RandomNumbers random(test_seed(63));
  Losses out;
  for (int n = 0; n < trials(40'000); ++n) {
    const RigidMotion motion = random_motion(random, random.below(lab::kMotionKinds));
    Box box = Box::empty();
    std::array<Vec3, 3> points;
    for (Vec3& p : points) {
      p = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      box.add(p);
    }
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = (corner >> axis & 1) > 0 ? box.hi[axis] : box.lo[axis];
      const Vec3 at = moved(motion, p);
      const Box whole = move_box(motion, box);
      out.vertices += !overlap(whole, Box{at, at});
      // The box of a triangle that does not move: it begins at the corner and lies beyond it.
      Box other{at, at};
      other.add(Vec3(at + (at - 0.5 * whole.lo - 0.5 * whole.hi)));
      out.pairs += !overlap(whole, other);
    }
    for (const Vec3& p : points) {
      const Vec3 at = moved(motion, p);
      out.vertices += !overlap(move_box(motion, box), Box{at, at});
    }
  }
  return out;
}

TEST(RigidMotion, OfABoxContainsAllThatMoves) {
  const Losses none = losses([](const auto& motion, const Box& box) { return moved(motion, box); });
  EXPECT_EQ(none.vertices, 0);
  EXPECT_EQ(none.pairs, 0);
}

TEST(RigidMotionTwin, WithABoundOfRoundingThatIsTooSmallPairsAreLost) {
  const Losses lost =
      losses([](const auto& motion, const Box& box) { return moved_by_middle(motion, box, 0); });
  EXPECT_GT(lost.vertices, 100);
  EXPECT_GT(lost.pairs, 100);
  const Losses few =
      losses([](const auto& motion, const Box& box) { return moved_by_middle(motion, box, 0.5); });
  EXPECT_LT(few.vertices, lost.vertices);
}

}  // namespace
}  // namespace farcull
