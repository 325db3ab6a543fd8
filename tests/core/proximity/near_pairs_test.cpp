// Potential neighbours hold every nearest pair, in scenes of all kinds and scales; the truth is by
// comparing all with all exactly. Each property has a twin that must fail.
#include "core/proximity/near_pairs.h"

#include "core/native/canvas.h"
#include "core/proximity/scene_trees.h"
#include "tests/lab/grid_distance.h"
#include "tests/lab/rational.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

using near_lab::GridScene;
using Fraction = near_lab::Fraction<near_lab::Integer>;
using near_lab::Truth, rational::Random;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool same(const NearPairs& a, const NearPairs& b) {
  return a.objects == b.objects && a.upper == b.upper && a.pairs == b.pairs;
}

// What is wrong with an answer; empty: nothing.
std::string fault_of(const GridScene& grid, const Truth& truth, const NearPairs& answer,
                     double within) {
  const bool asked = truth.any && near_lab::at_most(truth.squared, grid.unit, within);
  if (!truth.any && !answer.pairs.empty()) return "pairs where there are none";
  if (!std::ranges::is_sorted(answer.pairs)) return "pairs are not sorted";
  if (std::ranges::adjacent_find(answer.pairs) != answer.pairs.end()) return "a pair twice";
  if (answer.pairs.empty() != (answer.upper == kInfinite) && grid.unit < 1e290)
    return "a bound without a pair, or the reverse";
  if (!answer.pairs.empty() && !near_lab::at_most(truth.squared, grid.unit, answer.upper))
    return "the bound is below the distance";
  if (!asked) return "";
  if (truth.squared.numerator == 0) {
    if (!std::ranges::binary_search(answer.pairs, truth.pairs.front()))
      return "the first pair that meets is missing";
  } else if (!std::ranges::includes(answer.pairs, truth.pairs)) {
    return "a nearest pair is missing";
  }
  return "";
}

GridScene random_scene(Random& random, int objects, int most) {
  GridScene grid;
  const int apart = random.below(3) * 8;
  for (int o = 0; o < objects; ++o) {
    near_lab::Triple<near_lab::Integer> middle;
    for (auto& x : middle) x = random.below(2 * apart + 1) - apart;
    const int count = random.below(12) == 0 ? 0 : 1 + random.below(most);
    add_object(grid, near_lab::random_triangles(random, count, 1 + random.below(6), middle));
  }
  const auto [unit, offset] = near_lab::random_unit_and_offset(random);
  finish(grid, unit, offset, [&] { return random.coin(); });
  return grid;
}

std::vector<ObjectPair> all_questions(const GridScene& grid) {
  std::vector<ObjectPair> out;
  const auto n = static_cast<std::uint32_t>(grid.scene.objects.size());
  for (std::uint32_t a = 0; a < n; ++a)
    for (std::uint32_t b = a; b < n; ++b) out.push_back({a, b});
  return out;
}

// Any triangles of the objects; of the same one a pair in order.
std::optional<TrianglePair> random_hint(Random& random, const Scene& scene, const ObjectPair& q) {
  const Object &a = scene.objects[q.a], &b = scene.objects[q.b];
  if (a.triangle_count == 0 || b.triangle_count == 0 || random.below(3) == 0) return {};
  const auto pick = [&](const Object& o) {
    return o.first_triangle +
           static_cast<std::uint32_t>(random.below(static_cast<int>(o.triangle_count)));
  };
  return TrianglePair{pick(a), pick(b)};
}

