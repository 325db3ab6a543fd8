// The list of colliding pairs, its hash, and what a scene does not ask.
#include "verify/certificate/pair_list.h"

#include "core/base/bytes.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

// The examples of FIPS 180-4, and `sha256sum` of others.
TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(PairList, IsWhatARunWrites) {
  for (const bool self : {false, true}) {
    Scene scene = make_builtin_scene("random-soup");
    for (Object& object : scene.objects) object.self = self;
    const ExactResult exact = all_colliding_pairs(scene);
    ASSERT_GT(exact.pairs.size(), 100u);
    Record record;
    record.collisions.pairs = exact.pairs;
    record.collisions.neighbour_pairs = exact.neighbour_pairs;
    std::vector<TrianglePair> all = exact.pairs;
    all.insert(all.end(), exact.neighbour_pairs.begin(), exact.neighbour_pairs.end());
    std::ranges::sort(all);
    EXPECT_EQ(pairs_csv(scene, record), pair_list(scene, all));
    EXPECT_EQ(pair_list_hash(scene, all), sha256(pair_list(scene, all)));
  }
}

/// Three triangles of one object: 0 and 1 share an edge, 2 pierces 0; and one more object.
Scene folded(bool self) {
  const Vec3 o(0, 0, 0), x(4, 0, 0), y(0, 4, 0), xy(4, 4, 0);
  Scene scene = reference::scene_of(
      {{{o, x, y}, {x, xy, y}, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(2, 1, 1)}}, {{o, x, y}}});
  scene.objects[0].self = self;
  scene.objects[0].name = "sheet";
  return scene;
}

TEST(PairList, TellsNeighboursWhereAnObjectIsSelf) {
  const std::vector<TrianglePair> pairs = {{0, 1}, {0, 2}, {0, 3}};
  EXPECT_EQ(pair_list(folded(true), pairs),
            "object_a,triangle_a,object_b,triangle_b,neighbours\n"
            "0,0,0,1,1\n0,0,0,2,0\n0,0,1,0,0\n");
  EXPECT_EQ(pair_list(folded(false), {}), "object_a,triangle_a,object_b,triangle_b\n");
  EXPECT_EQ(pair_list(folded(false), std::vector{pairs[2]}),
            "object_a,triangle_a,object_b,triangle_b\n0,0,1,0\n");
}

// ---- lists that are given ----

constexpr const char* kHeader = "object_a,triangle_a,object_b,triangle_b\n";

TEST(GivenList, IsReadBackAsItIsWritten) {
  const Scene scene = folded(true);
  const std::vector<TrianglePair> pairs = {{0, 1}, {0, 2}, {0, 3}};
  const GivenList list = read_pair_list(pair_list(scene, pairs), "pairs.csv");
  EXPECT_FALSE(list.has_frames);
  EXPECT_TRUE(list.not_looked_at.empty());
  ASSERT_EQ(list.rows.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(pair_of(scene, list.name, list.rows[i]), pairs[i]);
    EXPECT_EQ(list.rows[i].line, i + 2);
    EXPECT_EQ(list.rows[i].neighbours, i == 0);
  }
  EXPECT_TRUE(read_pair_list(kHeader, "pairs.csv").rows.empty());
}

