// Files as people have them: forms that programs write although the formats do not quite say so,
// and corners that differ in the last digits.
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/scene_file.h"
#include "tests/lab/meshes.h"
#include "verify/exact.h"

namespace farcull {
namespace {

TEST(MeshHabits, AnUnusedVertexMayBeNoNumber) {
  const Mesh of_obj = obj("v 0 0 0\nv nan 1 inf\nv 1 0 0\nv 0 1 0\nf 1 3 4\n");
  const Mesh of_off = off("OFF\n4 1 0\n0 0 0\n1e999 0 0\n1 0 0\n0 1 0\n3 0 2 3\n");
  const Mesh of_ply = ply(kPlyHeader + "0 0 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 2 3\n");
  for (const Mesh* mesh : {&of_obj, &of_off, &of_ply}) {
    EXPECT_EQ(mesh->vertices.size(), 4u);
    EXPECT_EQ(mesh->vertices[1], Vec3(0, 0, 0));
    ASSERT_EQ(mesh->notes.size(), 1u);
    EXPECT_TRUE(has_text(mesh->notes[0], "1 vertex that is not finite and that no face uses"));
  }
}

TEST(MeshHabits, LinesMayEndWithCarriageReturns) {
  const Mesh mesh = obj("# a comment\rv 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 \\\r3\r");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(error_of([] { obj("v 0 0 0\rv 1 0 0\rf 1 2 9\r"); }).line, 3);
  EXPECT_EQ(off("OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r").triangles.size(), 1u);
}

TEST(MeshHabits, StatementsThatObjDoesNotHaveArePassedOver) {
  const Mesh mesh = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nt 0 0\nvw 1 2\nf 1 2 3\n");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0], "2 statements that OBJ does not have, 't' in line 4 first: passed over");
  EXPECT_TRUE(obj("v 0 0 0\nf 1 1 1\nvt 0 0\n").notes.empty());
  EXPECT_EQ(error_of([] { obj("this is no mesh\n"); }).line, 1);
}

TEST(MeshHabits, ACloudOfPointsIsCalledOne) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
      "z\n";
  for (const std::string& faces :
       {std::string(), std::string("element face 0\nproperty list uchar int vertex_indices\n")}) {
    const Error error = error_of([&] { ply(header + faces + "end_header\n0 0 0\n1 1 1\n"); });
    EXPECT_TRUE(has_text(error.reason, "is a cloud of 2 points"));
  }
}

std::string facet(double z) {
  return fmt::format(
      "facet normal 0 0 1 outer loop vertex 0 0 {0} vertex 1 0 {0} vertex 0 1 {0} endloop "
      "endfacet ",
      z);
}

TEST(MeshHabits, SolidsOfAnStlAreGroupsAndMayStandOnOneLine) {
  for (const std::string end : {" ", "\n"}) {
    const Mesh mesh =
        stl("solid a b" + end + facet(0) + "endsolid a b" + end + "solid" + end + facet(1) +
            "endsolid" + end + "solid c" + end + facet(2) + facet(3) + "endsolid");
    EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"a b", "solid 2", "c"}));
    EXPECT_EQ(mesh.group, (std::vector<std::uint32_t>{0, 1, 2, 2}));
  }
  EXPECT_EQ(stl("solid\n" + facet(0) + "endsolid\n").group_names,
            (std::vector<std::string>{"default"}));
  const ScratchFolder folder;
  folder.write("s.stl",
               "solid a\n" + facet(0) + "endsolid a\nsolid b\n" + facet(1) + "endsolid b\n");
  const std::string scene =
      folder.write("s.json", R"({"objects": [{"mesh": "s.stl", "split": "groups"}]})");
  EXPECT_EQ(load_scene({scene}).objects.at(1).name, "s/b");
}

// Exports of one program that were joined to one file have equal names.
TEST(MeshHabits, PartsWithOneNameAreSeveralObjects) {
  const Mesh solids = stl("solid a\n" + facet(0) + "endsolid a\nsolid a\n" + facet(0.5) +
                          "endsolid a\nsolid a#2\n" + facet(1) + "endsolid\n");
  EXPECT_EQ(solids.group_names, (std::vector<std::string>{"a", "a#2", "a#2#2"}));
  EXPECT_EQ(solids.group, (std::vector<std::uint32_t>{0, 1, 2}));
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f 1 2 3\n";
  const Mesh groups = obj(corners + "o A\ng x\n" + face + "g y\n" + face + "g x\n" + face +
                          "o B\ng x\n" + face + "o A\n" + face);
  EXPECT_EQ(groups.group_names, (std::vector<std::string>{"A", "x", "y", "B", "x#2"}));
  EXPECT_EQ(groups.group, (std::vector<std::uint32_t>{1, 2, 1, 4, 0}));
  EXPECT_TRUE(has_text(groups.notes.at(0), "object 'A' begins again in line 14"));
}