// All questions of random scenes; returns how many answers were wrong, with the change that a twin
// makes to them.
int wrong_answers(int scenes, int most, const std::function<void(NearPairs&)>& change,
                  bool says = true) {
  Random random(static_cast<std::uint64_t>(scenes + most));
  int wrong = 0, ties = 0, zeros = 0, apart = 0;
  for (int k = 0; more_cases(k, scenes, ties > 2 && zeros > 2 && apart > 2); ++k) {
    const GridScene grid = random_scene(random, 2 + random.below(2), most);
    const ProximityTrees trees(grid.scene, 1);
    const std::vector<ObjectPair> questions = all_questions(grid);
    std::vector<std::optional<TrianglePair>> hints;
    for (const ObjectPair& q : questions) hints.push_back(random_hint(random, grid.scene, q));
    // The limit often is exactly a distance.
    const double within = random.coin() ? kInfinite : random.below(12) * grid.unit;
    std::vector<NearPairs> answers = trees.near_pairs(questions, within, hints);
    for (std::size_t i = 0; i < questions.size(); ++i) {
      const Truth truth = truth_of(grid, questions[i].a, questions[i].b);
      change(answers[i]);
      const std::string fault = fault_of(grid, truth, answers[i], within);
      if (says) {
        EXPECT_EQ(fault, "") << "scene " << k << ", question " << i << ", unit " << grid.unit
                             << ", within " << within << ", upper " << answers[i].upper << ", "
                             << answers[i].pairs.size() << " of " << truth.pairs.size()
                             << " pairs, squared " << static_cast<double>(truth.squared.numerator)
                             << "/" << static_cast<double>(truth.squared.denominator);
      }
      wrong += !fault.empty();
      ties += truth.pairs.size() > 1;
      zeros += truth.any && truth.squared.numerator == 0;
      apart += truth.any && truth.squared.numerator > 0;
    }
  }
  return wrong;
}

