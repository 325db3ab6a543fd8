#include "experiments/scenes/scene_file.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

const std::string kTriangle = "v 1 2 3\nv -0.0 0.1 0\nv 0 1e-300 7\nf 1 2 3\n";
// Two components whose faces alternate, in two groups that cut across them.
const std::string kParts =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 0 0 1\n"
    "g left\nf 1 2 3\nf 4 5 6\ng right\nf 4 6 5\nf 2 3 7\n";

bool same_bits(const Vec3& a, const Vec3& b) {
  for (int i = 0; i < 3; ++i)
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  return true;
}

class SceneFileTest : public testing::Test {
 protected:
  SceneFileTest() {
    folder.write("t.obj", kTriangle);
    folder.write("parts.obj", kParts);
    path = folder.path("scene.json");
  }

  Scene read(const std::string& text) const { return parse_scene_file(text, path); }
  // A scene of one object with more keys than its mesh.
  Scene with(const std::string& keys) const {
    return read(R"({"objects": [{"mesh": "t.obj", )" + keys + "}]}");
  }
  void expect_refusal(const std::string& text, const std::string& reason, long line = 0) const {
    const Error error = error_of([&] { read(text); });
    EXPECT_EQ(error.where, path);
    EXPECT_EQ(error.line, line) << error.what();
    EXPECT_TRUE(has_text(error.reason, reason)) << text << "\n" << error.what();
  }
  void expect_refused_key(const std::string& keys, const std::string& reason) const {
    expect_refusal(R"({"objects": [{"mesh": "t.obj"}, {"mesh": "t.obj", )" + keys + "}]}",
                   "objects[1]." + reason);
  }

  ScratchFolder folder;
  std::string path;
};

TEST_F(SceneFileTest, ReadsTheFormOfTheManual) {
  const Scene scene = read(
      R"({"name": "s", "objects": [{"name": "a", "mesh": "t.obj"}, {"mesh": "t.obj", "scale": 2,
          "rotate": {"axis": [0, 0, 2], "angle": 0.7},
          "translate": [1, 0, 0], "split": "none"}]})");
  EXPECT_EQ(scene.name, "s");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "a");
  EXPECT_EQ(scene.objects[1].name, "t");
  EXPECT_EQ(scene.objects[1].first_triangle, 1u);
  // Scale, then rotate, then translate.
  const double c = std::cos(0.7), s = std::sin(0.7);
  EXPECT_TRUE(same_bits(scene.vertices[3], Vec3(c * 2 - s * 4 + 1, s * 2 + c * 4, 6)));
}

TEST_F(SceneFileTest, SelfBelongsToTheObjectAndToItsParts) {
  const Scene scene = read(
      R"({"objects": [{"mesh": "t.obj"}, {"mesh": "t.obj", "self": true},
          {"mesh": "t.obj", "self": false},
          {"mesh": "parts.obj", "split": "groups", "self": true}]})");
  ASSERT_EQ(scene.objects.size(), 5u);
  const std::vector<bool> expected = {false, true, false, true, true};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(scene.objects[i].self, expected[i]) << i;
}

TEST_F(SceneFileTest, LeavesEveryBitAloneWithoutATransform) {
  const Mesh mesh = load_mesh(folder.path("t.obj"));
  for (const std::string keys :
       {R"("split": "none")", R"("scale": 1)", R"("scale": [1, 1, 1], "translate": [0, 0, 0])",
        R"("rotate": {"axis": [1, 2, 3], "angle": 0})", R"("translate": [-0.0, 0, 0])"}) {
    const Scene scene = with(keys);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_TRUE(same_bits(scene.vertices[i], mesh.vertices[i])) << keys;
  }
  EXPECT_TRUE(std::signbit(with(R"("scale": 1)").vertices[1].x()));
}

TEST_F(SceneFileTest, ScalesByNumberByAxisAndByMirror) {
  EXPECT_EQ(with(R"("scale": -2)").vertices[0], Vec3(-2, -4, -6));
  EXPECT_EQ(with(R"("scale": [1, -1, 0.5])").vertices[0], Vec3(1, -2, 1.5));
  // Mirrored, sheared and tiny.
  EXPECT_EQ(with(R"("matrix": [[1, 1, 0, 0], [0, -1, 0, 0], [0, 0, 1e-300, 0], [0, 0, 0, 1]])")
                .vertices[0],
            Vec3(3, -2, 3e-300));
}