TEST(GivenList, MalformedOnesNameTheLine) {
  const std::string header = kHeader;
  const std::string self = "object_a,triangle_a,object_b,triangle_b,neighbours\n";
  for (const auto& [text, line, reason] :
       {std::tuple(std::string(), 0, "the file is empty"),
        std::tuple(std::string("\n\r\n"), 2, "the file is empty"),
        std::tuple(std::string("0,1,1,4\n"), 1, "no column object_a"),
        std::tuple(std::string("object_a;triangle_a;object_b;triangle_b\n"), 1,
                   "no column object_a"),
        std::tuple(std::string("object_a,triangle_a,object_b\n"), 1, "no column triangle_b"),
        std::tuple(std::string("object_a,triangle_a,object_b,triangle_b,object_b\n"), 1,
                   "object_b is named twice"),
        std::tuple(header + "0,1,1,4\n0,1,1\n", 3, "3 cells, and the first has 4"),
        std::tuple(header + "0,1,1,4,0\n", 2, "5 cells"),
        std::tuple(header + "0,1,1,\n", 2, "triangle_b is ''"),
        std::tuple(header + "0,1,-1,4\n", 2, "object_b is '-1', no whole number"),
        std::tuple(header + "0,1.5,1,4\n", 2, "triangle_a is '1.5'"),
        std::tuple(header + "0, 1,1,4\n", 2, "triangle_a is ' 1'"),
        std::tuple(header + "0,1,1,4294967296\n", 2, "triangle_b is '4294967296'"),
        std::tuple(header + "0,1,1,\x1b[1m\n", 2, "'?[1m'"),
        std::tuple(header + "0,1,1,\"4\n\"\n", 2, "not closed"),
        std::tuple(header + "0,1,1,\"4\"5\n", 2, "after the quotes"),
        std::tuple(self + "0,1,1,4,2\n", 2, "neither 0 nor 1")}) {
    SCOPED_TRACE(text);
    const Error error = error_of([&] { read_pair_list(text, "some/pairs.csv"); });
    EXPECT_EQ(error.where, "some/pairs.csv");
    EXPECT_EQ(error.line, line);
    EXPECT_TRUE(has_text(error.reason, reason));
    EXPECT_TRUE(has_text(error.remedy, "object_a,triangle_a,object_b,triangle_b"));
  }
}

TEST(GivenList, NamesObjectsAndTrianglesThatTheSceneLacks) {
  const Scene scene = folded(true);
  for (const auto& [row, reason] :
       {std::pair("0,0,2,0\n", "no object 2: the scene has 2"),
        std::pair("0,3,1,0\n", "object 0 has no triangle 3: it has 3"),
        std::pair("0,0,1,1\n", "object 1 has no triangle 1: it has 1")}) {
    const GivenList list = read_pair_list(std::string(kHeader) + "0,0,0,2\n" + row, "pairs.csv");
    const Error error = error_of([&] { find_differences(scene, list.name, list.rows, {}); });
    EXPECT_EQ(error.where, "pairs.csv");
    EXPECT_EQ(error.line, 3);
    EXPECT_TRUE(has_text(error.reason, reason));
  }
}

ListDifferences differences(const Scene& scene, const std::string& rows,
                            const std::vector<TrianglePair>& meeting, double clearance = 0) {
  const GivenList list =
      read_pair_list("object_a,triangle_a,object_b,triangle_b,neighbours\n" + rows, "pairs.csv");
  return find_differences(scene, list.name, list.rows, meeting, clearance);
}