TEST(NearPairs, HoldsEveryNearestPairOfSmallScenes) {
  EXPECT_EQ(wrong_answers(trials(40'000), 6, [](NearPairs&) {}), 0);
}

TEST(NearPairs, HoldsEveryNearestPairOfManyRuns) {
  EXPECT_EQ(wrong_answers(trials(100), 150, [](NearPairs&) {}), 0);
}

// Few triangles meet, so the first pair that meets is seldom the first that is found.
TEST(NearPairs, HoldsTheFirstPairThatMeetsInASparseObject) {
  Random random(9);
  int meet = 0;
  for (int k = 0; more_cases(k, trials(1600), meet > 20); ++k) {
    GridScene grid;
    add_object(grid, near_lab::random_triangles(random, 40 + k % 200, 10 + k % 60, {0, 0, 0}));
    finish(grid, 1, 0, [] { return false; });
    const ObjectPair question = {0, 0};
    const Truth truth = truth_of(grid, 0, 0);
    meet += truth.squared.numerator == 0;
    const NearPairs answer =
        ProximityTrees(grid.scene, 1).near_pairs({&question, 1}, kInfinite, {}).front();
    EXPECT_EQ(fault_of(grid, truth, answer, kInfinite), "") << k;
  }
}

// More runs than the memory of a search holds, on either side.
TEST(NearPairs, HoldsEveryNearestPairOfRunsBeyondTheMemory) {
  Random random(8);
  for (int k = 0; k < trials(6, 2); ++k) {
    const int many = 16 * 16 * static_cast<int>(SearchMemory::kLeaves);
    GridScene grid;
    add_object(grid, near_lab::random_triangles(random, k % 2 == 0 ? many : 60, 28, {-30, 0, 0}));
    add_object(grid, near_lab::random_triangles(random, k % 2 == 0 ? 60 : many, 28, {34, 0, 0}));
    finish(grid, 1, 0, [] { return false; });
    const ObjectPair question = {0, 1};
    const NearPairs answer =
        ProximityTrees(grid.scene, 2).near_pairs({&question, 1}, kInfinite, {}).front();
    EXPECT_EQ(fault_of(grid, truth_of(grid, 0, 1), answer, kInfinite), "");
  }
}

// Twins: one pair lost, or a bound a little too small, does not pass.
TEST(NearPairs, TwinsOfAnswersAreCaught) {
  const auto loses_first = [](NearPairs& answer) {
    if (!answer.pairs.empty()) answer.pairs.erase(answer.pairs.begin());
  };
  EXPECT_GT(wrong_answers(300, 6, loses_first, false), 100);
  const auto shrinks = [](NearPairs& answer) { answer.upper *= 1 - 0x1p-40; };
  EXPECT_GT(wrong_answers(300, 6, shrinks, false), 20);
}

// The k nearest objects of each, by comparing all: k-th least distance, and who is at most as far;
// without `all` of those as far the lower ones.
std::string fault_of_nearest(const GridScene& grid, std::size_t k, double within,
                             const std::vector<NearPairs>& answers, bool all = true) {
  const auto n = static_cast<std::uint32_t>(grid.scene.objects.size());
  if (!std::ranges::is_sorted(answers, {}, &NearPairs::objects)) return "not sorted";
  std::vector<std::vector<Truth>> truth(n, std::vector<Truth>(n));
  for (std::uint32_t a = 0; a < n; ++a)
    for (std::uint32_t b = a + 1; b < n; ++b) truth[a][b] = truth[b][a] = truth_of(grid, a, b);
  for (std::uint32_t a = 0; a < n; ++a) {
    std::vector<Fraction> squares;
    for (const Truth& t : truth[a])
      if (t.any) squares.push_back(t.squared);
    std::ranges::sort(squares, [](const Fraction& x, const Fraction& y) { return x < y; });
    for (std::uint32_t b = 0; b < n; ++b) {
      const Truth& own = truth[a][b];
      if (!own.any || (k < squares.size() && squares[k - 1] < own.squared)) continue;
      std::size_t before = 0;
      for (std::uint32_t c = 0; c < n; ++c) {
        const Truth& other = truth[a][c];
        if (!other.any) continue;
        before += other.squared < own.squared || (other.squared == own.squared && c < b);
      }
      if (!all && before >= k) continue;
      if (!near_lab::at_most(own.squared, grid.unit, within)) continue;
      const ObjectPair objects = {std::min(a, b), std::max(a, b)};
      const auto found = std::ranges::find(answers, objects, &NearPairs::objects);
      if (found == answers.end()) return "a nearest object is missing";
      const std::string fault = fault_of(grid, own, *found, within);
      if (!fault.empty()) return fault;
    }
  }
  return "";
}

GridScene crowd(Random& random, int objects, int wide = 24) {
  GridScene grid;
  for (int o = 0; o < objects; ++o) {
    near_lab::Triple<near_lab::Integer> middle;
    for (auto& x : middle) x = random.below(2 * wide + 1) - wide;
    add_object(grid, near_lab::random_triangles(random, random.below(5), 3, middle));
  }
  const auto [unit, offset] = near_lab::random_unit_and_offset(random);
  finish(grid, unit, offset, [&] { return random.coin(); });
  return grid;
}

TEST(NearestObjects, AreFoundWithAllThatAreAsNear) {
  Random random(3);
  int culled = 0, caught = 0;
  for (int k = 0; more_cases(k, trials(400), culled > 20 && caught > 20); ++k) {
    const GridScene grid = crowd(random, 2 + random.below(40));
    const auto most = static_cast<std::size_t>(1 + random.below(3));
    const double within = random.coin() ? kInfinite : random.below(20) * grid.unit;
    std::vector<NearPairs> answers = ProximityTrees(grid.scene, 1).nearest_objects(most, within);
    EXPECT_EQ(fault_of_nearest(grid, most, within, answers), "") << "scene " << k;
    const std::size_t n = grid.scene.objects.size();
    culled += answers.size() < n * (n - 1) / 4;
    // A twin that loses one of the answers.
    if (answers.empty()) continue;
    answers.pop_back();
    caught += !fault_of_nearest(grid, most, within, answers).empty();
  }
}

// Many small objects whose boxes overlap: each asks about all triangles at once. Most meet others.
TEST(NearestObjects, OfOverlappingObjectsAreFound) {
  Random random(13);
  for (int k = 0; k < trials(4); ++k) {
    const GridScene grid = crowd(random, 150, 1);
    const std::vector<Box> boxes = object_boxes(grid.scene, triangle_boxes(grid.scene));
    std::size_t overlapping = 0;
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = a + 1; b < boxes.size(); ++b) overlapping += overlap(boxes[a], boxes[b]);
    }
    ASSERT_GT(overlapping, 16u * boxes.size());  // so that objects do ask about all triangles
    const auto most = static_cast<std::size_t>(1 + random.below(3));
    const double within = random.coin() ? kInfinite : random.below(3) * grid.unit;
    const ProximityTrees trees(grid.scene, 1 + k % 2);
    for (const bool all : {true, false}) {
      EXPECT_EQ(
          fault_of_nearest(grid, most, within,
                           all ? trees.nearest_objects(most, within)
                               : trees.nearest_objects(most, within, std::span<const NearHint>()),
                           all),
          "")
          << "scene " << k;
    }
  }
}

// How many searches of all triangles lose the first of the nearest objects. forged: they believe
// that the object after the one that asks meets it.
int lost_of_all_triangles(bool forged) {
  Random random(14);
  int lost = 0;
  for (int k = 0; k < 20; ++k) {
    const GridScene grid = crowd(random, 30, 6);
    const SceneTrees trees(grid.scene, 1);
    Scene whole = grid.scene;
    whole.objects = {{"all", 0, static_cast<std::uint32_t>(whole.triangles.size()), false}};
    const SceneTrees all(whole, 1);
    const std::vector<std::uint32_t> owner = owners(grid.scene);
    for (std::uint32_t o = 0; o + 1 < 30; ++o) {
      const auto count = [&](std::uint32_t of) { return grid.scene.objects[of].triangle_count; };
      if (count(o) == 0 || count(o + 1) == 0) continue;
      Others others{
          .all = &all, .scene = grid.scene, .owner = owner, .object = o, .k = 1, .ties = false};
      const auto first = [&](std::uint32_t of) { return grid.scene.objects[of].first_triangle; };
      if (forged) others.add({first(o), first(o + 1)}, 0);
      SearchMemory memory;
      Search search = begin_search(trees, o, kInfinite, others, memory);
      go_on(trees, SIZE_MAX, search, memory);
      std::optional<Fraction> least;
      std::uint32_t nearest = 0;
      for (std::uint32_t other = 0; other < 30; ++other) {
        if (other == o) continue;
        const Truth truth = truth_of(grid, std::min(o, other), std::max(o, other));
        if (!truth.any || (least && !(truth.squared < *least))) continue;
        least = truth.squared;
        nearest = other;
      }
      lost += std::ranges::none_of(
          search.kept, [&](const KeptPair& kept) { return others.other_of(kept.pair) == nearest; });
    }
  }
  return lost;
}
TEST(NearestObjects, AmongAllTrianglesTheNearestIsKept) {
  EXPECT_EQ(lost_of_all_triangles(false), 0);
}
TEST(NearestObjectsTwin, AfterAnObjectThatDoesNotMeetTheNearestIsLost) {
  EXPECT_GT(lost_of_all_triangles(true), 0);
}

// Hints of all kinds: the nearest pairs, any others, of one object, of objects and triangles that
// are not there, twice.
TEST(NearestObjects, HintsChangeNoAnswerAndSaveWork) {
  Random random(9);
  ProximityCounts without, with;
  for (int k = 0; k < trials(200); ++k) {
    const GridScene grid = crowd(random, 2 + random.below(40));
    const auto n = static_cast<std::uint32_t>(grid.scene.objects.size());
    const auto most = static_cast<std::size_t>(1 + random.below(3));
    const double within = random.coin() ? kInfinite : random.below(20) * grid.unit;
    std::vector<NearHint> hints;
    for (int h = random.below(100); h > 0; --h) {
      const ObjectPair objects = {static_cast<std::uint32_t>(random.below(static_cast<int>(n))),
                                  static_cast<std::uint32_t>(random.below(static_cast<int>(n)))};
      const auto hint = random_hint(random, grid.scene, objects);
      hints.push_back({objects, hint ? *hint : TrianglePair{1, 10'000}});
    }
    hints.push_back({{0, n}, {0, 1}});
    const ProximityTrees any(grid.scene, 1);
    EXPECT_EQ(fault_of_nearest(grid, most, within, any.nearest_objects(most, within, hints), false),
              "")
        << "scene " << k;
    // Good ones: all triangles of each object are moved a little, and were nearest before.
    const ProximityTrees first(grid.scene, 1), second(grid.scene, 1);
    hints.clear();
    for (const NearPairs& near : first.nearest_objects(most, kInfinite))
      if (!near.pairs.empty()) hints.push_back({near.objects, near.pairs.front()});
    without.box_pairs += first.counts().box_pairs;
    without.triangle_pairs += first.counts().triangle_pairs;
    EXPECT_EQ(fault_of_nearest(grid, most, kInfinite,
                               second.nearest_objects(most, kInfinite, hints), false),
              "")
        << "scene " << k;
    with.box_pairs += second.counts().box_pairs;
    with.triangle_pairs += second.counts().triangle_pairs;
  }
  EXPECT_LT(with.box_pairs, without.box_pairs);
  EXPECT_LT(with.triangle_pairs, without.triangle_pairs);
}

// An object that has appeared or vanished since the frame before makes hints of triangles of a
// third object, which is nearer: their distance bounds nothing.
TEST(NearPairs, AHintOfAnotherObjectIsNoBound) {
  const auto at = [](double x) {
    return std::vector{std::array{Vec3(x, 0, 0), Vec3(x, 1, 0), Vec3(x, 0, 1)}};
  };
  const Scene scene = lab::scene_of({at(0), at(100), at(-1)});
  const ProximityTrees trees(scene, 1);
  const std::vector<ObjectPair> question = {{0, 1}};
  for (const TrianglePair& wrong : {TrianglePair{0, 2}, TrianglePair{1, 2}}) {
    const std::vector<std::optional<TrianglePair>> hints = {wrong};
    const std::vector<NearPairs> near = trees.near_pairs(question, kInfinite, hints);
    ASSERT_EQ(near.size(), 1u);
    EXPECT_EQ(near[0].pairs, (std::vector<TrianglePair>{{0, 1}}));
    const std::vector<NearHint> of_objects = {{{0, 1}, wrong}};
    const std::vector<NearPairs> nearest = trees.nearest_objects(1, kInfinite, of_objects);
    ASSERT_EQ(nearest.size(), 2u);
    EXPECT_EQ(nearest[0].pairs, (std::vector<TrianglePair>{{0, 1}}));
    EXPECT_EQ(nearest[1].pairs, (std::vector<TrianglePair>{{0, 2}}));
  }
}

// The same scenes with any number of threads, on any instruction set: the same bits and counts.
TEST(NearPairs, AreTheSameForAnyThreadsAndInstructionSet) {
  Random random(5);
  for (int k = 0; k < trials(20); ++k) {
    const GridScene grid = random_scene(random, 3, k % 5 == 0 ? 3000 : 60);
    const std::vector<ObjectPair> questions = all_questions(grid);
    std::vector<NearPairs> expected, expected_nearest;
    ProximityCounts counts;
    for (const std::string& target : lane_targets()) {
      use_lane_target(target);
      for (const unsigned threads : {1u, 2u, 3u}) {
        const ProximityTrees trees(grid.scene, threads);
        const std::vector<NearPairs> pairs = trees.near_pairs(questions, kInfinite, {});
        const std::vector<NearPairs> nearest = trees.nearest_objects(1, kInfinite);
        if (expected.empty()) {
          expected = pairs;
          expected_nearest = nearest;
          counts = trees.counts();
        }
        EXPECT_TRUE(std::ranges::equal(pairs, expected, same)) << target << ", " << threads;
        EXPECT_TRUE(std::ranges::equal(nearest, expected_nearest, same)) << target;
        EXPECT_EQ(trees.counts().box_pairs, counts.box_pairs) << target << ", " << threads;
        EXPECT_EQ(trees.counts().triangle_pairs, counts.triangle_pairs);
        EXPECT_EQ(trees.counts().kept, counts.kept);
      }
    }
    use_lane_target("");
  }
}

// A hint changes what is looked at, not what is found; nonsense is no hint.
TEST(NearPairs, HintsSaveWork) {
  Random random(6);
  GridScene grid;
  add_object(grid, near_lab::random_triangles(random, 3000, 30, {-30, 0, 0}));
  add_object(grid, near_lab::random_triangles(random, 3000, 30, {33, 0, 0}));
  finish(grid, 0x1p-20, 0x1p20, [] { return false; });
  const ObjectPair question = {0, 1};
  const auto ask = [&](std::optional<TrianglePair> hint, ProximityCounts& counts) {
    const ProximityTrees trees(grid.scene, 1);
    NearPairs out = std::move(trees.near_pairs({&question, 1}, kInfinite, {&hint, 1}).front());
    counts = trees.counts();
    return out;
  };
  ProximityCounts without, with, nonsense;
  const NearPairs answer = ask({}, without);
  ASSERT_FALSE(answer.pairs.empty());
  EXPECT_TRUE(same(ask(answer.pairs.front(), with), answer));
  EXPECT_LE(with.triangle_pairs, without.triangle_pairs);
  for (const TrianglePair hint : {TrianglePair{5, 4}, TrianglePair{1, 2}, TrianglePair{0, 6000},
                                  TrianglePair{4000, 4001}, TrianglePair{7, 7}}) {
    EXPECT_TRUE(same(ask(hint, nonsense), answer));
    EXPECT_EQ(nonsense.triangle_pairs, without.triangle_pairs);
  }
  // Most is culled: 9 million pairs.
  EXPECT_LT(without.triangle_pairs, 9'000'000u / 20);
}

// Two stacks of equal triangles: each pair is as near as any other.
TEST(NearPairs, MoreThanThereIsRoomForIsAnError) {
  GridScene grid;
  const near_lab::Corners<near_lab::Integer> low = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const near_lab::Corners<near_lab::Integer> high = {{{0, 0, 9}, {1, 0, 9}, {0, 1, 9}}};
  add_object(grid, std::vector(1200, low));
  add_object(grid, std::vector(1100, high));
  finish(grid, 1, 0, [] { return false; });
  const SceneTrees trees(grid.scene, 2);
  for (const bool fits : {true, false}) {
    SearchMemory memory;
    Search search = begin_search(trees, {0, 1}, kInfinite, nullptr, memory);
    go_on(trees, 100, search, memory);
    ASSERT_FALSE(search.open.empty());
    const std::size_t pairs = 1200 * 1100;
    if (fits) {
      go_on_divided(trees, 2, search, pairs);
      EXPECT_EQ(answer(trees, search).pairs.size(), pairs);
      EXPECT_EQ(search.counts.triangle_pairs, pairs + 1);  // the first one is looked at twice
    } else {
      EXPECT_THROW(go_on_divided(trees, 2, search, pairs - 1), Error);
    }
  }
}

// All pairs within a distance, by comparing all; a twin loses one.
TEST(PairsWithin, AreAllThatAreAndFewMore) {
  Random random(12);
  std::size_t expected = 0, found = 0;
  int caught = 0;
  for (int k = 0; more_cases(k, trials(300), caught > 20 && expected > 20); ++k) {
    GridScene grid = random_scene(random, 3, 40);
    for (Object& object : grid.scene.objects) object.self = random.coin();
    const double within = random.below(8) * grid.unit;
    if (!std::isfinite(within)) continue;
    const ProximityTrees trees(grid.scene, 1 + k % 2);
    std::vector<TrianglePair> pairs = trees.pairs_within(within, SIZE_MAX);
    ASSERT_TRUE(std::ranges::is_sorted(pairs));
    ASSERT_EQ(std::ranges::adjacent_find(pairs), pairs.end());
    const std::vector<std::uint32_t> owner = owners(grid.scene);
    std::vector<TrianglePair> truth;
    for (std::uint32_t i = 0; i < grid.corners.size(); ++i) {
      for (std::uint32_t j = i + 1; j < grid.corners.size(); ++j) {
        const bool asked =
            owner[i] != owner[j] || (grid.scene.objects[owner[i]].self &&
                                     !near_lab::share_position(grid.corners[i], grid.corners[j]));
        const auto squared = near_lab::squared_distance(grid.corners[i], grid.corners[j]);
        if (asked && near_lab::at_most(squared, grid.unit, within)) truth.push_back({i, j});
      }
    }
    ASSERT_TRUE(std::ranges::includes(pairs, truth)) << k;
    expected += truth.size();
    found += pairs.size();
    if (truth.empty()) continue;
    std::erase(pairs, truth[truth.size() / 2]);
    caught += !std::ranges::includes(pairs, truth);
  }
  EXPECT_LT(found, expected + expected / 8);
}

// They are counted while they are listed: 2.25 million pairs, of which a limit allows 20,000.
TEST(PairsWithin, MoreThanAskedForIsAnError) {
  GridScene grid;
  const near_lab::Corners<near_lab::Integer> low = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  add_object(grid, std::vector(1500, low));
  add_object(grid, std::vector(1500, low));
  finish(grid, 1, 0, [] { return false; });
  for (const unsigned threads : {1u, 2u}) {
    const ProximityTrees trees(grid.scene, threads);
    EXPECT_THROW(trees.pairs_within(0, 20'000), Error);
    EXPECT_THROW(trees.pairs_within(0, 2'249'999), Error);
    EXPECT_EQ(trees.pairs_within(0, 2'250'000).size(), 2'250'000u);
    EXPECT_EQ(trees.pairs_within(0, 2'000'000, {}, 250'000).size(), 2'250'000u);
    const Error error = error_of([&] { trees.pairs_within(0, 2'000'000, {}, 249'999); });
    EXPECT_TRUE(has_text(error.reason, "more than 2000000 pairs of triangles")) << error.what();
    EXPECT_THROW(trees.pairs_within(kInfinite, 1), std::logic_error);
    EXPECT_THROW(trees.pairs_within(-1, 1), std::logic_error);
  }
}

TEST(NearPairs, RefusesWhatIsNoQuestion) {
  Random random(7);
  GridScene grid;
  add_object(grid, near_lab::random_triangles(random, 3, 3, {0, 0, 0}));
  add_object(grid, {});
  finish(grid, 1, 0, [] { return false; });
  const ProximityTrees trees(grid.scene);
  const std::vector<ObjectPair> good = {{0, 1}}, reversed = {{1, 0}}, beyond = {{0, 2}};
  EXPECT_THROW(trees.near_pairs(reversed, 1, {}), std::logic_error);
  EXPECT_THROW(trees.near_pairs(beyond, 1, {}), std::logic_error);
  EXPECT_THROW(trees.near_pairs(good, -1, {}), std::logic_error);
  EXPECT_THROW(trees.near_pairs(good, std::nan(""), {}), std::logic_error);
  EXPECT_THROW(trees.nearest_objects(1, -1), std::logic_error);
  const std::vector<std::optional<TrianglePair>> hints(2);
  EXPECT_THROW(trees.near_pairs(good, 1, hints), std::logic_error);
  EXPECT_TRUE(trees.near_pairs(good, 1, {}).front().pairs.empty());
  EXPECT_TRUE(trees.near_pairs({}, 1, {}).empty());
  EXPECT_TRUE(trees.nearest_objects(0, kInfinite).empty());
  EXPECT_TRUE(trees.nearest_objects(1, kInfinite).empty());
  const Scene nothing;
  EXPECT_TRUE(ProximityTrees(nothing).nearest_objects(1, kInfinite).empty());
}

}  // namespace
}  // namespace farcull