TEST_F(SceneFileTest, RotatesAboutAxesOfAnyLength) {
  for (const std::string axis :
       {"[1, 1, 1]", "[1e-200, 1e-200, 1e-200]", "[1e300, 1e300, 1e300]"}) {
    // A third of a turn about the diagonal permutes the coordinates.
    const Scene scene = with(R"("rotate": {"axis": )" + axis + R"(, "angle": 2.0943951023931953})");
    EXPECT_LT((scene.vertices[0] - Vec3(3, 1, 2)).norm(), 1e-14) << axis;
  }
}

TEST_F(SceneFileTest, SplitsIntoGroupsInFileOrder) {
  const Scene scene = read(R"({"objects": [{"mesh": "parts.obj", "split": "groups"}]})");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "parts/left");
  EXPECT_EQ(scene.objects[1].name, "parts/right");
  EXPECT_EQ(scene.source_face, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST_F(SceneFileTest, SplitsIntoComponentsByFirstTriangle) {
  const Scene scene = read(R"({"objects": [{"mesh": "parts.obj", "split": "components"}]})");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "parts/1");
  EXPECT_EQ(scene.objects[1].name, "parts/2");
  EXPECT_EQ(scene.objects[0].triangle_count, 2u);
  EXPECT_EQ(scene.source_face, (std::vector<std::uint32_t>{0, 3, 1, 2}));
  EXPECT_EQ(scene.triangles[1], (std::array<std::uint32_t, 3>{1, 2, 6}));
}

TEST_F(SceneFileTest, KeepsTheNameWhereASplitGivesOnePart) {
  for (const std::string split : {"groups", "components"})
    EXPECT_EQ(with(R"("split": ")" + split + "\"").objects.at(0).name, "t");
}

TEST_F(SceneFileTest, NumbersRepeatedNamesAndSkipsTakenOnes) {
  const Scene scene = read(
      R"({"objects": [{"mesh": "t.obj"}, {"mesh": "t.obj", "name": "t#2"}, {"mesh": "t.obj"},
                      {"mesh": "t.obj"}]})");
  std::vector<std::string> names;
  for (const Object& object : scene.objects) names.push_back(object.name);
  EXPECT_EQ(names, (std::vector<std::string>{"t", "t#2", "t#3", "t#4"}));
  EXPECT_EQ(scene.name, "scene");
  // A name that was made up is taken too.
  EXPECT_EQ(read(R"({"objects": [{"mesh": "t.obj"}, {"mesh": "t.obj"},
                                 {"mesh": "t.obj", "name": "t#2"}]})")
                .objects[2]
                .name,
            "t#2#2");
}

TEST_F(SceneFileTest, FindsMeshesBesideTheSceneFileOrByAbsolutePath) {
  std::filesystem::create_directory(folder.path("sub"));
  const std::string sub = folder.write("sub/s.json", R"({"objects": [{"mesh": "../t.obj"}]})");
  EXPECT_EQ(load_scene({sub}).objects.size(), 1u);
  EXPECT_EQ(read(R"({"objects": [{"mesh": ")" + folder.path("t.obj") + R"("}]})").objects.size(),
            1u);
}

TEST_F(SceneFileTest, ReadsEachMeshOnce) {
  // A mesh of a megabyte or so, thousands of times: reading it each time would take minutes.
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (int i = 0; i < 100000; ++i) text += "vn 0 0 1.0\n";
  folder.write("long.obj", text);
  std::string list;
  for (int i = 0; i < 5000; ++i) list += std::string(i ? "," : "") + R"({"mesh": "./long.obj"})";
  const std::clock_t start = std::clock();
  EXPECT_EQ(read("{\"objects\": [" + list + "]}").objects.size(), 5000u);
  EXPECT_LT(std::clock() - start, 5 * CLOCKS_PER_SEC);
}