TEST(GivenList, TellsWhatIsWrongAndWhatIsMissing) {
  const Scene scene = folded(true);
  const std::vector<TrianglePair> meeting = {{0, 2}, {0, 3}, {2, 3}};
  const std::string right = "0,0,0,2,0\n0,0,1,0,0\n0,2,1,0,0\n";
  EXPECT_TRUE(differences(scene, right, meeting).none());
  // Any order, and either triangle first.
  EXPECT_TRUE(differences(scene, "1,0,0,2,0\n0,2,0,0,0\n0,0,1,0,0\n", meeting).none());

  const ListDifferences lacks = differences(scene, "0,0,0,2,0\n0,2,1,0,0\n", meeting);
  EXPECT_EQ(lacks.wrong, 0u);
  EXPECT_EQ(lacks.missing, 1u);
  EXPECT_EQ(lacks.missing_pair, (TrianglePair{0, 3}));
  EXPECT_EQ(differences(scene, "", meeting).missing, 3u);

  for (const auto& [row, reason] :
       {std::pair("0,1,1,0,0\n", "the pair is disjoint"),
        std::pair("0,0,0,1,1\n", "neighbours that share only vertices or an edge"),
        std::pair("0,1,0,1,0\n", "names one triangle twice"),
        std::pair("0,0,0,2,0\n", "that of line 2 again"),
        std::pair("0,2,0,0,0\n", "that of line 2 again")}) {
    const ListDifferences wrong = differences(scene, right + row, meeting);
    EXPECT_EQ(wrong.listed, 4u);
    EXPECT_EQ(wrong.wrong, 1u) << row;
    EXPECT_EQ(wrong.missing, 0u) << row;
    EXPECT_EQ(wrong.wrong_line, 5u) << row;
    EXPECT_TRUE(has_text(wrong.wrong_reason, reason));
  }
  EXPECT_TRUE(has_text(differences(scene, "0,1,1,0,0\n", {}, 0.5).wrong_reason, "farther apart"));
  // What it says of neighbours.
  const ListDifferences said = differences(scene, "0,0,0,2,1\n0,0,1,0,0\n0,2,1,0,0\n", meeting);
  EXPECT_EQ(said.wrong, 1u);
  EXPECT_EQ(said.missing, 0u);
  EXPECT_TRUE(has_text(said.wrong_reason, "no neighbours, and the line says 1"));
  const std::vector<TrianglePair> with_neighbours = {{0, 1}};
  EXPECT_TRUE(differences(scene, "0,0,0,1,1\n", with_neighbours).none());
  EXPECT_TRUE(
      has_text(differences(scene, "0,0,0,1,0\n", with_neighbours).wrong_reason, "line says 0"));
  // Both, and the first of several in the order of the file.
  const ListDifferences both =
      differences(scene, "0,1,1,0,0\n0,0,0,2,0\n0,0,0,1,1\n0,0,0,2,0\n", meeting);
  EXPECT_EQ(both.wrong, 3u);
  EXPECT_EQ(both.wrong_line, 2u);
  EXPECT_EQ(both.wrong_pair, (TrianglePair{1, 3}));
  EXPECT_EQ(both.missing, 2u);
  EXPECT_EQ(both.missing_pair, (TrianglePair{0, 3}));
  // Of an object that is not self.
  EXPECT_TRUE(has_text(differences(folded(false), "0,0,0,2,0\n", {}).wrong_reason, "--self asks"));
}

TEST(NotAsked, IsWhatLiesInsideObjectsThatAreNotSelf) {
  const NotAsked one = not_asked(folded(false));
  EXPECT_EQ(one.objects, 2u);
  EXPECT_EQ(one.pairs, 3u);
  EXPECT_EQ(one.ranges, (std::vector<std::array<std::uint32_t, 2>>{{0, 1}}));
  const NotAsked none = not_asked(folded(true));
  EXPECT_EQ(none.objects, 1u);
  EXPECT_EQ(none.pairs, 0u);
  EXPECT_EQ(none.ranges, (std::vector<std::array<std::uint32_t, 2>>{{1, 1}}));

  const reference::Triangle point = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
  Scene many = reference::scene_of(std::vector(7, std::vector(2, point)));
  many.objects[3].self = true;
  const NotAsked some = not_asked(many);
  EXPECT_EQ(some.objects, 6u);
  EXPECT_EQ(some.pairs, 6u);
  EXPECT_EQ(some.ranges, (std::vector<std::array<std::uint32_t, 2>>{{0, 2}, {4, 6}}));
  EXPECT_EQ(not_asked_text(many), "6 pairs of triangles inside 6 of 7 objects");
}

TEST(NotAsked, IsSaidBesideThePromise) {
  Record record;
  record.options.method = Method::far;
  record.promise.holds = true;
  const std::string heading = run_heading(folded(false), record);
  EXPECT_TRUE(has_text(heading, "\nnot asked  3 pairs of triangles inside sheet, "));
  EXPECT_TRUE(has_text(heading, "(add --self)\n"));
  record.options.method = Method::cullide;
  EXPECT_TRUE(has_text(run_heading(folded(false), record), "(add --method boxes --self)\n"));
  record.options.method = Method::exact;
  EXPECT_TRUE(has_text(run_heading(folded(false), record), "(add --self)\n"));
  EXPECT_FALSE(has_text(run_heading(folded(true), record), "not asked"));
}

}  // namespace
}  // namespace farcull
