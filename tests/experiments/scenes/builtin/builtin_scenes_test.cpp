#include "experiments/scenes/builtin/scenes.h"

#include <Eigen/Geometry>

#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/scene_file.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

// The sign of a volume that is far from 0, else 0.
int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double volume = (b - a).cross(c - a).dot(d - a);
  const double size = (b - a).norm() * (c - a).norm() * (d - a).norm();
  return std::abs(volume) < 1e-13 * size ? 0 : volume > 0 ? 1 : -1;
}

bool edge_crosses(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  if (side(t[0], t[1], t[2], p) * side(t[0], t[1], t[2], q) != -1) return false;
  const int s = side(p, q, t[0], t[1]);
  return s != 0 && side(p, q, t[1], t[2]) == s && side(p, q, t[2], t[0]) == s;
}

// Whether two triangles cross beyond doubt; touching and what rounding might decide do not count.
bool cross(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  for (std::size_t i = 0; i < 3; ++i)
    if (edge_crosses(a[i], a[(i + 1) % 3], b) || edge_crosses(b[i], b[(i + 1) % 3], a)) return true;
  return false;
}

int crossings(const Scene& scene) {
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<Box> of_objects = object_boxes(scene, boxes);
  int count = 0;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    for (std::size_t p = o + 1; p < scene.objects.size(); ++p) {
      const Box common = intersection(of_objects[o], of_objects[p]);
      if (common.is_empty()) continue;
      const Object& first = scene.objects[o];
      const Object& second = scene.objects[p];
      for (std::uint32_t i = first.first_triangle; i < first.first_triangle + first.triangle_count;
           ++i) {
        if (!overlap(boxes[i], common)) continue;
        for (std::uint32_t j = second.first_triangle;
             j < second.first_triangle + second.triangle_count; ++j)
          count += overlap(boxes[i], boxes[j]) && cross(scene.corners(i), scene.corners(j));
      }
    }
  }
  return count;
}

// Sets FARCULL_MESHES for one test.
class MeshFolder {
 public:
  explicit MeshFolder(const std::string& folder) {
    const char* const old = std::getenv("FARCULL_MESHES");
    if (old != nullptr) old_ = old;
    setenv("FARCULL_MESHES", folder.c_str(), 1);
  }
  ~MeshFolder() {
    if (old_.empty())
      unsetenv("FARCULL_MESHES");
    else
      setenv("FARCULL_MESHES", old_.c_str(), 1);
  }
  MeshFolder(const MeshFolder&) = delete;
  MeshFolder& operator=(const MeshFolder&) = delete;

 private:
  std::string old_;
};

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
  EXPECT_GT(crossings(make_builtin_scene("two-spheres")), 100);
  EXPECT_GT(crossings(make_builtin_scene("two-tori")), 100);
  EXPECT_GT(crossings(make_builtin_scene("random-soup")), 1000);
  EXPECT_GT(crossings(make_builtin_scene("needles")), 100);
  EXPECT_GT(crossings(make_builtin_scene("ground")), 20);
  const int crowd = crossings(make_builtin_scene("crowd"));
  EXPECT_GT(crowd, 50);
  EXPECT_LT(crowd, 20000);
  EXPECT_EQ(crossings(make_builtin_scene("far-apart")), 0);
}

TEST(BuiltinScenes, SoupAndNeedlesReachTheirExtremes) {
  const auto shortest_and_longest = [](const std::array<Vec3, 3>& t) {
    const double a = (t[1] - t[0]).norm();
    const double b = (t[2] - t[1]).norm();
    const double c = (t[0] - t[2]).norm();
    return std::pair(std::min({a, b, c}), std::max({a, b, c}));
  };
  const Scene soup = make_builtin_scene("random-soup");
  double least = 1e9, most = 0;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    const double size = shortest_and_longest(soup.corners(t)).second;
    least = std::min(least, size);
    most = std::max(most, size);
  }
  EXPECT_LT(least, 1e-3);
  EXPECT_GT(most, 1);
  const Scene needles = make_builtin_scene("needles");
  double aspect = 0;
  for (std::uint32_t t = 0; t < needles.triangles.size(); ++t) {
    const auto [a, b, c] = needles.corners(t);
    const double length = shortest_and_longest({a, b, c}).second;
    aspect = std::max(aspect, length * length / (b - a).cross(c - a).norm());
  }
  EXPECT_GT(aspect, 5e5);
  EXPECT_LT(aspect, 3e6);
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

