// Accounting puts every pair into the right class, and notices faults of its own steps.
#include "verify/accounting.h"

#include <rapidcheck/gtest.h>

#include "tests/lab/reference.h"
#include "tests/lab/test.h"
#include "verify/certificate/box_pairs.h"

namespace farcull {
namespace {

using reference::Triangle;
using Pairs = std::vector<TrianglePair>;

bool is_ignored(const Scene& scene, const TrianglePair& pair,
                const std::vector<ObjectPair>& ignored) {
  const auto owner = [&](std::uint32_t triangle) {
    std::uint32_t o = 0;
    while (triangle - scene.objects[o].first_triangle >= scene.objects[o].triangle_count) ++o;
    return o;
  };
  const ObjectPair objects{owner(pair.a), owner(pair.b)};
  return std::ranges::find(ignored, objects) != ignored.end();
}

/// Every class recounted over all pairs, by the reference.
Accounting recount(const Scene& scene, const Pairs& kept, const AccountOptions& options) {
  Accounting result;
  reference::for_each_pair(
      scene,
      [&](const TrianglePair& pair, bool overlapping) {
        ++result.pairs_total;
        if (is_ignored(scene, pair, options.ignored)) {
          ++result.ignored;
        } else if (std::ranges::binary_search(kept, pair)) {
          ++result.pairs_kept;
        } else if (!overlapping) {
          ++result.certified_by_boxes;
        } else if (reference::collides(scene, pair, options.clearance)) {
          ++result.false_negatives;
          if (result.examples.size() < options.max_examples) result.examples.push_back(pair);
        } else if (reference::neighbours(scene, pair)) {
          ++result.neighbours;
        } else {
          ++result.certified_by_predicates;
        }
      },
      options.clearance);
  return result;
}

void expect_equal(const Accounting& a, const Accounting& b) {
  EXPECT_EQ(a.pairs_total, b.pairs_total);
  EXPECT_EQ(a.ignored, b.ignored);
  EXPECT_EQ(a.pairs_kept, b.pairs_kept);
  EXPECT_EQ(a.certified_by_boxes, b.certified_by_boxes);
  EXPECT_EQ(a.neighbours, b.neighbours);
  EXPECT_EQ(a.certified_by_predicates, b.certified_by_predicates);
  EXPECT_EQ(a.false_negatives, b.false_negatives);
  EXPECT_EQ(a.examples, b.examples);
  EXPECT_TRUE(a.adds_up());
}

/// Triangles along the x axis: (x, 0, 0), (x + 1, 0, 0), (x, 1, 0) at height z.
Triangle tile(double x, double z = 0) { return {Vec3(x, 0, z), Vec3(x + 1, 0, z), Vec3(x, 1, z)}; }

/// Overlaps the box of tile(x) without meeting it.
Triangle beyond_the_hypotenuse(double x) {
  return {Vec3(x + 1, 1, 0), Vec3(x + 0.75, 1, 0), Vec3(x + 1, 0.75, 0)};
}

/// 0, 1: tiles; 2 meets 0; 3 overlaps the box of 1 only; 4 is far from everything.
Scene example() {
  return reference::scene_of(
      {{tile(0), tile(8)}, {tile(0.5), beyond_the_hypotenuse(8)}, {}, {tile(100)}});
}

TEST(Accounting, PutsEachPairInItsClass) {
  const Accounting a = account(example(), Pairs{{0, 2}});
  EXPECT_EQ(a.pairs_total, 8u);  // 2 * 2 + 4 * 1
  EXPECT_EQ(a.pairs_kept, 1u);
  EXPECT_EQ(a.certified_by_predicates, 1u);
  EXPECT_EQ(a.certified_by_boxes, 6u);
  EXPECT_EQ(a.neighbours, 0u);
  EXPECT_EQ(a.false_negatives, 0u);
  EXPECT_TRUE(a.examples.empty());
  EXPECT_TRUE(a.adds_up());
  EXPECT_GE(a.ms, 0);
}

TEST(Accounting, IgnoredObjectsAreAClassOfTheirOwn) {
  const Accounting first = account(example(), {}, {.ignored = {{0, 1}}});
  EXPECT_EQ(first.pairs_total, 8u);
  EXPECT_EQ(first.ignored, 4u);
  EXPECT_EQ(first.certified_by_boxes, 4u);
  EXPECT_EQ(first.false_negatives, 0u);
  EXPECT_TRUE(first.adds_up());
  // The twin: what collides is missed where other objects are ignored.
  EXPECT_EQ(account(example(), {}, {.ignored = {{0, 3}, {1, 3}}}).false_negatives, 1u);
  EXPECT_THROW(account(example(), Pairs{{0, 2}}, {.ignored = {{0, 1}}}), std::logic_error);
  EXPECT_THROW(account(example(), {}, {.ignored = {{1, 0}}}), std::logic_error);
  EXPECT_THROW(account(example(), {}, {.ignored = {{0, 4}}}), std::logic_error);
  EXPECT_THROW(account(example(), {}, {.ignored = {{0, 1}, {0, 1}}}), std::logic_error);
}

TEST(Accounting, DoesNotAddUpWhenAClassIsWrong) {
  Accounting a = account(example(), {});
  ASSERT_TRUE(a.adds_up());
  ++a.certified_by_boxes;
  EXPECT_FALSE(a.adds_up());
}

TEST(Accounting, ReturnsTheFirstExamplesInSortedOrder) {
  const std::vector<Triangle> copies(40, tile(0));
  const Scene scene = reference::scene_of({copies, copies});
  EXPECT_EQ(account(scene, {}).examples.size(), 10u);
  EXPECT_EQ(account(scene, {}, {.max_examples = 0}).examples.size(), 0u);
  const Accounting a = account(scene, Pairs{{0, 40}}, {.max_examples = 3});
  EXPECT_EQ(a.examples, (Pairs{{0, 41}, {0, 42}, {0, 43}}));
  EXPECT_EQ(a.false_negatives, 1599u);
}

// Overlapping pairs are decided in portions of 2^18.
TEST(Accounting, CountsMoreOverlapsThanOnePortion) {
  const std::vector<Triangle> copies(700, tile(0));
  const Scene scene = reference::scene_of({copies, copies, {tile(0.5), beyond_the_hypotenuse(0)}});
  const Accounting a = account(scene, Pairs{{0, 701}}, {.max_examples = 2});
  EXPECT_EQ(a.pairs_total, 490'000u + 2 * 1400u);
  EXPECT_EQ(a.false_negatives, 490'000u + 1400u - 1);
  EXPECT_EQ(a.certified_by_predicates, 1400u);
  EXPECT_EQ(a.examples, (Pairs{{0, 700}, {0, 702}}));
  EXPECT_TRUE(a.adds_up());
}

TEST(Accounting, RefusesWhatItWouldMiscount) {
  const Scene scene = example();
  EXPECT_THROW(account(scene, Pairs{{0, 3}, {0, 2}}), std::logic_error);  // unsorted
  EXPECT_THROW(account(scene, Pairs{{0, 2}, {0, 2}}), std::logic_error);  // twice
  EXPECT_THROW(account(scene, Pairs{{2, 0}}), std::logic_error);          // b < a
  EXPECT_THROW(account(scene, Pairs{{0, 1}}), std::logic_error);          // one object
  EXPECT_THROW(account(scene, Pairs{{0, 5}}), std::logic_error);          // out of range
  Scene gap = scene;
  gap.objects[1].first_triangle = 3;
  EXPECT_THROW(account(gap, {}), std::logic_error);
  Scene uncovered = scene;
  uncovered.objects.pop_back();
  EXPECT_THROW(account(uncovered, {}), std::logic_error);
}

TEST(Accounting, HoldsAtTheEndsOfTheDoubles) {
  constexpr double kMax = std::numeric_limits<double>::max();
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  std::vector<Triangle> wild;
  for (const double s : {kTiny, 1e-300, 1.0, 1e300, kMax}) {
    wild.push_back({Vec3(-s, 0, 0), Vec3(s, 0, -0.0), Vec3(0, s, s)});
    wild.push_back({Vec3(s, s, s), Vec3(s, s, s), Vec3(-s, -s, -s)});
    wild.push_back({Vec3(s, s, kTiny), Vec3(s, s, kTiny), Vec3(s, s, kTiny)});
  }
  const Scene scene = reference::scene_of({wild, wild, {wild.rbegin(), wild.rend()}});
  expect_equal(account(scene, {}), recount(scene, {}, {}));
}

RC_GTEST_PROP(AccountingProperty, EachClassAsRecountedOverAllPairs, ()) {
  const int object_count = *rc::gen::inRange(0, 6);
  const int extent = *rc::gen::inRange(1, 7);
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  const int self_one_in = *rc::gen::inRange(1, 4);
  Scene scene = reference::grid_scene(random, object_count, extent, 4);
  for (Object& object : scene.objects) object.self = random() % self_one_in == 0;
  const unsigned keep_one_in = *rc::gen::inRange(1, 6);
  std::vector<ObjectPair> ignored;
  for (std::uint32_t a = 0; a < scene.objects.size(); ++a) {
    for (std::uint32_t b = a + 1; b < scene.objects.size(); ++b)
      if (random() % 4 == 0) ignored.push_back({a, b});
  }
  Pairs kept;  // of all pairs that are not ignored, so that some have disjoint boxes
  reference::for_each_pair(scene, [&](const TrianglePair& pair, bool) {
    if (random() % keep_one_in == 0 && !is_ignored(scene, pair, ignored)) kept.push_back(pair);
  });
  const AccountOptions options = {
      .clearance = *rc::gen::element(0.0, 0.0, 0.5, 0.57735026918962573, 1.0, 3.0),
      .max_examples = *rc::gen::inRange<std::size_t>(0, 12),
      .ignored = ignored};
  expect_equal(account(scene, kept, options), recount(scene, kept, options));
  RC_ASSERT(!::testing::Test::HasFailure());
}

/// Two triangles of a sheet, then one that pierces the first from their common edge's end.
Scene sheet_with_a_fin(bool self) {
  const Vec3 o(0, 0, 0), x(4, 0, 0), y(0, 4, 0), xy(4, 4, 0);
  Scene scene = reference::scene_of({{{o, x, y}, {x, xy, y}, {o, Vec3(3, 1, 1), Vec3(2, 1, -1)}}});
  scene.objects[0].self = self;
  return scene;
}

TEST(AccountingSelf, CountsInnerPairsOnlyWhereTheObjectIsSelf) {
  expect_equal(account(sheet_with_a_fin(false), {}), Accounting{});
  const Accounting a = account(sheet_with_a_fin(true), {});
  EXPECT_EQ(a.pairs_total, 3u);
  EXPECT_EQ(a.neighbours, 1u);               // the two of the sheet share their edge
  EXPECT_EQ(a.certified_by_predicates, 1u);  // the fin ends before the second
  EXPECT_EQ(a.false_negatives, 1u);          // and pierces the first
  EXPECT_EQ(a.examples, (Pairs{{0, 2}}));
  EXPECT_TRUE(a.adds_up());
}

TEST(AccountingSelf, ANeighbourThatIsKeptIsNotMissed) {
  const Accounting a = account(sheet_with_a_fin(true), Pairs{{0, 2}});
  EXPECT_EQ(a.pairs_kept, 1u);
  EXPECT_EQ(a.false_negatives, 0u);
  EXPECT_TRUE(a.adds_up());
  EXPECT_THROW(account(sheet_with_a_fin(false), Pairs{{0, 2}}), std::logic_error);
}

TEST(AccountingClearance, ComparesDistancesExactly) {
  const double gap = std::nextafter(2.0, 3.0) - 1;  // 1 + ulp(2), between tile(0, z) and tile(0)
  const Scene scene = reference::scene_of({{tile(0)}, {tile(0, gap)}});
  EXPECT_EQ(account(scene, {}, {.clearance = gap}).false_negatives, 1u);
  const double less = std::nextafter(gap, 0.0);
  EXPECT_EQ(account(scene, {}, {.clearance = less}).certified_by_boxes, 1u);
  // Diagonally: boxes are 3 and 4 apart, so 5 decides.
  const Triangle far = {Vec3(4, 4, 0), Vec3(5, 4, 0), Vec3(4, 5, 0)};
  const Triangle point = {Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0)};
  const Scene diagonal = reference::scene_of({{point}, {far}});
  EXPECT_EQ(account(diagonal, {}, {.clearance = 5}).false_negatives, 1u);
  EXPECT_EQ(account(diagonal, {}, {.clearance = std::nextafter(5.0, 0.0)}).certified_by_predicates,
            1u);
  for (const double wrong :
       {-1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(account(scene, {}, {.clearance = wrong}), std::logic_error);
}

// ---- twins that must fail ----

/// Pairs of every class: 0 and 1 are neighbours that do not meet, 0 and 2 neighbours that do; 1
/// meets 3; the boxes of 0 and 3 overlap, those of 3 and 4 do not.
Scene scene_of_every_class() {
  const Vec3 o(0, 0, 0), x(4, 0, 0), y(0, 4, 0), xy(4, 4, 0);
  Scene scene =
      reference::scene_of({{{o, x, y}, {x, xy, y}, {o, Vec3(3, 1, 1), Vec3(2, 1, -1)}},
                           {{Vec3(3, 3, -1), Vec3(3, 3, 1), Vec3(3.5, 3, 1)},
                            {Vec3(0.1, 0.1, 1), Vec3(0.2, 0.1, -0.1), Vec3(0.1, 0.2, 0.5)}}});
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

TEST(AccountingTwin, AnAnswerThatIsNotGivenThrows) {
  using enum PairAnswer;
  const Pairs pairs = {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}};
  std::vector<PairAnswer> answers = {apart, colliding, neighbours_apart, neighbours_colliding,
                                     neighbours_unasked};
  const Collisions all = count_answers(pairs, answers);
  EXPECT_EQ(all.apart, 1u);
  EXPECT_EQ(all.pairs, Pairs({{0, 2}}));
  EXPECT_EQ(all.neighbours_apart, 1u);
  EXPECT_EQ(all.neighbour_pairs, Pairs({{0, 4}}));
  EXPECT_EQ(all.neighbours, 3u);
  for (PairAnswer& answer : answers) {
    const PairAnswer given = std::exchange(answer, undecided);
    EXPECT_THROW(count_answers(pairs, answers), std::logic_error);
    answer = given;
  }
  EXPECT_EQ(std::vector<PairAnswer>(1), std::vector{undecided});  // what nobody assigns
  answers.pop_back();
  EXPECT_THROW(count_answers(pairs, answers), std::logic_error);
}

TEST(AccountingTwin, AClassThatIsNotCountedThrows) {
  const Scene scene = scene_of_every_class();
  AccountingSteps parts{decide, pairs_with_overlapping_boxes};
  const Accounting right = account(scene, {}, {}, parts);
  ASSERT_GE(right.neighbours, 1u);
  ASSERT_GE(right.certified_by_predicates, 1u);
  ASSERT_GE(right.certified_by_boxes, 1u);
  ASSERT_GE(right.false_negatives, 2u);
  int classes = 0;
  const auto expect_caught = [&](const std::function<void(Collisions&)>& forget) {
    parts.decide = [&](const Scene& s, std::span<const TrianglePair> p, const ExactQuestion& q) {
      Collisions found = decide(s, p, q);
      forget(found);
      return found;
    };
    EXPECT_THROW(account(scene, {}, {}, parts), std::logic_error);
    ++classes;
  };
  expect_caught([](Collisions& found) { found.apart = 0; });
  expect_caught([](Collisions& found) { found.neighbours_apart = 0; });
  expect_caught([](Collisions& found) { found.pairs.pop_back(); });
  expect_caught([](Collisions& found) { found.neighbour_pairs.pop_back(); });
  expect_caught([](Collisions& found) { ++found.apart; });
  EXPECT_EQ(classes, 5);
}

TEST(AccountingTwin, AnEnumerationThatLosesABoxPairThrows) {
  const Scene scene = scene_of_every_class();
  for (const double clearance : {0.0, 0.25}) {
    BoxPairs enumeration(scene, clearance);
    Pairs pairs;
    ASSERT_TRUE(enumeration.next(pairs, 1000));
    ASSERT_GE(pairs.size(), 4u);
    const auto with = [&](const Pairs& enumerated) {
      const auto overlapping = [&](const Scene&, double) {
        PairSet set;
        for (const TrianglePair& pair : enumerated) set.add(pair);
        return set;
      };
      return account(scene, {}, {.clearance = clearance}, {decide, overlapping});
    };
    EXPECT_TRUE(with(pairs).adds_up());
    for (std::size_t lost = 0; lost < pairs.size(); ++lost) {
      Pairs fewer = pairs;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(lost));
      EXPECT_THROW(with(fewer), std::logic_error);
      fewer.push_back(fewer.front());  // as many as before
      EXPECT_THROW(with(fewer), std::logic_error);
    }
  }
}

}  // namespace
}  // namespace farcull
