// Frames of a scene one after the other: what is kept from the last one changes no answer, whatever
// moved, and whatever happened in between. Each property has a twin that must fail.
#include "core/boxes/frames.h"

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::Random, lab::with_self;

double size_of(const Scene& scene) {
  Box box = Box::empty();
  for (const Vec3& v : scene.vertices) box.add(v);
  return (box.hi - box.lo).maxCoeff();
}

// Moves nothing, one vertex, a part of them, an object or all; a little or far.
void move(Random& random, Scene& scene) {
  const double by = size_of(scene) * (random.below(3) == 0 ? 0.2 : 0.005);
  const auto step = [&]() -> Vec3 {
    return by * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  };
  const int kind = random.below(5);
  if (kind == 1) scene.vertices[random.below(scene.vertices.size())] += step();
  if (kind == 2) {
    const std::size_t from = random.below(scene.vertices.size());
    const std::size_t to = std::min(from + 40, scene.vertices.size());
    for (std::size_t v = from; v < to; ++v) scene.vertices[v] += step();
  }
  if (kind == 3) {
    const Object& object = scene.objects[random.below(scene.objects.size())];
    const Vec3 all = step();
    std::set<std::uint32_t> own;
    for (std::uint32_t t = 0; t < object.triangle_count; ++t)
      for (const std::uint32_t v : scene.triangles[object.first_triangle + t]) own.insert(v);
    for (const std::uint32_t v : own) scene.vertices[v] += all;
  }
  if (kind == 4)
    for (Vec3& v : scene.vertices) v += 0.1 * step();
}

std::vector<Scene> scenes() {
  std::vector<Scene> out;
  for (const char* name : {"two-spheres", "crowd", "field:1000", "spheres:1000", "crumpled:1000",
                           "degenerate", "needles"}) {
    const Scene scene = make_builtin_scene(name);
    out.push_back(scene);
    out.push_back(with_self(lab::shuffled(scene, 1)));
  }
  return out;
}

// Frames of one scene with a memory, and what it did.
struct Film {
  FrameMemory memory;
  FrameDecider decider;
  std::size_t kept = 0, decided = 0, candidates = 0;

  // The candidates and collisions are those without a memory.
  void show(const Scene& scene, const BoxesSettings& settings) {
    memory.moved.update(scene);
    const BoxesPlan plan = plan_boxes(scene, settings, 2, &memory);
    const std::vector<TrianglePair> found = find_boxes(scene, plan, &memory).candidates;
    const BoxesResult fresh = find_boxes(scene, plan_boxes(scene, settings, 2));
    kept += plan.decision.blocks.kept.size();
    // Oriented boxes may leave more or fewer candidates in another order of triangles.
    const bool same = !memory.oriented && fresh.stage.reason != Reason::oriented_pairs &&
                      fresh.stage.reason != Reason::normal_pairs && !memory.normals;
    if (same) {
      ASSERT_EQ(found, fresh.candidates);
    }
    const ExactQuestion question{.clearance = settings.clearance,
                                 .neighbours = settings.neighbours};
    const Collisions expected = decide(scene, fresh.candidates, question);
    const Collisions collisions = decider.decide(scene, found, memory.moved, question);
    memory.moved.notify(mostly_unmoved(memory.moved, found));
    ASSERT_EQ(collisions.pairs, expected.pairs);
    ASSERT_EQ(collisions.neighbour_pairs, expected.neighbour_pairs);
    if (same) {
      ASSERT_EQ(collisions.neighbours, expected.neighbours);
      ASSERT_EQ(collisions.apart, expected.apart);
    }
    decided += decider.decided();
    candidates += found.size();
  }
};

TEST(FrameMemory, ChangesNoAnswerWhateverMoves) {
  std::size_t kept = 0, decided = 0, candidates = 0;
  Random random(11);
  for (Scene scene : scenes()) {
    for (const double clearance : {0.0, 0.01}) {
      SCOPED_TRACE(scene.name);
      Film film;
      for (int frame = 0; frame < 12; ++frame) {
        film.show(scene, {.clearance = clearance, .neighbours = clearance > 0});
        if (testing::Test::HasFatalFailure()) return;
        move(random, scene);
      }
      kept += film.kept, decided += film.decided, candidates += film.candidates;
    }
  }
  EXPECT_GT(kept, candidates / 8);  // much is kept indeed,
  EXPECT_LT(decided, 3 * candidates / 4);
  EXPECT_GT(decided, candidates / 10);  // and much is not
}