TEST(BuiltinScenes, GroundIsAThousandTimesLargerThanItsBlobs) {
  const Scene scene = make_builtin_scene("ground");
  const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
  EXPECT_EQ(scene.objects.back().name, "ground");
  for (std::size_t i = 0; i + 1 < boxes.size(); ++i)
    EXPECT_GT(diagonal(boxes.back()), 1000 * diagonal(boxes[i]));
}

// What all needles of a bench scene have in common: one of few oblique directions, a length and a
// width; and that boxes are no help with them.
void expect_needles(const Scene& scene, std::size_t directions) {
  std::vector<Vec3> seen;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const auto [a, b, c] = scene.corners(t);
    const double length = (b - a).norm();
    const Vec3 along = (b - a) / length;
    ASSERT_NEAR(length, 4700, 1e-6);
    ASSERT_NEAR((b - a).cross(c - a).norm() / length, 0.002, 1e-6);
    ASSERT_GT(along.cwiseAbs().minCoeff(), 0.3) << "not oblique";
    const auto close = [&](const Vec3& d) { return (d - along).norm() < 3e-4; };
    if (std::ranges::none_of(seen, close)) seen.push_back(along);
  }
  EXPECT_EQ(seen.size(), directions);
  const std::vector<Box> boxes = triangle_boxes(scene);
  std::uint64_t looked = 0, overlapping = 0;
  const std::uint32_t second = scene.objects[1].first_triangle;
  for (std::uint32_t a = 0; a < second; a += 50)
    for (std::uint32_t b = second; b < boxes.size(); b += 50, ++looked)
      overlapping += overlap(boxes[a], boxes[b]);
  EXPECT_GT(overlapping, looked / 10);
}

TEST(BuiltinScenes, NeedlesOfBenchScenesAreObliqueAndTheirBoxesOverlap) {
  expect_needles(make_builtin_scene("needles-layers"), 1);
  expect_needles(make_builtin_scene("needles-crossed"), 2);
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
  const int collisions = crossings(make_builtin_scene("field"));
  EXPECT_GT(collisions, 100);
  EXPECT_LT(collisions, 5000);
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
  const MeshFolder use(folder.path("meshes"));
  for (const BuiltinScene& entry : builtin_scenes()) {
    if (!entry.needs_meshes) continue;
    const Error error = error_of([&] { make_builtin_scene(entry.name); });
    EXPECT_EQ(error.where.find(folder.path("meshes")), 0u);
    EXPECT_TRUE(has_text(error.remedy, "bash experiments/meshes.sh"));
  }
}

TEST(PackagedScenes, ComeFromTheFolderOfTheEnvironment) {
  const ScratchFolder folder;
  const MeshFolder use(folder.path("."));
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

TEST(PackagedScenes, TwoBunniesAreTheSceneFileOfTheManual) {
  ASSERT_TRUE(has_meshes()) << "no packaged meshes; run bash experiments/meshes.sh";
  const std::string bunny = mesh_folder() + "/bunny00.off";
  const Box box = bounds(load_mesh(bunny));
  const double half = (box.hi.x() - box.lo.x()) / 2;
  char step[200];
  std::snprintf(step, sizeof step, "[%.17g, %.17g, %.17g]", half * 0.02, half * 0.0026,
                half * 0.0014);
  const Scene scene = parse_scene_file(
      R"({"objects": [{"mesh": ")" + bunny + R"("}, {"mesh": ")" + bunny +
          R"(", "rotate": {"axis": [0, 0, 1], "angle": 0.7}, "translate": )" + step + "}]}",
      "/s.json");
  EXPECT_EQ(scene_hash(scene), scene_hash(make_builtin_scene("two-bunnies")));
}

TEST(PackagedScenes, NearCopyIsMovedByABillionthOfItsDiagonal) {
  ASSERT_TRUE(has_meshes()) << "no packaged meshes; run bash experiments/meshes.sh";
  const Scene scene = make_builtin_scene("near-copy");
  const std::size_t half = scene.vertices.size() / 2;
  const double length = diagonal(bounds(scene));
  for (std::size_t i = 0; i < half; ++i)
    ASSERT_NEAR((scene.vertices[half + i] - scene.vertices[i]).norm() / length, 1e-9, 1e-14);
}

}  // namespace
}  // namespace farcull
