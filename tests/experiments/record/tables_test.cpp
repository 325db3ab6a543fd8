// What the tables say in words: numbers with their nouns, what collides, what there is to test, and
// the verdict.
#include "experiments/record/tables.h"
#include "experiments/record/stage_words.h"

#include "experiments/record/output.h"
#include "experiments/system/text_table.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

const std::array<Vec3, 3> kSome = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

// Objects of so many triangles each.
Scene scene_of(std::vector<std::size_t> sizes, bool self = false) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects;
  for (const std::size_t size : sizes) objects.emplace_back(size, kSome);
  Scene scene = lab::scene_of(objects);
  for (Object& object : scene.objects) object.self = self;
  return scene;
}

TEST(Counted, ReasonsOfStagesAgree) {
  for (int reason = 0; reason <= static_cast<int>(Reason::if_candidates); ++reason) {
    const auto text = [&](std::uint64_t n) {
      return reason_of({.reason = static_cast<Reason>(reason), .n = n, .m = n});
    };
    for (const char* plural : {"1 triangles", "1 objects", "1 patches", "1 candidates", "1 passes",
                               "1 pairs of objects"})
      EXPECT_FALSE(has_text(text(1), plural));
    for (const char* singular : {"2 triangle ", "2 object ", "2 patch ", "2 candidate ", "2 pass,"})
      EXPECT_FALSE(has_text(text(2), singular));
  }
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

TEST(Wrapped, BreaksAtBlanksBelowTheText) {
  EXPECT_EQ(wrapped("label      one two three\n", 20), "label      one two\n           three\n");
  EXPECT_EQ(wrapped("one two three four", 10), "one two\nthree four\n");
  EXPECT_EQ(wrapped("  one two three", 11), "  one two\n  three\n");
  EXPECT_EQ(wrapped("farcull: a.obj: is gone", 16, 9), "farcull: a.obj:\n         is gone\n");
  EXPECT_EQ(wrapped("one-long-word two", 4), "one-long-word\ntwo\n");  // words stay whole
  EXPECT_EQ(wrapped("fits\n\nas it is\n", 8), "fits\n\nas it is\n");
}

TEST(Table, FitsIntoItsColumns) {
  Table notes("lrl");
  notes.add({"stage", "ms", ""});
  notes.add({"boxes", "1.4", "pairs of objects whose boxes overlap"});
  EXPECT_EQ(notes.text(100), "stage   ms\nboxes  1.4  pairs of objects whose boxes overlap\n");
  EXPECT_EQ(notes.text(40),
            "stage   ms\nboxes  1.4  pairs of objects whose boxes\n            overlap\n");
  notes.add({"and a note of several words"});
  EXPECT_TRUE(has_text(notes.text(20), "\n      and a note of\n      several words\n"));
  // Numbers cannot be wrapped: the columns that do not fit stand below, after the first one again.
  Table numbers("lrrrr");
  numbers.add({"", "first", "second", "", "third"});
  numbers.add({"a", "1", "2", "", "3"});
  EXPECT_EQ(numbers.text(16), "   first  second\na      1       2\n\n   third\na      3\n");
  for (std::size_t columns = 40; columns < 130; ++columns) {
    EXPECT_LE(longest_line(notes.text(columns)), columns);
    EXPECT_LE(longest_line(numbers.text(columns)), columns);
  }
}

TEST(Colliding, BothNumbersAndTheirSum) {
  EXPECT_EQ(colliding_text(1, 0, false), "1 pair");
  EXPECT_EQ(colliding_text(3857, 0, false), "3,857 pairs");
  EXPECT_EQ(colliding_text(1581, 62, true), "1,643 pairs = 1,581 + 62 of neighbours");
  EXPECT_EQ(colliding_text(1, 0, true), "1 pair = 1 + 0 of neighbours");
  const Scene scene = scene_of({3}, true);
  Record record;
  record.options.method = Method::exact;
  record.collisions.pairs = {{0, 1}};
  record.collisions.neighbour_pairs = {{0, 2}, {1, 2}};
  const auto json = to_json(scene, record);
  EXPECT_EQ(json["colliding_pairs"], 1);
  EXPECT_EQ(json["neighbour_pairs"], 2);
  EXPECT_EQ(json["all_colliding_pairs"], 3);
  EXPECT_TRUE(has_text(run_table(scene, record), "colliding  3 pairs = 1 + 2 of neighbours; "));
}

TEST(NothingToTest, IsOneObjectThatIsNotSelf) {
  for (const Scene& scene : {scene_of({2}), scene_of({9}), scene_of({0, 2, 0})}) {
    const NothingToTest nothing = nothing_to_test(scene);
    EXPECT_TRUE(has_text(nothing.reason, "only with --self"));
    EXPECT_TRUE(nothing.with_self);
    EXPECT_EQ(plan_json(scene, plan(scene, {}))["nothing_to_test"], nothing.reason);
  }
  for (const Scene& scene : {scene_of({1}), scene_of({1}, true), scene_of({0, 1})}) {
    const NothingToTest nothing = nothing_to_test(scene);
    EXPECT_EQ(nothing.reason, "the scene has fewer than two triangles");
    EXPECT_FALSE(nothing.with_self);
  }
  // The twins: each has a pair.
  Scene second = scene_of({1, 2});
  second.objects[1].self = true;
  for (const Scene& scene : {scene_of({2}, true), scene_of({1, 1}), scene_of({0, 1, 1}), second}) {
    EXPECT_TRUE(nothing_to_test(scene).reason.empty());
    EXPECT_TRUE(plan_json(scene, plan(scene, {}))["nothing_to_test"].is_null());
  }
}

// Whether there is nothing to test is decided by the sizes of the objects; the accounting counts
// the pairs by itself.
TEST(NothingToTest, AgreesWithTheAccounting) {
  for (const bool self : {false, true}) {
    for (const auto& sizes : std::vector<std::vector<std::size_t>>{
             {1}, {2}, {0, 2}, {1, 1}, {0, 1}, {2, 0, 3}, {0, 0, 1}}) {
      const Scene scene = scene_of(sizes, self);
      const Accounting found = account(scene, all_colliding_pairs(scene).all());
      EXPECT_EQ(found.pairs_total == 0, !nothing_to_test(scene).reason.empty());
    }
  }
}

}  // namespace
}  // namespace farcull
