
#include <nlohmann/json.hpp>

#include "experiments/scenes/frames.h"
#include "tests/lab/moving.h"

namespace farcull {
namespace {

std::size_t files_in(const std::string& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

void expect_round_trip(const Scene& scene) {
  const ScratchFolder folder;
  const WrittenScene written = write_scene(scene, folder.path("s"));
  EXPECT_EQ(written.scene_file, folder.path("s/scene.json"));
  EXPECT_EQ(written.files, scene.objects.size() + 1);
  EXPECT_EQ(files_in(folder.path("s")), written.files);
  const Scene read = load_scene({written.scene_file});
  EXPECT_EQ(scene_hash(read), scene_hash(scene)) << scene.name;
  EXPECT_EQ(read.name, scene.name);
  ASSERT_EQ(read.objects.size(), scene.objects.size());
  for (std::size_t o = 0; o < read.objects.size(); ++o)
    EXPECT_EQ(read.objects[o].self, scene.objects[o].self);
  EXPECT_EQ(read.ignored, scene.ignored);
}

TEST(MeshWrite, ReadsBackAsItWas) {
  for (const char* name : {"two-tori", "random-soup", "degenerate", "ground@ground",
                           "far-apart@huge", "crowd:30:2@far@tiny"})
    expect_round_trip(make_builtin_scene(name));
  for (const std::string& name : lab::moving_scenes(false))
    expect_round_trip(make_builtin_scene(name));
}
TEST(PackagedScenes, ReadBackAsTheyWere) {
  expect_round_trip(make_builtin_scene("mannequin-devil"));
  expect_round_trip(make_builtin_scene("breaking-dragon:19994"));
}

// Every kind of double, vertices that are shared, unused and repeated, odd names, objects that
// collide with themselves.
TEST(MeshWrite, KeepsEveryBit) {
  Scene scene;
  scene.name = "odd";
  const double tiny = std::numeric_limits<double>::denorm_min();
  scene.vertices = {
      {0.1, -0.0, tiny},
      {1.0 / 3, std::nextafter(1.0, 2), -tiny},
      {std::numeric_limits<double>::max(), std::numeric_limits<double>::min(), 1e-300},
      {9, 9, 9},
      {std::nextafter(0.3, 0), 1e22, 123456789.123456789}};
  scene.triangles = {{0, 1, 2}, {2, 1, 4}, {4, 4, 4}, {0, 0, 1}};
  scene.source_face = {0, 1, 0, 0};
  scene.objects = {{"../a%04d b", 0, 2, true}, {"../a%04d b", 2, 1, false}, {"", 3, 1, true}};
  expect_round_trip(scene);
}

TEST(MeshWrite, WritesIgnoredObjectsByNamesThatNameThemAlone) {
  Scene scene = make_builtin_scene("crowd:4:2");
  scene.ignored = {{0, 1}, {0, 3}, {2, 3}};
  expect_round_trip(scene);
  // Twins: a name that another object has too, and one that is a pattern.
  for (const char* name : {"same", "*"}) {
    Scene twin = scene;
    twin.objects[0].name = name;
    twin.objects[2].name = "same";
    const ScratchFolder folder;
    EXPECT_TRUE(
        has_text(error_of([&] { write_scene(twin, folder.path("s")); }).reason, "others too"));
  }
}

TEST(MeshWrite, ReplacesFilesAndTakesItsOwnBackWhereItFails) {
  const ScratchFolder folder;
  const Scene scene = make_builtin_scene("two-tori");
  EXPECT_EQ(error_of([&] { write_scene(scene, folder.path("no/s")); }).where, folder.path("no/s"));
  const std::string file = folder.write("file", "x");
  EXPECT_EQ(error_of([&] { write_scene(scene, file); }).where, file);
  EXPECT_EQ(read_text(file), "x");

  // The second mesh cannot be written: the first one goes, or stays where one was before.
  const std::string place = folder.path("s");
  std::filesystem::create_directories(place + "/second.off");
  EXPECT_EQ(error_of([&] { write_scene(scene, place); }).where, place + "/second.off");
  EXPECT_EQ(files_in(place), 1u);
  folder.write("s/first.off", "old");
  EXPECT_THROW(write_scene(scene, place), Error);
  EXPECT_EQ(files_in(place), 2u);
  EXPECT_FALSE(std::filesystem::exists(place + "/scene.json"));
  std::filesystem::remove(place + "/second.off");
  write_scene(scene, place);
  EXPECT_EQ(scene_hash(load_scene({place + "/scene.json"})), scene_hash(scene));
  write_scene(make_builtin_scene("far-apart"), place);
  EXPECT_EQ(scene_hash(load_scene({place + "/scene.json"})),
            scene_hash(make_builtin_scene("far-apart")));
}

}  // namespace
}  // namespace farcull