TEST_F(SceneFileTest, RefusesBadSyntaxWithItsLine) {
  expect_refusal("", "empty");
  expect_refusal("{\n\"objects\": [\n}", "unexpected '}'", 3);
  expect_refusal("{\"objects\": [\n", "unexpected end", 2);
  expect_refusal("{\n\n\"name\": \"a\n\"}", "control character", 3);
  expect_refusal("{\n\"objects\": [{\"scale\": 1e999}]}", "1e999", 2);
  expect_refusal("{\n\"objects\": [{\"scale\": NaN}]}", "invalid literal", 2);
  expect_refusal("{\"name\":\n\n\"\xff\"}", "UTF-8", 3);
  expect_refusal("{} {}", "unexpected '{'", 1);
  expect_refusal(std::string("\x7f"
                             "ELF\0\0",
                             6),
                 "invalid literal", 1);
  // The parser and the destructor of a deep value must not overflow the stack.
  expect_refusal(std::string(1000000, '['), "unexpected end", 1);
}

TEST_F(SceneFileTest, RefusesWrongFormWithItsPlace) {
  expect_refusal("[]", "must be a JSON object");
  expect_refusal("{}", "objects is missing");
  expect_refusal(R"({"objects": []})", "objects is empty");
  expect_refusal(R"({"objects": {}})", "objects must be an array");
  expect_refusal(R"({"objects": [1]})", "objects[0] must be a JSON object");
  expect_refusal(R"({"objects": [{}]})", "objects[0].mesh is missing");
  expect_refusal(R"({"objects": [{"mesh": 3}]})", "objects[0].mesh is of type number");
  expect_refusal(R"({"objects": [{"mesh": ""}]})", "objects[0].mesh is empty");
  expect_refusal(R"({"name": 1, "objects": [{"mesh": "t.obj"}]})", "name is of type number");
  expect_refusal(R"({"Objects": []})", "Objects is an unknown key");
  expect_refusal(R"({"objects": [{"mesh": "t.obj", "mesh": "parts.obj"}]})", "'mesh' occurs twice");
  expect_refusal(R"({"objects": [{"mesh": "t.obj", "scale": 1e308}]})", "beyond what a double can");
}

TEST_F(SceneFileTest, RefusesWrongValuesWithTheirPlace) {
  expect_refused_key(R"("colour": 1)", "colour is an unknown key");
  expect_refused_key(R"("name": null)", "name is of type null");
  expect_refused_key(R"("scale": 0)", "scale is 0");
  expect_refused_key(R"("scale": [1, -0.0, 1])", "scale is 0");
  expect_refused_key(R"("scale": "2")", "scale must be a number or an array");
  const auto matrix = [](const std::string& rows) {
    return R"("matrix": [)" + rows + ", [0, 0, 0, 1]]";
  };
  // Of rank 0, 1 and 2, the last two but for rounding.
  for (const char* rows : {"[0, 0, 0, 1], [0, 0, 0, 2], [0, 0, 0, 3]",
                           "[0.1, 0.2, 0.3, 0], [0.3, 0.6, 0.9, 0], [0.7, 1.4, 2.1, 0]",
                           "[0.1, 0.2, 0.3, 0], [0.4, 0.5, 0.6, 0], [0.7, 0.8, 0.9, 0]"})
    expect_refused_key(matrix(rows), "matrix has no inverse");
  expect_refused_key(R"("scale": [1, 2])", "scale must be an array of 3");
  expect_refused_key(R"("scale": [1, 2, null])", "scale[2] is of type null");
  expect_refused_key(R"("rotate": 0.7)", "rotate must be a JSON object");
  expect_refused_key(R"("rotate": {"axis": [0, 0, 1]})", "rotate.angle is missing");
  expect_refused_key(R"("rotate": {"angle": 1})", "rotate.axis is missing");
  expect_refused_key(R"("rotate": {"angle": 1, "axis": [0, 0, 0]})",
                     "rotate.axis is the zero vector");
  expect_refused_key(R"("rotate": {"angle": 1, "axis": [0, 0, "1"]})",
                     "rotate.axis[2] is of type string");
  expect_refused_key(R"("rotate": {"angle": true, "axis": [0, 0, 1]})",
                     "rotate.angle is of type boolean");
  expect_refused_key(R"("rotate": {"angle": 1, "axis": [0, 0, 1], "unit": 1})",
                     "rotate.unit is an unknown key");
  expect_refused_key(R"("translate": 1)", "translate must be an array of 3");
  expect_refused_key(R"("translate": [0, 0])", "translate must be an array of 3");
  expect_refused_key(R"("split": "halves")", "split is 'halves'");
  expect_refused_key(R"("split": 2)", "split is of type number");
  expect_refused_key(R"("self": 1)", "self is of type number, not true or false");
  expect_refused_key(R"("self": "true")", "self is of type string");
  expect_refused_key(R"("self": null)", "self is of type null");
}

