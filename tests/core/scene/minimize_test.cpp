// A scene at which a property fails becomes a small file that says the same.
#include "tests/lab/scenes.h"

#include "experiments/scenes/scene_file.h"
#include "verify/exact.h"

namespace farcull {
namespace {

bool collides(const Scene& scene) {
  return !all_colliding_pairs(scene, {.threads = 1}).pairs.empty();
}

// The first scene from this seed on in which triangles meet.
Scene colliding_scene(std::uint64_t seed) {
  while (!collides(lab::random_scene(seed))) ++seed;
  return lab::random_scene(seed);
}

TEST(Minimize, LeavesTheTwoTrianglesThatMeet) {
  for (const std::uint64_t seed : seeds(3)) {
    const Scene least = lab::minimized(colliding_scene(seed), collides);
    EXPECT_EQ(least.triangles.size(), 2u) << seed;
    EXPECT_TRUE(collides(least)) << seed;
  }
}

TEST(Minimize, WritesAFileWithTheSameDoubles) {
  const Scene least = lab::minimized(colliding_scene(3), collides);
  const std::string path = lab::write_case("minimize-test", least, "views z resolution 8");
  const Scene read = parse_scene_file(
      "{\"objects\": [{\"mesh\": \"minimize-test.obj\", \"split\": \"groups\"}]}", path);
  ASSERT_EQ(read.triangles.size(), 2u);
  for (std::uint32_t t = 0; t < read.triangles.size(); ++t)
    EXPECT_EQ(read.corners(t), least.corners(t));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace farcull