TEST(MeshHabits, AFileThatMixesEndsOfLinesIsRefused) {
  const std::string first = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const Error error =
      error_of([&] { obj(first + "# more\rv 0 0 1\rv 1 0 1\rv 0 1 1\rf 4 5 6\r"); });
  EXPECT_TRUE(has_text(error.reason, "ends with CR alone")) << error.what();
  EXPECT_EQ(error.line, 5);
  EXPECT_EQ(obj(first + "# more\r\r\nv 0 0 1\r").triangles.size(), 1u);
}

// Files of another format than their names say. Twins: a note where a file is an OBJ all the same,
// and the size where a binary STL file is cut.
TEST(MeshHabits, AFileThatIsNamedByAnotherFormatIsToldSo) {
  // It has lone CRs, and lines that end with LF.
  const std::string binary = binary_stl("part\rof\n\r", {{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  const auto said = [](const std::string& bytes) {
    const Error error = error_of([&] { obj(bytes); });
    EXPECT_FALSE(has_text(error.remedy, "tr ")) << error.what();
    return error.reason + "; " + error.remedy;
  };
  EXPECT_EQ(said("solid a\n" + kFacet + "endsolid a\n"),
            "looks like a .stl file, not OBJ; rename it");
  EXPECT_EQ(said(binary), "looks like a .stl file, not OBJ; rename it");
  EXPECT_EQ(said(binary_ply(false)), "looks like a .ply file, not OBJ; rename it");
  EXPECT_EQ(said(kOff), "looks like a .off file, not OBJ; rename it");
  EXPECT_TRUE(has_text(said(binary + "more"), "NUL bytes"));
  EXPECT_EQ(obj("off\n" + kThree + "f 1 2 3\n").notes.size(), 1u);

  std::string long_obj;
  for (int k = 0; k < 9; ++k) long_obj += kThree;
  const auto of_stl = [](const std::string& bytes) { return error_of([&] { stl(bytes); }).reason; };
  EXPECT_TRUE(has_text(of_stl(long_obj + "f 1 2 3\n"), "is text that does not begin with 'solid'"));
  EXPECT_TRUE(has_text(of_stl(binary + "more"), "promises 1 triangles"));
}

// Two triangles whose common edge is written twice, and differs in the last digits.
constexpr const char* kNearlyJoined =
    "v 0 0 0\nv 1 0 0\nv 0 -1 0\nv 0 0 1e-17\nv 1 0 -1e-17\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";

TEST(Weld, JoinsWhatDiffersInTheLastDigits) {
  const auto scene_of = [](const Mesh& mesh) {
    SceneBuilder builder("m", "m");
    builder.add(mesh, "m", Split::kNone, {}, true);
    return builder.finish();
  };
  Mesh mesh = obj(kNearlyJoined);
  EXPECT_EQ(all_colliding_pairs(scene_of(mesh)).pairs.size(), 1u);
  Mesh twin = mesh;
  EXPECT_EQ(weld(twin, parse_weld("1e-18")), 0u);  // too little
  EXPECT_EQ(all_colliding_pairs(scene_of(twin)).pairs.size(), 1u);
  for (const char* tolerance : {"1e-17", "1e-7*size", "0.1"}) {
    Mesh welded = mesh;
    EXPECT_EQ(weld(welded, parse_weld(tolerance)), 2u);
    EXPECT_EQ(welded.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 5}}));
    const ExactResult found = all_colliding_pairs(scene_of(welded));
    EXPECT_TRUE(found.pairs.empty() && found.neighbour_pairs.empty());
  }
  for (const char* bad : {"", "-1", "nan", "inf", "1e-7*", "size", "1e-7*diagonal"})
    EXPECT_EQ(error_of([&] { parse_weld(bad); }).where, "--weld") << bad;
}

// Against every pair of vertices: none that is kept is within the tolerance of one kept before it,
// and each other one went to the nearest.
TEST(Weld, GivesEachVertexTheNearestThatIsKept) {
  RandomNumbers random(5);
  for (const double tolerance : {0.0, 0.05, 0.3}) {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    for (std::uint32_t k = 0; k < 300; ++k) {
      points.emplace_back(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      if (k % 7 == 3) points.back() = points[k / 2];
      triangles.push_back({k, k, k});
    }
    Mesh mesh = shapes::finished(points, triangles);
    weld(mesh, {.value = tolerance});
    std::vector<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      std::uint32_t best = v;
      for (const std::uint32_t k : kept) {
        const double d = (points[v] - points[k]).norm();
        if (d <= tolerance && (best == v || d < (points[v] - points[best]).norm())) best = k;
      }
      EXPECT_EQ(mesh.triangles[v][0], best) << v;
      if (best == v) kept.push_back(v);
    }
    EXPECT_LT(kept.size(), points.size());
  }
}

