// FAR pairs as a method of farcull run, and the library, on a GL device.
#include <nlohmann/json.hpp>

#include "experiments/library/farcull.h"
#include "experiments/measure/frames.h"
#include "experiments/method/run.h"
#include "experiments/record/output.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

RunOptions on(const std::string& device) {
  RunOptions options;
  options.method = Method::far_pairs;
  options.device = device;
  options.resolution = 100;  // views decide, on the CPU too
  return options;
}

TEST(GlRunPairs, GivesTheCandidatesOfTheCpuAndSaysWhatAnswered) {
  Session gl("software"), cpu("cpu");
  for (const char* name : {"two-spheres", "degenerate", "needles", "far-apart"}) {
    Scene scene = make_builtin_scene(name);
    for (const bool self : {false, true}) {
      for (Object& object : scene.objects) object.self = self;
      const Record there = run(scene, on("software"), gl);
      const Record here = run(scene, on("cpu"), cpu);
      EXPECT_EQ(there.found.pairs, here.found.pairs) << name;
      EXPECT_EQ(there.collisions.pairs, here.collisions.pairs) << name;
      EXPECT_EQ(there.collisions.neighbour_pairs, here.collisions.neighbour_pairs) << name;
      EXPECT_EQ(there.verification->false_negatives, 0u) << name;
      EXPECT_FALSE(there.found.device.cpu);
      if (!self && scene.name == "far-apart") {  // boxes decide: no device is needed
        EXPECT_FALSE(there.found.device.gl);
        continue;
      }
      ASSERT_TRUE(there.found.device.gl);
      EXPECT_EQ(there.found.device.gl->kind, "software");
      const nlohmann::ordered_json json = to_json(scene, there);
      EXPECT_EQ(json["device"]["renderer"], there.found.device.gl->renderer);
      EXPECT_EQ(json["device"]["reason"], "--device software");
    }
  }
}

TEST(GlRunPairs, WithoutADeviceTheRuleDecidesAndIsSaid) {
  Session session("");
  const Record record = run(make_builtin_scene("two-spheres"), on(""), session);
  EXPECT_TRUE(
      record.found.device.note.starts_with("no --device: GL where hardware answers, else the CPU"));
  EXPECT_EQ(record.found.device.cpu, !GlContext::hardware_listed() || !record.found.device.gl);
  if (record.found.device.gl) {
    EXPECT_EQ(record.found.device.gl->kind, "hardware");
  }
}

TEST(GlRunPairs, FarAndFarPairsShareAContext) {
  Session session("software");
  const Scene scene = make_builtin_scene("two-spheres");
  RunOptions far = on("software");
  far.method = Method::far;
  far.resolution = 64;
  const std::vector<TrianglePair> pairs = run(scene, far, session).collisions.pairs;
  EXPECT_EQ(run(scene, on("software"), session).collisions.pairs, pairs);
  EXPECT_EQ(run(scene, far, session).collisions.pairs, pairs);
  EXPECT_EQ(run(scene, on("software"), session).collisions.pairs, pairs);
}

TEST(GlRunPairs, FramesKeepOneBackend) {
  const FramesResult gl = run_frames({"two-spheres"}, {.options = on("software"), .range = {0, 4}});
  const FramesResult cpu = run_frames({"two-spheres"}, {.options = on("cpu"), .range = {0, 4}});
  double setup = HUGE_VAL;
  for (std::size_t k = 0; k < 5; ++k) {
    for (const char* key : {"hash", "candidate_pairs", "colliding_pairs"})
      EXPECT_EQ(gl.json["frames"][k][key], cpu.json["frames"][k][key]);
    EXPECT_EQ(gl.json["frames"][k]["verification"]["false_negatives"], 0);
    setup = std::min(setup, gl.json["frames"][k]["time_ms"]["setup"].get<double>());
  }
  EXPECT_LT(setup, 1.0);  // of the first frame it is longer, and of any on a busy machine
}

TEST(GlRunPairs, TheLibraryOnGl) {
  const Scene scene = make_builtin_scene("two-spheres");
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles, starts;
  for (const Vec3& p : scene.vertices) vertices.insert(vertices.end(), p.data(), p.data() + 3);
  for (const auto& t : scene.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  for (const Object& object : scene.objects) starts.push_back(object.first_triangle);
  const std::vector<Pair> pairs = Collider().find({vertices, triangles, starts}).pairs;
  EXPECT_FALSE(pairs.empty());
  Collider gl({.device = Device::gl});
  for (int repeat = 0; repeat < 2; ++repeat) {
    const Result found = gl.find({vertices, triangles, starts});
    EXPECT_EQ(found.pairs, pairs);
    EXPECT_NE(found.report.device, "cpu");
  }
}

// The twin of frames that miss nothing: plain CULLIDE at few pixels does, and is called to account
// where every method is held to the promise.
TEST(GlRunPairs, FramesOfAMethodThatMissesAreBroken) {
  FramesQuestion question;
  question.options.method = Method::cullide;
  question.options.resolution = 64;
  question.options.device = "software";
  question.range = {0, 3};
  EXPECT_EQ(run_frames({"two-spheres"}, question).broken, "");
  question.strict = true;
  const FramesResult strict = run_frames({"two-spheres"}, question);
  EXPECT_NE(strict.broken, "");
  EXPECT_GT(strict.json["summary"]["missed"].get<std::uint64_t>(), 0u);
}

}  // namespace
}  // namespace farcull
