// What a run is asked about pairs: which objects it ignores, how many pairs it gives, how they
// meet. For every kind of method, against the run that is asked for all.
#include "experiments/record/check.h"
#include "experiments/record/output.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/runs.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using lab::on_cpu, lab::run;

const std::vector<ObjectPair> kIgnored = {{0, 1}, {0, 3}, {2, 5}, {6, 7}};

std::uint64_t removed_of(const Record& record) {
  std::vector<TrianglePair> candidates = record.found.pairs;
  return remove_ignored(make_builtin_scene("random-soup"), kIgnored, candidates);
}

TEST(AskedPairs, IgnoredObjectsAreLeftOutByEveryMethodAndAccountedFor) {
  const Scene scene = make_builtin_scene("random-soup");
  for (const Method method : {Method::boxes, Method::exact, Method::i_collide, Method::far}) {
    RunOptions options = on_cpu(method);
    const Record all = run(scene, options);
    options.ignored = kIgnored;
    const Record some = run(scene, options);
    std::vector<TrianglePair> expected = all.collisions.pairs;
    const std::uint64_t removed = remove_ignored(scene, kIgnored, expected);
    EXPECT_GT(removed, 0u);
    EXPECT_EQ(some.collisions.pairs, expected) << to_string(method);
    EXPECT_NE(some.collisions.pairs, all.collisions.pairs);
    // Boxes of blocks make no candidates of two such objects in the first place.
    const bool by_blocks = method == Method::boxes;
    EXPECT_EQ(some.found.count + (by_blocks ? removed_of(all) : some.found.ignored),
              all.found.count)
        << to_string(method);
    ASSERT_TRUE(some.verification);
    EXPECT_EQ(some.verification->false_negatives, 0u) << to_string(method);
    EXPECT_EQ(some.verification->ignored, 4u * 500 * 500);
    EXPECT_TRUE(some.verification->adds_up());
    // The twin: without the class, the same candidates miss what is ignored.
    EXPECT_GT(account(scene, pairs_left(some)).false_negatives, 0u);
    const nlohmann::ordered_json json = to_json(scene, some);
    EXPECT_EQ(json["ignored"]["object_pairs"], 4);
    EXPECT_EQ(json["ignored"]["candidates"], some.found.ignored);
    EXPECT_EQ(json["verification"]["ignored"], 4 * 500 * 500);
    EXPECT_TRUE(to_json(scene, all)["ignored"].is_null());
  }
}

TEST(AskedPairs, WhatASceneIgnoresIsIgnoredAsWhatTheOptionsIgnore) {
  const Scene whole = make_builtin_scene("random-soup");
  Scene scene = whole;
  scene.ignored = {kIgnored.begin(), kIgnored.begin() + 2};
  for (const Method method : {Method::boxes, Method::exact, Method::i_collide, Method::far}) {
    RunOptions options = on_cpu(method);
    options.ignored = kIgnored;
    const Record expected = run(whole, options);
    options.ignored = {kIgnored.begin() + 1, kIgnored.end()};
    const Record both = run(scene, options);
    EXPECT_EQ(both.options.ignored, kIgnored);
    EXPECT_EQ(both.collisions.pairs, expected.collisions.pairs) << to_string(method);
    EXPECT_EQ(both.verification->ignored, expected.verification->ignored);
    EXPECT_EQ(both.verification->false_negatives, 0u);
    // The twin: without what the scene ignores there are more.
    EXPECT_GT(run(whole, options).collisions.pairs.size(), both.collisions.pairs.size());
    EXPECT_THROW(certificate_of(scene, both), Error);
  }
  Scene unsorted = whole;
  unsorted.ignored = {{2, 5}, {0, 1}};
  EXPECT_THROW(validate(unsorted, "here"), Error);
  // An empty list lacks the pairs that the scene does not ignore. If nothing is ignored it lacks
  // more.
  const GivenList list{.name = "list", .has_frames = false, .rows = {}, .not_looked_at = {}};
  const auto lacking = [&](const Scene& asked) {
    const SceneCheck check = check_scene_with(0, "", {}, asked, &list, {});
    EXPECT_NE(check.result.verdict, Verdict::proved);
    return check.result.meeting.size();
  };
  EXPECT_LT(lacking(scene), lacking(whole));
}