// The points are as far apart as the tolerance once their distance is rounded, and lie on either
// side of 0, where a cell of a grid ends.
TEST(Weld, RoundingAtTheBorderOfACellHidesNoPoint) {
  Mesh mesh;
  mesh.vertices = {{-1e-20, 0, 0}, {0.1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(weld(mesh, {.value = 0.1}), 1u);
}

TEST(Weld, HintNamesATolerancThatCloses) {
  Mesh mesh = shapes::sphere(2);
  std::vector<Vec3> points;  // every triangle has its own corners, which differ by rounding
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      points.push_back(mesh.vertices[v] * (1 + 1e-12 * static_cast<double>(points.size() % 3)));
    }
    const auto last = static_cast<std::uint32_t>(points.size());
    triangles.push_back({last - 3, last - 2, last - 1});
  }
  Mesh apart = shapes::finished(points, triangles);
  SceneBuilder builder("m", "m");
  builder.add(apart, "apart");
  builder.add(mesh, "closed");
  triangles.pop_back();
  builder.add(shapes::finished(points, triangles), "with a hole");
  const Scene scene = builder.finish();
  const std::optional<WeldHint> hint = weld_hint(scene, scene.objects[0]);
  ASSERT_TRUE(hint);
  EXPECT_GT(hint->open_edges, 100u);
  EXPECT_LT(hint->tolerance, 1e-9);
  EXPECT_GT(weld(apart, {.value = hint->tolerance, .relative = true}), 0u);
  SceneBuilder again("m", "m");
  again.add(apart, "welded");
  const Scene welded = again.finish();
  EXPECT_FALSE(weld_hint(welded, welded.objects[0]));
  // The twins: what is closed, and what no welding closes.
  EXPECT_FALSE(weld_hint(scene, scene.objects[1]));
  EXPECT_FALSE(weld_hint(scene, scene.objects[2]));
}

TEST(SceneFile, TakesAMatrixAndAQuaternion) {
  const ScratchFolder folder;
  folder.write("t.obj", "v 1 0 0\nv 0 1 0\nv 0 0 -0.0\nf 1 2 3\n");
  const auto placed = [&](const std::string& how) {
    return load_scene({folder.write("s.json", "{\"objects\": [{\"mesh\": \"t.obj\"" + how + "}]}")})
        .vertices;
  };
  const std::vector<Vec3> expected = {{5, 1, 0}, {4, 0, 0}, {5, 0, 0}};  // a quarter turn about z
  EXPECT_EQ(placed(", \"matrix\": [[0,-1,0,5],[1,0,0,0],[0,0,1,0],[0,0,0,1]]"), expected);
  const std::vector<Vec3> turned =
      placed(", \"rotate\": {\"quaternion\": [0, 0, 3, 3]}, \"translate\": [5, 0, 0]");
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((turned[k] - expected[k]).norm(), 1e-15);
  // The same with names, in any order; the twin takes the array with its real part first.
  EXPECT_EQ(placed(", \"rotate\": {\"quaternion\": {\"w\": 3, \"x\": 0, \"z\": 3, \"y\": 0}}, "
                   "\"translate\": [5, 0, 0]"),
            turned);
  EXPECT_NE(placed(", \"rotate\": {\"quaternion\": [2, 1, 0, 3]}"),
            placed(", \"rotate\": {\"quaternion\": {\"w\": 2, \"x\": 1, \"y\": 0, \"z\": 3}}"));
  for (const char* identity : {", \"matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]",
                               ", \"rotate\": {\"quaternion\": [0, 0, 0, -2]}"})
    EXPECT_TRUE(std::signbit(placed(identity)[2].z()));
  for (const char* bad :
       {", \"matrix\": [1,0,0,0]", ", \"matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]",
        ", \"matrix\": [[0,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]",
        ", \"scale\": 1, \"matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]",
        ", \"rotate\": {\"quaternion\": [0, 0, 0, 0]}", ", \"rotate\": {\"quaternion\": [0, 0, 1]}",
        ", \"rotate\": {\"quaternion\": {\"w\": 1, \"x\": 0, \"y\": 0}}",
        ", \"rotate\": {\"quaternion\": {\"w\": 1, \"x\": 0, \"y\": 0, \"z\": 0, \"u\": 0}}",
        ", \"rotate\": {\"quaternion\": [0, 0, 0, 1], \"angle\": 1}"})
    EXPECT_TRUE(has_text(error_of([&] { placed(bad); }).reason, "objects[0].")) << bad;
}

}  // namespace
}  // namespace farcull
