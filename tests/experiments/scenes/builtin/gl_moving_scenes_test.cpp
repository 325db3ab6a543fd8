// Built-in scenes in motion on a GL device: FAR with both offsets in some frames.
#include "experiments/measure/frames.h"
#include "tests/lab/gl.h"
#include "tests/lab/moving.h"

namespace farcull {
namespace {

using lab::kFrames;

// Missed pairs of some frames of every scene in which no object is tested against itself.
std::uint64_t missed_in(const RunOptions& options, const std::vector<long>& frames) {
  Session session("software");
  std::uint64_t missed = 0, colliding = 0;
  for (const bool of_packaged_meshes : {false, true}) {
    for (const std::string& name : lab::moving_scenes(of_packaged_meshes)) {
      MovingScene moving(name, kFrames);
      for (const long frame : frames) {
        const Scene& scene = moving.at(frame);
        if (has_self(scene)) continue;
        const Record record = run(scene, options, session);
        missed += record.verification->false_negatives;
        colliding += record.collisions.pairs.size() + record.verification->false_negatives;
      }
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

// Frames of plain CULLIDE at few pixels are called to account where every method is held to the
// promise.
TEST(GlFrames, FramesOfAMethodThatMissesAreBroken) {
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
