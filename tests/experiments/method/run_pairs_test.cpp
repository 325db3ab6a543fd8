// The method boxes as farcull run has it.
#include "experiments/measure/compare.h"
#include "experiments/record/output.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"
#include "tests/lab/runs.h"

namespace farcull {
namespace {

using lab::on_cpu, lab::run;

Scene self_scene(const std::string& name) { return lab::with_self(make_builtin_scene(name)); }

/// One object: 0 and 1 share an edge and lie on one side of it in one plane, so they are neighbours
/// that collide; 2 crosses both.
Scene folded() {
  Scene scene;
  scene.name = "folded";
  scene.vertices = {{0, 0, 0},      {1, 0, 0},     {0, 1, 0},    {0.5, 0.5, 0},
                    {0.3, 0.2, -1}, {0.3, 0.2, 1}, {0.4, 0.2, 1}};
  scene.triangles = {{0, 1, 2}, {0, 1, 3}, {4, 5, 6}};
  scene.source_face = {0, 1, 2};
  scene.objects = {{"folded", 0, 3, true}};
  return scene;
}

void expect_as_exact(const Scene& scene, double clearance = 0) {
  const Record pairs = run(scene, on_cpu(Method::boxes, clearance));
  const Record exact = run(scene, on_cpu(Method::exact, clearance));
  EXPECT_EQ(pairs.collisions.pairs, exact.collisions.pairs) << scene.name;
  EXPECT_EQ(pairs.collisions.neighbour_pairs, exact.collisions.neighbour_pairs) << scene.name;
  for (const Record* record : {&pairs, &exact}) {
    ASSERT_TRUE(record->verification);
    EXPECT_TRUE(record->verification->adds_up());
    EXPECT_EQ(record->verification->false_negatives, 0u) << scene.name;
    EXPECT_FALSE(broken(*record, true));
  }
  EXPECT_TRUE(pairs.promise.holds);
  EXPECT_FALSE(pairs.found.device.cpu || pairs.found.device.gl);
  EXPECT_TRUE(pairs.found.streamed || pairs.found.count == pairs.found.pairs.size());
}

TEST(RunPairs, GivesTheExactPairs) {
  for (const char* name : {"two-spheres", "degenerate", "needles", "random-soup", "crowd",
                           "far-apart", "two-spheres@ground"})
    expect_as_exact(make_builtin_scene(name));
  expect_as_exact(folded());
  for (const char* name : {"degenerate", "needles", "random-soup"})
    expect_as_exact(self_scene(name));
  expect_as_exact(make_builtin_scene("needles"), 0.02);
  expect_as_exact(self_scene("degenerate"), 0.25);
}

TEST(Session, DropsWhatItKeptOfTheLastFrameAfterAFailure) {
  Session session("cpu");
  session.remember_frames();
  const Scene scene = self_scene("crumpled:2000");
  run(scene, on_cpu(Method::boxes), session);
  EXPECT_EQ(session.frame_memory()->frame, 1u);
  session.forget_device();
  ASSERT_TRUE(session.frame_memory());
  EXPECT_FALSE(session.frame_memory()->frame);
  EXPECT_EQ(session.frame_memory()->moved.frame(), 0u);
}

// A crumpled sheet and another one across it, each with one vertex far away, which makes most of
// its box empty: a tree over all boxes decides.
Scene strays() {
  const Scene sheet = self_scene("crumpled:6000");
  Scene scene;
  scene.name = "strays";
  for (std::uint32_t o = 0; o < 2; ++o) {
    const auto before = static_cast<std::uint32_t>(scene.vertices.size());
    Object object = sheet.objects[0];
    object.name += std::to_string(o);
    object.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    ++object.triangle_count;
    for (const Vec3& p : sheet.vertices) scene.vertices.push_back(p + Vec3(0.1 * o, 0, 0));
    for (auto triangle : sheet.triangles) {
      for (std::uint32_t& corner : triangle) corner += before;
      scene.triangles.push_back(triangle);
    }
    scene.vertices.push_back(Vec3(1e6, 1e6, 1e6 + o));
    scene.triangles.push_back(
        {before, before + 1, static_cast<std::uint32_t>(scene.vertices.size() - 1)});
    scene.objects.push_back(object);
  }
  scene.source_face.resize(scene.triangles.size(), 0);
  return scene;
}

// Its pairs are decided as they are found, and only a limit asks for their list.
TEST(RunPairs, DecidesThePairsOfATreeAsTheyAreFound) {
  const Scene scene = strays();
  for (const std::vector<ObjectPair>& ignored :
       {std::vector<ObjectPair>(), std::vector<ObjectPair>{{0, 1}}}) {
    const auto asked = [&](Method method) {
      RunOptions options = on_cpu(method);
      options.ignored = ignored;
      return options;
    };
    const Record exact = run(scene, asked(Method::exact));
    EXPECT_GT(exact.collisions.pairs.size(), 100u);
    const Record record = run(scene, asked(Method::boxes));
    EXPECT_TRUE(record.found.streamed);
    EXPECT_TRUE(record.found.pairs.empty());
    EXPECT_EQ(record.found.count, exact.found.count);
    EXPECT_EQ(record.decided, record.found.count);
    EXPECT_EQ(record.found.triangles.size(), record.found.triangle_count);
    EXPECT_EQ(record.collisions.pairs, exact.collisions.pairs);
    EXPECT_EQ(record.collisions.neighbour_pairs, exact.collisions.neighbour_pairs);
    EXPECT_EQ(record.collisions.neighbours, exact.collisions.neighbours);
    ASSERT_TRUE(record.verification);
    EXPECT_TRUE(record.verification->adds_up());
    EXPECT_FALSE(broken(record, true));
    // The twin: the accounting notices an answer that lost one of its pairs.
    Collisions lost = record.collisions;
    lost.pairs.pop_back();
    EXPECT_EQ(account(scene, lost.all(), {.ignored = ignored}).false_negatives, 1u);
    RunOptions first = asked(Method::boxes);
    first.limit = 3;
    const Record some = run(scene, first);
    EXPECT_FALSE(some.found.streamed);
    EXPECT_FALSE(some.limited) << "no crowd: all candidates are listed";
    EXPECT_EQ(some.found.count, record.found.count);
    EXPECT_EQ(some.found.triangles, record.found.triangles);
    const std::vector<TrianglePair> all = exact.collisions.all();
    EXPECT_EQ(some.collisions.all(), std::vector(all.begin(), all.begin() + 3));
    Session session("cpu");
    const Record alone = run(scene, asked(Method::boxes), session, {},
                             {.answer_only = true, .decide_neighbours = false});
    EXPECT_EQ(alone.collisions.pairs, exact.collisions.pairs);
    EXPECT_TRUE(alone.collisions.neighbour_pairs.empty());
    EXPECT_EQ(alone.collisions.neighbours, exact.collisions.neighbours);
  }
}

// Where blocks decide a whole scene, along the axes or by oriented boxes, their pairs are decided
// as they are found. The accounting, a limit and frames that follow one another ask for their list.
TEST(RunPairs, DecidesThePairsOfBlocksAsTheyAreFound) {
  for (const Scene& scene :
       {self_scene("crumpled:6000"), self_scene("needles"), make_builtin_scene("spheres:6000"),
        make_builtin_scene("cad-cut:4000")}) {
    RunOptions options = on_cpu(Method::boxes);
    const Record listed = run(scene, options);
    EXPECT_FALSE(listed.found.streamed);
    ASSERT_TRUE(listed.verification);
    const Record exact = run(scene, on_cpu(Method::exact));
    options.verify = false;
    for (const unsigned threads : {1u, 3u}) {
      Session session("cpu", threads);
      const Record given = run(scene, options, session);
      EXPECT_TRUE(given.found.streamed) << scene.name;
      EXPECT_TRUE(given.found.pairs.empty());
      EXPECT_EQ(given.found.count, listed.found.count);
      EXPECT_EQ(given.decided, listed.found.pairs.size());
      EXPECT_EQ(given.found.triangles, listed.found.triangles);
      EXPECT_EQ(given.found.object_count, listed.found.object_count);
      EXPECT_EQ(given.collisions.pairs, exact.collisions.pairs);
      EXPECT_EQ(given.collisions.neighbour_pairs, exact.collisions.neighbour_pairs);
      EXPECT_EQ(given.collisions.neighbours, listed.collisions.neighbours);
      for (const StageKind kind : {StageKind::blocks, StageKind::exact}) {
        const auto of_kind = [&](const Stage& stage) { return stage.kind == kind; };
        const auto one = std::ranges::find_if(given.trace, of_kind);
        const auto other = std::ranges::find_if(listed.trace, of_kind);
        ASSERT_TRUE(one != given.trace.end() && other != listed.trace.end());
        EXPECT_EQ(one->in, other->in);
        EXPECT_EQ(one->out, other->out);
      }
    }
    options.limit = 3;
    EXPECT_FALSE(run(scene, options).found.streamed);
    options.limit = 0;
    Session frames("cpu");
    frames.remember_frames();
    EXPECT_FALSE(run(scene, options, frames).found.streamed);
  }
}

// 3,000 equal triangles have 4.5 million pairs, more than a run with a limit lists.
TEST(RunPairs, ALimitEndsTheSearchInACrowd) {
  Scene scene;
  scene.name = "crowd";
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.triangles.assign(3000, {0, 1, 2});
  scene.source_face.resize(3000);
  scene.objects.push_back({.name = "o", .first_triangle = 0, .triangle_count = 3000, .self = true});
  RunOptions options = on_cpu(Method::boxes);
  options.limit = 5;
  const Record record = run(scene, options);
  EXPECT_TRUE(record.limited);
  EXPECT_FALSE(record.complete);
  EXPECT_FALSE(record.verification);
  EXPECT_EQ(record.trace.back().reason, Reason::limited);
  EXPECT_LT(record.decided, 100000u);
  EXPECT_EQ(record.collisions.all(),
            (std::vector<TrianglePair>{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}));
  // The twin: fewer pairs are listed and accounted for.
  scene.triangles.resize(100);
  scene.source_face.resize(100);
  scene.objects[0].triangle_count = 100;
  const Record listed = run(scene, options);
  EXPECT_FALSE(listed.limited);
  EXPECT_TRUE(listed.verification);
  EXPECT_EQ(listed.collisions.all(), record.collisions.all());
}

// The twin: a receiver that loses a part of what it is given loses pairs that collide.
TEST(RunPairs, ALostPartOfGivenPairsIsMissed) {
  const Scene scene = self_scene("crumpled:6000");
  const BoxesPlan planned = plan_boxes(scene, {});
  for (const bool loses : {false, true}) {
    std::mutex mutex;
    std::vector<TrianglePair> kept;
    const BoxesResult result =
        find_boxes(scene, planned, nullptr, {}, [&](std::vector<TrianglePair>& some) {
          const std::scoped_lock lock(mutex);
          if (loses) some.resize(some.size() / 2);
          kept.insert(kept.end(), some.begin(), some.end());
        });
    ASSERT_TRUE(result.streamed);
    std::ranges::sort(kept);
    EXPECT_EQ(account(scene, kept).false_negatives > 0, loses);
  }
}

// The twin: what the accounting is told was kept, without one of the pairs that collide.
TEST(RunPairs, ALostCandidateIsABrokenGuarantee) {
  for (const bool neighbour : {false, true}) {
    const Scene scene = folded();
    Record record = run(scene, on_cpu(Method::boxes));
    const auto& collide = neighbour ? record.collisions.neighbour_pairs : record.collisions.pairs;
    ASSERT_FALSE(collide.empty());
    std::erase(record.found.pairs, collide[collide.size() / 2]);
    record.verification = account(scene, record.found.pairs);
    EXPECT_EQ(record.verification->false_negatives, 1u);
    EXPECT_TRUE(broken(record, false));
  }
}

// The other twin: candidates of a smaller clearance miss pairs of a larger one.
TEST(RunPairs, CandidatesWithoutTheClearanceMissItsPairs) {
  const Scene scene = make_builtin_scene("needles");
  const Record plain = run(scene, on_cpu(Method::boxes));
  EXPECT_GT(account(scene, plain.found.pairs, {.clearance = 0.02}).false_negatives, 0u);
}

}  // namespace
}  // namespace farcull