TEST_F(SceneFileTest, IgnoresPairsOfObjectsByTheirNames) {
  const std::string objects =
      R"("objects": [{"mesh": "t.obj"}, {"mesh": "t.obj"}, {"name": "p", "mesh": "parts.obj",
      "split": "groups"}])";
  const auto ignored = [&](const std::string& pairs) {
    return read("{" + objects + ", \"ignore\": " + pairs + "}").ignored;
  };
  using Pairs = std::vector<ObjectPair>;
  EXPECT_EQ(read("{" + objects + "}").ignored, Pairs{});
  EXPECT_EQ(ignored("[]"), Pairs{});
  EXPECT_EQ(ignored(R"([["p/left", "t"]])"), (Pairs{{0, 2}}));
  EXPECT_EQ(ignored(R"([["t*", "p/*"], ["t#2", "t"]])"),
            (Pairs{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}}));
  // The order of the keys says nothing.
  EXPECT_EQ(read(R"({"ignore": [["t#2", "t"]], )" + objects + "}").ignored, (Pairs{{0, 1}}));
}

TEST_F(SceneFileTest, RefusesIgnoredObjectsWithTheirLine) {
  const auto refused = [&](const std::string& pairs, const std::string& reason, long line) {
    expect_refusal("{\"objects\": [\n{\"mesh\": \"t.obj\", \"scale\": [1, 1, 1]}],\n\"ignore\": " +
                       pairs + "}",
                   reason, line);
  };
  refused("[[\"t\", \"u\"]]", "ignore[0] names 'u', and no object is called so", 3);
  refused("[\n[\"*\",\n\"*\"]]", "ignore[0] names 't' alone", 4);
  refused("1", "ignore must be an array", 0);
  refused("[1]", "ignore[0] must be an array of two names", 0);
  refused("[[\"t\"]]", "ignore[0] must be an array of two names", 0);
  refused("[[\"t\", 1]]", "ignore[0] must be an array of two names", 0);
  refused("[\"t:t\"]", "ignore[0] must be an array of two names", 0);
  // The line is that of the pair, not that of another array.
  expect_refusal(
      R"({"objects": [{"mesh": "t.obj"}, {"mesh": "t.obj", "name": "u"}], "ignore": [["u", "t"],
      ["t", "u"],
      ["u", "v"]]})",
      "ignore[2] names 'v'", 3);
}

TEST_F(SceneFileTest, NamesTheMeshThatIsBad) {
  const std::string missing = folder.path("none.obj");
  const Error none = error_of([&] {
    read("{\"objects\": [{\"mesh\": \"t.obj\"},\n{\"name\": \"mesh\",\n\"mesh\": \"none.obj\"}]}");
  });
  EXPECT_EQ(none.where, missing);
  EXPECT_EQ(none.reason, "the file does not exist");
  EXPECT_TRUE(has_text(none.remedy, "objects[1].mesh in line 3 of ")) << none.what();
  const std::string bad = folder.write("bad.obj", "v 0 0 0\nf 0 1 1\n");
  const Error error = error_of([&] { read(R"({"objects": [{"mesh": "bad.obj"}]})"); });
  EXPECT_EQ(error.where, bad);
  EXPECT_EQ(error.line, 2);
}

TEST_F(SceneFileTest, RefusesPathsThatTheSystemWouldCutOrNotTake) {
  // The system ends the path at the NUL, where a mesh stands that was read before.
  expect_refusal(R"({"objects": [{"mesh": "t.obj"}, {"mesh": "t.obj\u0000.obj"}]})",
                 "objects[1].mesh contains a NUL byte");
  expect_refusal(R"({"objects": [{"mesh": ")" + std::string(5000, 'a') + R"(.obj"}]})",
                 "objects[0].mesh is a path of 5004 bytes");
}

// ---- arguments

TEST_F(SceneFileTest, TakesEachMeshFileAsAnObject) {
  const std::string mesh = folder.path("t.obj");
  const Scene scene = load_scene({mesh, folder.path("parts.obj"), mesh});
  EXPECT_EQ(scene.name, "t+parts+t");
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[1].triangle_count, 4u);
  EXPECT_EQ(scene.objects[2].name, "t#2");
  EXPECT_TRUE(same_bits(scene.vertices[1], Vec3(-0.0, 0.1, 0)));
}

TEST_F(SceneFileTest, RefusesArgumentsThatAreNoScene) {
  EXPECT_EQ(error_of([] { load_scene({}); }).where, "SCENE");
  EXPECT_EQ(error_of([] { load_scene({"no-such-scene"}); }).where, "no-such-scene");
  EXPECT_EQ(error_of([] { load_scene({"two-spheres@near"}); }).where, "two-spheres@near");
  EXPECT_EQ(error_of([] { load_scene({"a.gltf"}); }).where, "a.gltf");
  EXPECT_EQ(error_of([] { load_scene({"none.json"}); }).where, "none.json");
  EXPECT_EQ(error_of([] { load_scene({""}); }).where, "");
}

TEST_F(SceneFileTest, RefusesToMixScenesWithMeshes) {
  const std::string mesh = folder.path("t.obj");
  EXPECT_EQ(error_of([&] { load_scene({mesh, "two-spheres"}); }).where, "two-spheres");
  EXPECT_EQ(error_of([&] { load_scene({mesh, path}); }).where, path);
  // The last argument is refused before the first is read.
  EXPECT_EQ(error_of([] { load_scene({"none.obj", "b.gltf"}); }).where, "b.gltf");
}

Scene scene_of(const std::vector<std::string>& names) {
  Scene scene;
  for (const std::string& name : names) scene.objects.push_back({name, 0, 0, false});
  return scene;
}

using Pairs = std::vector<ObjectPair>;

TEST(Ignore, NamesPairsOfObjectsAndOfGroups) {
  const Scene scene = scene_of({"base", "link1", "link2", "hand", "link"});
  const auto pairs = [&](const std::string& list) {
    return ignored_objects(scene, parse_ignored(list));
  };
  EXPECT_EQ(pairs("base:link1"), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs("hand:base,base:hand"), (Pairs{{0, 3}}));
  EXPECT_EQ(pairs("link*:hand"), (Pairs{{1, 3}, {2, 3}, {3, 4}}));
  EXPECT_EQ(pairs("link*:link*"), (Pairs{{1, 2}, {1, 4}, {2, 4}}));
  EXPECT_EQ(pairs("*a*:*k1"), (Pairs{{0, 1}, {1, 3}}));
  EXPECT_EQ(pairs("*:*").size(), 10u);
}

TEST(Ignore, OfNamesThatAreTheSameAllAreMeant) {
  EXPECT_EQ(ignored_objects(scene_of({"a", "a", "b"}), parse_ignored("a:b")),
            (Pairs{{0, 2}, {1, 2}}));
  EXPECT_EQ(ignored_objects(scene_of({"a", "a"}), parse_ignored("a:a")), (Pairs{{0, 1}}));
  // A name with a * in it fits itself, and is refused where it fits others too.
  EXPECT_EQ(ignored_objects(scene_of({"a*", "b"}), parse_ignored("a*:b")), (Pairs{{0, 1}}));
  const Scene scene = scene_of({"a*", "a2", "b"});
  EXPECT_TRUE(
      refuses("names 'a*', which is the name of an object, and as a pattern fits others too",
              [&] { ignored_objects(scene, parse_ignored("b:a*")); }));
  EXPECT_EQ(error_of([&] { pairs_between(scene, "a*", "b", "here", "row 3"); }).reason,
            "row 3 names 'a*', which is the name of an object, and as a pattern fits others too");
  EXPECT_EQ(pairs_between(scene, "a2", "b", "here", "row 3"), (Pairs{{1, 2}}));
}

TEST(Ignore, WhoAnswersAboutAllRefusesASceneThatIgnores) {
  Scene scene = scene_of({"a", "b"});
  EXPECT_NO_THROW(require_nothing_ignored(scene, "a check"));
  scene.ignored = {{0, 1}};
  EXPECT_TRUE(
      refuses("a check answers about all", [&] { require_nothing_ignored(scene, "a check"); }));
}

TEST(Ignore, NamesMayHoldColons) {
  const Scene scene = scene_of({"C:x", "y", "C", "x:y"});
  EXPECT_EQ(ignored_objects(scene, parse_ignored("C:x:C")), (Pairs{{0, 2}}));
  EXPECT_TRUE(refuses("can be divided at more than one colon",
                      [&] { ignored_objects(scene, parse_ignored("C:x:y")); }));
}

TEST(Ignore, OfABackslashTakesTheNextCharacterForOneOfTheName) {
  const Scene scene = scene_of({"C:x", "y", "C", "x:y", "100,5", "a*", "a2", "b\\c"});
  const auto pairs = [&](const std::string& list) {
    return ignored_objects(scene, parse_ignored(list));
  };
  EXPECT_EQ(pairs("C\\:x:y"), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs("C:x\\:y"), (Pairs{{2, 3}}));
  EXPECT_EQ(pairs("100\\,5:y,C:y"), (Pairs{{1, 2}, {1, 4}}));
  EXPECT_EQ(pairs("a\\*:y"), (Pairs{{1, 5}}));
  EXPECT_EQ(pairs("*\\,*:a2"), (Pairs{{4, 6}}));
  EXPECT_EQ(pairs("b\\c:y"), (Pairs{{1, 7}})) << "before other characters it is one of the name";
  // The twins.
  EXPECT_TRUE(refuses("'100' has no colon", [&] { pairs("100,5:y"); }));
  EXPECT_TRUE(refuses("has no colon", [&] { pairs("C\\:x"); }));
}

TEST(Ignore, RefusesWhatNamesNothing) {
  const Scene scene = scene_of({"a", "b"});
  const auto refused = [&](const std::string& list) {
    return message_of([&] { ignored_objects(scene, parse_ignored(list)); });
  };
  EXPECT_TRUE(has_text(refused("a:c"), "--ignore: 'a:c' names 'c', and no object is called so"));
  EXPECT_TRUE(has_text(refused("z*:b"), "names 'z*'"));
  EXPECT_TRUE(has_text(refused("ab"), "has no colon"));
  EXPECT_TRUE(has_text(refused("a:a"), "names one object"));
  EXPECT_TRUE(has_text(refused(""), "a pair of names is empty"));
  EXPECT_TRUE(has_text(refused("a:b,"), "a pair of names is empty"));
  EXPECT_TRUE(has_text(refused("a:c"), "the scene has a, b"));
}

TEST(Ignore, ReadsAFileAndNamesItsLines) {
  const ScratchFolder folder;
  const std::string good = folder.write("pairs.txt", "# links\r\n\na:b\r\n");
  const Scene scene = scene_of({"a", "b"});
  EXPECT_EQ(ignored_objects(scene, read_ignored(good)), (Pairs{{0, 1}}));
  const std::string bad = folder.write("bad.txt", "a:b\n# x\na:z\n");
  EXPECT_TRUE(refuses("bad.txt:3", [&] { ignored_objects(scene, read_ignored(bad)); }));
  EXPECT_TRUE(refuses("cannot be read", [&] { read_ignored(folder.path("none.txt")); }));
  const std::string empty = folder.write("empty.txt", "# nothing\n");
  EXPECT_TRUE(refuses("names no pair", [&] { read_ignored(empty); }));
}

}  // namespace
}  // namespace farcull
