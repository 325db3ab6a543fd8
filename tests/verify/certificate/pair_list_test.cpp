// The list of colliding pairs, its hash, and what a scene does not ask.
#include "verify/certificate/pair_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/verify/reference.h"
#include "verify/certificate/not_asked.h"
#include "verify/certificate/sha256.h"
#include "verify/exact.h"

namespace farcull {
namespace {

std::string sha256(std::string_view text) {
  Sha256 hash;
  hash.add(text);
  return hash.digest();
}

// The examples of FIPS 180-4, and `sha256sum` of others.
TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnHowTheTextIsCut) {
  const std::string text(300, 'x');
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const std::string_view part = std::string_view(text).substr(0, length);
    Sha256 hash;
    for (std::size_t at = 0; at < length; at += 7) hash.add(part.substr(at, 7));
    EXPECT_EQ(hash.digest(), sha256(part)) << length;
  }
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
    std::sort(all.begin(), all.end());
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
  EXPECT_NE(heading.find("promises to miss nothing\nnot asked  whether an object meets itself: 3 "
                         "pairs of triangles inside sheet, "),
            std::string::npos)
      << heading;
  EXPECT_NE(heading.find("(--self asks)\n"), std::string::npos);
  record.options.method = Method::cullide;
  EXPECT_NE(run_heading(folded(false), record).find("(--method far-pairs --self asks)\n"),
            std::string::npos);
  record.options.method = Method::exact;
  EXPECT_NE(run_heading(folded(false), record).find("(--self asks)\n"), std::string::npos);
  EXPECT_EQ(run_heading(folded(true), record).find("not asked"), std::string::npos);
}

}  // namespace
}  // namespace farcull
