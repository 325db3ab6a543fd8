// Names of ignored objects, as the command line and files give them.
#include "experiments/scenes/scene_file.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "tests/experiments/system/error_of.h"

namespace farcull {
namespace {

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
  EXPECT_NE(message_of([&] {
              ignored_objects(scene, parse_ignored("b:a*"));
            }).find("names 'a*', which is the name of an object, and as a pattern fits others too"),
            std::string::npos);
  EXPECT_EQ(error_of([&] { pairs_between(scene, "a*", "b", "here", "row 3"); }).reason,
            "row 3 names 'a*', which is the name of an object, and as a pattern fits others too");
  EXPECT_EQ(pairs_between(scene, "a2", "b", "here", "row 3"), (Pairs{{1, 2}}));
}

TEST(Ignore, PairsOfTwoPatternsAreThoseOfTheList) {
  const Scene scene = scene_of({"base", "link1", "link2", "hand", "link"});
  const auto pairs = [&](const char* a, const char* b) {
    return pairs_between(scene, a, b, "here", "row 3");
  };
  EXPECT_EQ(pairs("link*", "hand"), (Pairs{{1, 3}, {2, 3}, {3, 4}}));
  EXPECT_EQ(pairs("hand", "base"), (Pairs{{0, 3}}));
  EXPECT_EQ(pairs("*", "*").size(), 10u);
  const Error unknown = error_of([&] { pairs("base", "arm*"); });
  EXPECT_EQ(unknown.where, "here");
  EXPECT_EQ(unknown.reason, "row 3 names 'arm*', and no object is called so");
  EXPECT_EQ(error_of([&] { pairs("han*", "hand"); }).reason, "row 3 names 'hand' alone");
}

TEST(Ignore, WhoAnswersAboutAllRefusesASceneThatIgnores) {
  Scene scene = scene_of({"a", "b"});
  EXPECT_NO_THROW(require_nothing_ignored(scene, "a check"));
  scene.ignored = {{0, 1}};
  EXPECT_NE(message_of([&] {
              require_nothing_ignored(scene, "a check");
            }).find("a check answers about all"),
            std::string::npos);
}

TEST(Ignore, NamesMayHoldColons) {
  const Scene scene = scene_of({"C:x", "y", "C", "x:y"});
  EXPECT_EQ(ignored_objects(scene, parse_ignored("C:x:C")), (Pairs{{0, 2}}));
  EXPECT_NE(message_of([&] {
              ignored_objects(scene, parse_ignored("C:x:y"));
            }).find("can be divided at more than one colon"),
            std::string::npos);
}

TEST(Ignore, RefusesWhatNamesNothing) {
  const Scene scene = scene_of({"a", "b"});
  const auto refused = [&](const std::string& list) {
    return message_of([&] { ignored_objects(scene, parse_ignored(list)); });
  };
  EXPECT_NE(refused("a:c").find("--ignore: 'a:c' names 'c', and no object is called so"),
            std::string::npos);
  EXPECT_NE(refused("z*:b").find("names 'z*'"), std::string::npos);
  EXPECT_NE(refused("ab").find("has no colon"), std::string::npos);
  EXPECT_NE(refused("a:a").find("names one object"), std::string::npos);
  EXPECT_NE(refused("").find("a pair of names is empty"), std::string::npos);
  EXPECT_NE(refused("a:b,").find("a pair of names is empty"), std::string::npos);
  EXPECT_NE(refused("a:c").find("the scene has a, b"), std::string::npos);
}

TEST(Ignore, ReadsAFileAndNamesItsLines) {
  const ScratchFolder folder;
  const std::string good = folder.write("pairs.txt", "# links\r\n\na:b\r\n");
  const Scene scene = scene_of({"a", "b"});
  EXPECT_EQ(ignored_objects(scene, read_ignored(good)), (Pairs{{0, 1}}));
  const std::string bad = folder.write("bad.txt", "a:b\n# x\na:z\n");
  EXPECT_NE(message_of([&] { ignored_objects(scene, read_ignored(bad)); }).find("bad.txt:3"),
            std::string::npos);
  EXPECT_NE(message_of([&] { read_ignored(folder.path("none.txt")); }).find("cannot be read"),
            std::string::npos);
  const std::string empty = folder.write("empty.txt", "# nothing\n");
  EXPECT_NE(message_of([&] { read_ignored(empty); }).find("names no pair"), std::string::npos);
}

}  // namespace
}  // namespace farcull
