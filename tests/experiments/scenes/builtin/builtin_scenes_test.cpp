#include "experiments/scenes/builtin/scenes.h"

#include <Eigen/Geometry>

#include "tests/lab/process.h"
#include "verify/exact.h"

namespace farcull {
namespace {

std::size_t crossings(const Scene& scene) { return all_colliding_pairs(scene).pairs.size(); }

bool has_meshes() { return std::filesystem::exists(mesh_folder() + "/bunny00.off"); }

TEST(BuiltinScenes, AreWhatTheirEntrySays) {
  std::set<std::string> names;
  for (const BuiltinScene& entry : builtin_scenes()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.description.empty());
    EXPECT_TRUE(is_builtin_scene(entry.name));
    if (entry.needs_meshes) continue;
    const Scene scene = entry.make();
    EXPECT_EQ(scene.name, entry.name);
    EXPECT_EQ(scene.objects.size(), entry.objects) << entry.name;
    EXPECT_EQ(scene.triangles.size(), entry.triangles) << entry.name;
    EXPECT_NO_THROW(validate(scene, entry.name));
    EXPECT_EQ(scene_hash(scene), scene_hash(entry.make())) << entry.name << " differs from itself";
  }
  for (const std::string& name :
       listed("two-spheres,two-tori,random-soup,needles,degenerate,ground,crowd,far-apart,"
              "two-bunnies,armadillo-elephant,dragon-bunny,near-copy,bunnies-far-apart,"
              "needles-layers,needles-crossed,field,crumpled,spheres,cad-cut,funnel,"
              "mannequin-devil,armadillo,bunny,cylinders,torii,tree-leaves,shells,cloth,"
              "bunny-dragon,breaking-dragon,slivers,stack,mixed,gap"))
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(BuiltinScenes, CollideWhereTheirNameSaysSo) {
  for (const char* name : {"two-spheres", "two-tori", "random-soup", "needles", "crowd"})
    EXPECT_GT(crossings(make_builtin_scene(name)), 100u) << name;
  EXPECT_GT(crossings(make_builtin_scene("ground")), 20u);
  EXPECT_EQ(crossings(make_builtin_scene("far-apart")), 0u);
}

TEST(BuiltinScenes, DegenerateHoldsPointsSegmentsAndExactContacts) {
  const Scene scene = make_builtin_scene("degenerate");
  int points = 0, segments = 0, identical = 0;
  const std::uint32_t half = scene.objects[0].triangle_count;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const auto [a, b, c] = scene.corners(t);
    const bool flat = (b - a).cross(c - a).isZero(0);
    points += a == b && b == c;
    segments += flat && !(a == b && b == c);
    identical += t < half && scene.corners(t) == scene.corners(half + t);
  }
  EXPECT_GE(points, 15);
  EXPECT_GE(segments, 15);
  EXPECT_EQ(identical, 2);  // one triangle and one point, as they are; not lifted
}

TEST(BuiltinScenes, TakesASeedWhereItIsDrawn) {
  const auto hash = [](const char* name) { return scene_hash(make_builtin_scene(name)); };
  EXPECT_EQ(builtin_seed("needles:60@seed101"), 101u);
  EXPECT_EQ(builtin_seed("needles:60"), 2u);
  EXPECT_EQ(hash("needles:60@seed2"), hash("needles:60")) << "the seed that it has anyway";
  EXPECT_NE(hash("needles:60@seed101"), hash("needles:60"));
  EXPECT_EQ(hash("needles:60@seed101@far"), hash("needles:60@far@seed101"));
  EXPECT_THROW(make_builtin_scene("two-tori@seed3"), Error);
  for (const char* word : {"@seed3@seed4", "@seed", "@seed0", "@seed-1", "@seedx", "@seed1.5"})
    EXPECT_THROW(make_builtin_scene(std::string("needles:60") + word), Error) << word;
}

TEST(BuiltinScenes, FieldHasTheSizeOfItsNameAndKeepsItsDensity) {
  EXPECT_EQ(scene_hash(make_builtin_scene("field")), scene_hash(make_builtin_scene("field:10000")));
  for (const std::uint64_t size : {1000, 10'000, 100'000, 1'000'000}) {
    const std::string name = "field:" + std::to_string(size);
    const Scene scene = make_builtin_scene(name);
    EXPECT_EQ(scene.name, name);
    EXPECT_TRUE(builtin_seed(name));
    EXPECT_NEAR(static_cast<double>(scene.triangles.size()), static_cast<double>(size), 160);
    const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
    double filled = 0;  // of the boxes of the blobs, within the box of all
    for (const Box& box : boxes) filled += (box.hi - box.lo).prod();
    const Box all = bounds(scene);
    EXPECT_GT(filled / (all.hi - all.lo).prod(), 0.3) << name;
    EXPECT_LT(filled / (all.hi - all.lo).prod(), 1.0) << name;
  }
  EXPECT_GT(crossings(make_builtin_scene("field")), 100u);
}

TEST(BuiltinScenes, RefuseSizesThatAreNone) {
  for (const std::string& name :
       listed("field:,field:0,field:999,field:1e6,field:-1000,field:1000000001,"
              "field:99999999999999999999,field:5000x,field:5000:5000,crowd:1,crowd:,"
              "two-bunnies:1,two-tori:,crowd:400:,crowd:400:0,crowd:400:x,crowd:400:nan,"
              "crowd:400:inf,crowd:400:-1,crowd:400:0.2:1,crowd:400:0.2 ,crowd:400:0x1p-2,"
              "crowd::0.2,crowd:0.2,shells:3")) {
    EXPECT_TRUE(is_builtin_scene(name)) << name;
    EXPECT_EQ(error_of([&] { make_builtin_scene(name); }).where, name);
  }
  EXPECT_EQ(make_builtin_scene("field:2000@tiny").name, "field:2000@tiny");
  EXPECT_EQ(error_of([] { make_builtin_scene("field@tiny:2000"); }).where, "field@tiny:2000");
}

TEST(BuiltinScenes, RefuseUnknownNamesAndSuffixes) {
  EXPECT_FALSE(is_builtin_scene("two-sphere"));
  EXPECT_EQ(error_of([] { make_builtin_scene("two-sphere"); }).where, "two-sphere");
  for (const char* name : {"crowd@", "crowd@near", "crowd@far@", "crowd@@far", "crowd@fa"}) {
    const Error error = error_of([&] { make_builtin_scene(name); });
    EXPECT_EQ(error.where, name);
    EXPECT_TRUE(has_text(error.remedy, "@far, @tiny, @huge, @ground"));
  }
}

TEST(SceneSuffixes, MoveScaleAndGroundEveryScene) {
  const Scene scene = make_builtin_scene("crowd");
  const Box box = bounds(scene);

  const Scene far = make_builtin_scene("crowd@far");
  EXPECT_EQ(far.name, "crowd@far");
  const Vec3 step = centre(bounds(far)) - centre(box);
  EXPECT_NEAR(step.norm() / diagonal(box), 1e6, 1);
  EXPECT_NEAR(step.x(), step.z(), 1e-6);
  EXPECT_EQ(far.triangles, scene.triangles);

  const Scene tiny = make_builtin_scene("crowd@tiny");
  const Scene huge = make_builtin_scene("crowd@huge");
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    EXPECT_EQ(tiny.vertices[i], Vec3(scene.vertices[i] * 1e-6));
    EXPECT_EQ(huge.vertices[i], Vec3(scene.vertices[i] * 1e6));
  }

