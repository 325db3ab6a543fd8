// The scene cache of the lab.
#include "experiments/measure/harness.h"

#include <gtest/gtest.h>

#include "experiments/scenes/builtin/scenes.h"

namespace farcull {
namespace {

TEST(Lab, ReadsAMotionAnewWhereItHasOtherFrames) {
  Lab lab("cpu");
  const auto hash = [&](long frames) { return scene_hash(lab.scene("crowd:30", 1, frames)); };
  const std::string of4 = hash(4), of12 = hash(12);
  EXPECT_EQ(hash(4), of4);
  Lab fresh("cpu");
  EXPECT_EQ(scene_hash(fresh.scene("crowd:30", 1, 12)), of12);
  EXPECT_NE(of4, of12) << "else it would not matter";
}

TEST(Lab, TheTruthIsWithoutWhatTheSceneIgnores) {
  Lab lab("cpu");
  Scene scene = make_builtin_scene("two-tori");
  lab.scene("whole", [&] { return scene; });
  EXPECT_GT(lab.truth().pairs.size(), 0u);
  scene.ignored = {{0, 1}};
  lab.scene("ignored", [&] { return scene; });
  EXPECT_EQ(lab.truth().pairs.size(), 0u);
}

}  // namespace
}  // namespace farcull