// A memory that was used for another scene, other settings, or a frame that was never found.
TEST(FrameMemory, IsNotMisledByWhatHappenedBetweenTwoFrames) {
  Random random(12);
  std::vector<Scene> all = scenes();
  Film film;
  std::size_t shown = 0;
  BoxesSettings settings;
  for (int frame = 0; more_cases(frame, trials(300, 60), film.kept > 1000); ++frame) {
    if (random.below(3) == 0) shown = random.below(3);
    Scene& scene = all[shown];
    const int kind = random.below(8);
    if (kind == 0) {  // planned, and not found
      if (random.below(2) == 0) film.memory.moved.update(scene);
      plan_boxes(scene, {}, 2, &film.memory);
    }
    if (kind == 1)  // found without a plan of the memory
      find_boxes(scene, plan_boxes(scene, {}, 1), &film.memory);
    if (kind == 2) scene.objects[0].self = !scene.objects[0].self;
    if (kind == 3) {  // other triangles on the same corners
      auto& triangles = scene.triangles;
      std::swap(triangles[random.below(triangles.size())][0],
                triangles[random.below(triangles.size())][1]);
    }
    if (kind > 3) move(random, scene);
    if (random.below(3) == 0) {
      settings.clearance = random.below(3) == 0 ? 0.02 : 0.0;
      settings.neighbours = random.below(3) != 0;
      settings.full = random.below(6) == 0;
    }
    if (random.below(4) == 0)  // all of these scenes have two objects
      settings.ignored =
          settings.ignored.empty() ? std::vector<ObjectPair>{{0, 1}} : std::vector<ObjectPair>{};
    film.show(scene, settings);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(FrameMemory, OfAFrameInWhichNothingMovedComparesAndDecidesNothing) {
  const Scene scene = with_self(make_builtin_scene("crumpled:4000"));
  FrameMemory memory;
  FrameDecider decider;
  for (int frame = 0; frame < 3; ++frame) {
    memory.moved.update(scene);
    const BoxesPlan plan = plan_boxes(scene, {}, 2, &memory);
    const auto found = find_boxes(scene, plan, &memory).candidates;
    decider.decide(scene, found, memory.moved);
    ASSERT_GT(found.size(), 1000u);
    EXPECT_EQ(plan.decision.blocks.pairs.size() > 0, frame == 0);
    EXPECT_EQ(decider.decided(), frame == 0 ? found.size() : 0);
  }
  // The same candidates under another clearance are decided again.
  const BoxesSettings wide{.clearance = 0.01};
  const auto candidates = find_boxes(scene, plan_boxes(scene, wide, 2)).candidates;
  std::set<std::size_t> sizes;
  for (const double clearance : {0.0, 0.01}) {
    memory.moved.update(scene);
    const ExactQuestion question{.clearance = clearance};
    const auto pairs = decider.decide(scene, candidates, memory.moved, question).pairs;
    EXPECT_EQ(pairs, decide(scene, candidates, question).pairs);
    sizes.insert(pairs.size());
  }
  EXPECT_EQ(sizes.size(), 2u);
}

// Little moves in a frame after the other, so that what is kept for long is right too.
TEST(FrameMemory, IsRightAfterManyFramesOfSmallMotions) {
  Random random(13);
  std::size_t kept = 0, candidates = 0;
  for (Scene scene : scenes()) {
    SCOPED_TRACE(scene.name);
    Film film;
    const double by = 0.01 * size_of(scene);
    for (int frame = 0; frame < 16; ++frame) {
      film.show(scene, {});
      if (testing::Test::HasFatalFailure()) return;
      for (Vec3& v : scene.vertices) {
        if (random.below(200) == 0)
          v += by * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      }
    }
    kept += film.kept, candidates += film.candidates;
  }
  EXPECT_GT(2 * kept, candidates);
}

// Whether a caller says what is new or the scenes are compared may change from frame to frame.
TEST(MovedCorners, AreThoseSinceTheFrameBeforeWhoeverFindsThem) {
  const Scene one = make_builtin_scene("two-spheres");
  Scene other = one;
  other.vertices[7].x() += 1e-3;
  MovedCorners moved;
  moved.update(one);
  moved.update(other);
  EXPECT_TRUE(moved.follows(1) && moved.any());
  const FrameChange back{.same = true, .vertices = {7}}, nothing{.same = true, .vertices = {}};
  moved.update(one, &back);
  EXPECT_TRUE(moved.follows(2) && moved.any());
  moved.update(other);  // compared with nothing: the copy is not of the frame before
  EXPECT_FALSE(moved.follows(3));
  moved.update(other, &nothing);
  EXPECT_TRUE(moved.follows(4) && !moved.any());
}

// Candidates of frames in which the first vertices move, one more in each; if `tells` is false, the
// memory is told that the last of them did not.
std::vector<TrianglePair> found_after_frames(Scene& scene, bool tells) {
  FrameMemory memory;
  MovedCorners& moved = memory.moved;
  std::vector<TrianglePair> out;
  for (std::size_t frame = 0; frame < 4; ++frame) {
    if (frame > 0) scene.vertices[frame].x() += 1e-3;
    const Scene told = scene;
    if (frame == 3)
      for (std::size_t v = 4; v < scene.vertices.size() / 2; v += 4) scene.vertices[v].x() += 0.1;
    moved.update(tells ? scene : told);
    const BoxesPlan plan = plan_boxes(scene, {}, 2, &memory);
    EXPECT_TRUE(frame != 2 || !plan.decision.blocks.kept.empty());
    out = find_boxes(scene, plan, &memory).candidates;
  }
  return out;
}

TEST(FrameMemoryTwin, ThatDoesNotSeeWhatMovedMisses) {
  for (const bool tells : {true, false}) {
    Scene scene = make_builtin_scene("two-spheres");
    const std::vector<TrianglePair> found = found_after_frames(scene, tells);
    EXPECT_EQ(lab::missed(lab::truth_of(scene), found) > 0, !tells);
  }
}

}  // namespace
}  // namespace farcull