// What is kept of the frame before must not be used where other objects are ignored.
TEST(AskedPairs, FramesMayIgnoreOtherObjects) {
  Scene scene = make_builtin_scene("crowd:40:1");
  Session session("cpu");
  session.remember_frames();
  std::set<std::size_t> sizes;
  for (int frame = 0; frame < 24; ++frame) {
    scene.vertices[static_cast<std::size_t>(frame)].x() += 1e-3;
    RunOptions options = on_cpu(Method::boxes);
    // Objects 0 .. 19 are ignored with each other in the frames 4 to 7, and in some after.
    if (frame % 8 >= 4) {
      for (std::uint32_t b = 1; b < 20; ++b)
        for (std::uint32_t a = 0; a < b; ++a) options.ignored.push_back({a, b});
      options.ignored = in_order(std::move(options.ignored));
    }
    const Record kept = run(scene, options, session);
    const Record alone = run(scene, options);
    ASSERT_EQ(kept.collisions.pairs, alone.collisions.pairs) << frame;
    ASSERT_EQ(kept.verification->false_negatives, 0u);
    sizes.insert(kept.collisions.pairs.size());
  }
  EXPECT_GT(sizes.size(), 1u) << "the case shows nothing";
}

TEST(AskedPairs, OfALimitAreTheFirstAndTheAccountingStillHolds) {
  Scene scene = make_builtin_scene("random-soup");
  for (const Method method : {Method::boxes, Method::exact, Method::i_collide}) {
    RunOptions options = on_cpu(method);
    const Record all = run(scene, options);
    ASSERT_GT(all.collisions.pairs.size(), 10u);
    EXPECT_TRUE(all.complete);
    options.limit = 10;
    const Record some = run(scene, options);
    EXPECT_EQ(some.collisions.pairs, std::vector<TrianglePair>(all.collisions.pairs.begin(),
                                                               all.collisions.pairs.begin() + 10));
    EXPECT_FALSE(some.complete);
    EXPECT_EQ(some.found.count, all.found.count);
    EXPECT_EQ(some.verification->false_negatives, 0u);
    EXPECT_EQ(some.verification->pairs_kept, all.verification->pairs_kept);
    const nlohmann::ordered_json json = to_json(scene, some);
    EXPECT_EQ(json["limit"], 10);
    EXPECT_EQ(json["complete"], false);
    EXPECT_EQ(json["decided_pairs"], some.decided);
    if (method == Method::boxes) {
      EXPECT_LT(some.decided, all.decided);
    }
  }
}

TEST(AskedPairs, KindsOfContactAreCountedAndListed) {
  const Scene scene = make_builtin_scene("degenerate");
  RunOptions options = on_cpu(Method::boxes);
  const Record silent = run(scene, options);
  EXPECT_TRUE(silent.contacts.empty());
  EXPECT_TRUE(to_json(scene, silent)["contacts"].is_null());
  options.contacts = ContactDetail::segments;
  const Record record = run(scene, options);
  ASSERT_EQ(record.contacts.size(), record.collisions.pairs.size());
  const nlohmann::ordered_json json = to_json(scene, record);
  std::uint64_t sum = 0;
  for (const auto& [name, count] : json["contacts"].items()) sum += count.get<std::uint64_t>();
  EXPECT_EQ(sum, record.contacts.size());
  EXPECT_EQ(json["contacts"]["apart"], 0);
  EXPECT_GT(json["contacts"]["touch-vertex"], 0);

  const PairColumns columns{.faces = true, .contacts = true, .segments = true};
  const std::string csv = pairs_csv(scene, record, columns);
  EXPECT_TRUE(csv.starts_with(
      "object_a,triangle_a,object_b,triangle_b,contact,x0,y0,z0,x1,y1,z1,polygon,face_a,face_b\n"));
  const auto rows = static_cast<std::size_t>(std::ranges::count(csv, '\n'));
  EXPECT_EQ(rows, record.contacts.size() + 1);
  // Thirteen commas in each row, whatever is empty.
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, ',')), 13 * rows);
  EXPECT_TRUE(has_text(csv, ",coplanar,,,,,,,"));

  const auto of = [&](std::vector<ContactKind> kinds) {
    return pairs_csv(scene, record, {.contacts = true, .kinds = std::move(kinds)});
  };
  const std::string crossing = of({ContactKind::crossing});
  EXPECT_EQ(static_cast<std::uint64_t>(std::ranges::count(crossing, '\n')),
            json["contacts"]["crossing"].get<std::uint64_t>() + 1);
  EXPECT_FALSE(has_text(crossing, "touch"));
  EXPECT_EQ(of({kContactKinds.begin(), kContactKinds.end()}), of({}));
}

}  // namespace
}  // namespace farcull
