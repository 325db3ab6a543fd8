// Built-in scenes in motion on a GL device: FAR pairs in all frames, FAR with both offsets in some.
#include "core/gl/pairs/pairs.h"
#include "experiments/measure/frames.h"
#include "experiments/method/run.h"
#include "tests/lab/gl.h"
#include "tests/lab/moving.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::kFrames;

std::vector<std::string> all_scenes() {
  std::vector<std::string> names = lab::moving_scenes(false);
  for (const std::string& name : lab::moving_scenes(true)) names.push_back(name);
  return names;
}

TEST(GlMovingScenes, FarPairsMissNothingInAnyFrame) {
  for (const std::string& name : all_scenes()) {
    SCOPED_TRACE(name);
    FramesQuestion question;
    question.options.method = Method::far_pairs;
    question.range = {lab::first_frame(name), lab::first_frame(name) + kFrames - 1};
    question.pairs = true;
    question.options.device = "software";
    const FramesResult gl = run_frames({name}, question);
    question.options.device = "cpu";
    const FramesResult cpu = run_frames({name}, question);
    EXPECT_EQ(gl.json["summary"]["missed"], 0);
    EXPECT_EQ(gl.pairs_csv, cpu.pairs_csv);
    for (std::size_t k = 0; k < static_cast<std::size_t>(kFrames); ++k) {
      // On the CPU boxes of runs may decide, which keep no fewer pairs than views.
      EXPECT_LE(gl.json["frames"][k]["candidate_pairs"], cpu.json["frames"][k]["candidate_pairs"]);
    }
  }
}

// Missed pairs of some frames of every scene in which no object is tested against itself.
std::uint64_t missed_in(const RunOptions& options, const std::vector<long>& frames) {
  Session session("software");
  std::uint64_t missed = 0, colliding = 0;
  for (const std::string& name : all_scenes()) {
    MovingScene moving(name, kFrames);
    for (const long frame : frames) {
      const Scene& scene = moving.at(frame);
      if (has_self(scene)) continue;
      const Record record = run(scene, options, session);
      missed += record.verification->false_negatives;
      colliding += record.collisions.pairs.size() + record.verification->false_negatives;
    }
  }
  EXPECT_GT(colliding, 1000u);
  return missed;
}

TEST(GlMovingScenes, FarMissesNothingWithEitherOffset) {
  for (const char* offset : {"obb", "exact"}) {
    RunOptions options{.method = Method::far};
    options.device = "software";
    options.resolution = 48;
    options.offset = offset;
    EXPECT_EQ(missed_in(options, {1, 4}), 0u) << offset;
  }
}

// The twin: CULLIDE on the same frames does miss.
TEST(GlMovingScenes, CullideMissesOnTheSameFrames) {
  RunOptions options;
  options.method = Method::cullide;
  options.device = "software";
  options.resolution = 48;
  EXPECT_GT(missed_in(options, {4}), 100u);
}

TEST(GlMovingScenes, ChangedTopologyIsSeen) {
  GlPairs gl(lab::context());
  lab::Reconnected reconnected;
  for (long frame = 0; frame < 15; ++frame) {
    const Scene& scene = reconnected.at(frame);
    EXPECT_EQ(lab::missed(scene, {.blocks = false}, gl), 0u) << frame;
    EXPECT_EQ(find_pairs(scene, {.blocks = false}, gl).candidates,
              find_pairs(scene, {.blocks = false}, *cpu_pair_backend(2)).candidates);
  }
  MovingScene dragon("breaking-dragon:19994", kFrames);
  for (const long frame : {1L, 2L, 7L, 3L, 0L, 4L})
    EXPECT_EQ(lab::missed(dragon.at(frame), {.blocks = false}, gl), 0u) << frame;
}

// The twin.
TEST(GlMovingScenes, StaleTopologyIsCaught) {
  GlPairs gl(lab::context());
  lab::Stale stale(gl);
  lab::Reconnected reconnected;
  EXPECT_EQ(lab::missed(reconnected.at(0), {.blocks = false}, stale), 0u);
  for (long frame = 1; frame < 6; ++frame)
    EXPECT_GT(lab::missed(reconnected.at(frame), {.blocks = false}, stale), 0u) << frame;
}

}  // namespace
}  // namespace farcull
