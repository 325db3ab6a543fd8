// A scene at which a property fails becomes a small file that says the same.
#include "tests/core/scene/minimize.h"

#include "experiments/scenes/scene_file.h"
#include "tests/core/scene/scenes.h"
#include "verify/exact.h"

namespace farcull {
namespace {

bool collides(const Scene& scene) {
  return !all_colliding_pairs(scene, {.threads = 1}).pairs.empty();
}

TEST(Minimize, LeavesTheTwoTrianglesThatMeet) {
  for (const std::uint64_t seed : seeds(3)) {
    const Scene scene = lab::random_scene(seed);
    if (!collides(scene)) continue;
    const Scene least = lab::minimized(scene, collides);
    EXPECT_EQ(least.triangles.size(), 2u) << seed;
    EXPECT_TRUE(collides(least)) << seed;
  }
  EXPECT_TRUE(collides(lab::random_scene(3))) << "there is something to minimize";
}

TEST(Minimize, WritesAFileWithTheSameDoubles) {
  const Scene least = lab::minimized(lab::random_scene(3), collides);
  const std::string path = lab::write_case("minimize-test", least, "views z resolution 8");
  const Scene read = parse_scene_file(
      "{\"objects\": [{\"mesh\": \"minimize-test.obj\", \"split\": \"groups\"}]}", path);
  ASSERT_EQ(read.triangles.size(), least.triangles.size());
  for (std::uint32_t t = 0; t < read.triangles.size(); ++t)
    EXPECT_EQ(read.corners(t), least.corners(t));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace farcull