  const Scene ground = make_builtin_scene("crowd@ground");
  ASSERT_EQ(ground.objects.size(), scene.objects.size() + 1);
  EXPECT_EQ(ground.objects.back().name, "ground");
  EXPECT_EQ(ground.objects.back().triangle_count, 2u);
  const Box plane = object_boxes(ground, triangle_boxes(ground)).back();
  EXPECT_EQ(plane.lo.z(), plane.hi.z());
  EXPECT_EQ(plane.lo.z(), centre(box).z());
  EXPECT_NEAR(plane.hi.x() - plane.lo.x(), 1000 * diagonal(box), 1e-6);
  EXPECT_TRUE(overlap(plane, box));
  EXPECT_GT(crossings(ground), crossings(scene));

  EXPECT_EQ(make_builtin_scene("crowd@far@ground").objects.back().name, "ground");
}

TEST(SceneSuffixes, TransformedRefusesWhatNoDoubleHolds) {
  const Scene scene = make_builtin_scene("far-apart");
  EXPECT_EQ(error_of([&] { transformed(scene, 1e308, Vec3::Zero()); }).where, "far-apart");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error_of([&] { transformed(scene, 1, Vec3(0, infinity, 0)); }).where, "far-apart");
  std::string name = "far-apart";
  for (int i = 0; i < 60; ++i) name += "@huge";
  EXPECT_EQ(error_of([&] { make_builtin_scene(name); }).where, name);
}

TEST(PackagedScenes, SayHowToGetMissingMeshes) {
  const ScratchFolder folder;
  const SetVariable use("FARCULL_MESHES", folder.path("meshes"));
  for (const BuiltinScene& entry : builtin_scenes()) {
    if (!entry.needs_meshes) continue;
    const Error error = error_of([&] { make_builtin_scene(entry.name); });
    EXPECT_EQ(error.where.find(folder.path("meshes")), 0u);
    EXPECT_TRUE(has_text(error.remedy, "bash experiments/meshes.sh"));
  }
}

TEST(PackagedScenes, ComeFromTheFolderOfTheEnvironment) {
  const ScratchFolder folder;
  const SetVariable use("FARCULL_MESHES", folder.path("."));
  folder.write("bunny00.off", "OFF\n4 1 0\n-1 0 0\n3 0 0\n0 1 0\n100 100 100\n3 0 1 2\n");
  const Scene scene = make_builtin_scene("two-bunnies");
  // Half the extent along x is 2; the vertex that no triangle uses does not count.
  const double c = std::cos(0.7), s = std::sin(0.7);
  EXPECT_EQ(scene.vertices[4], Vec3(c * -1 + 2 * 0.02, s * -1 + 2 * 0.0026, 2 * 0.0014));
  const Scene apart = make_builtin_scene("bunnies-far-apart");
  const std::vector<Box> boxes = object_boxes(apart, triangle_boxes(apart));
  EXPECT_FALSE(overlap(boxes[0], boxes[1]));
}

TEST(PackagedScenes, AreWhatTheirEntrySays) {
  ASSERT_TRUE(has_meshes()) << "no packaged meshes; run bash experiments/meshes.sh";
  for (const BuiltinScene& entry : builtin_scenes()) {
    if (!entry.needs_meshes) continue;
    const Scene scene = entry.make();
    EXPECT_EQ(scene.name, entry.name);
    EXPECT_EQ(scene.objects.size(), entry.objects) << entry.name;
    EXPECT_EQ(scene.triangles.size(), entry.triangles) << entry.name;
    for (const Object& object : scene.objects)
      EXPECT_EQ(object.self, entry.objects == 1) << entry.name;
    if (entry.objects == 1 || entry.size) continue;
    const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
    EXPECT_EQ(overlap(boxes[0], boxes[1]), entry.name != "bunnies-far-apart") << entry.name;
    EXPECT_NEAR(diagonal(boxes[1]) / diagonal(boxes[0]), 1, 0.25) << entry.name;
  }
}

}  // namespace
}  // namespace farcull
