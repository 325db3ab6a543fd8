// Distances against comparing all triangles with all in rational numbers, bit for bit.
// The truth that large scenes are compared with is compared with one that leaves out less.
#include "experiments/method/distances.h"

#include "experiments/scenes/builtin/scenes.h"
#include "tests/experiments/method/distance_truth.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using distance_lab::Answer, distance_lab::answers_of, distance_lab::moved_apart,
    distance_lab::Truth;
using enum DistancePairs;

std::vector<DistanceOptions> questions(rational::Draws& random, double unit) {
  const double within = unit * random.below(40);
  return {{.pairs = objects},
          {.pairs = objects, .within = within, .threads = 2},
          {.pairs = nearest, .k = 1u + random.below(3u)},
          {.pairs = nearest, .k = 1u + random.below(3u), .within = within},
          {.pairs = all, .within = within / 4}};
}

/// Triangles on a grid, where many pairs are as near or meet; or, in small scenes, anywhere in a
/// cube, of many magnitudes, or moved off the grid by some units in the last place.
Scene any_scene(rational::Draws& random, int kind) {
  if (kind == 0) return distance_lab::random_scene(random, 1 + random.below(6), 12);
  Scene scene = distance_lab::random_scene(random, 2 + random.below(3), 6);
  for (Vec3& p : scene.vertices) {
    if (kind == 1) p = random.cube(1);
    if (kind == 2) p = random.scaled3(-40, 1);
    for (int k = 0; k < 3 && kind == 3; ++k)
      for (int steps = random.below(4); steps > 0; --steps)
        p[k] = std::nextafter(p[k], random.coin() ? 1e300 : -1e300);
  }
  return scene;
}

// FARCULL_DISTANCES=100000 for the campaign.
TEST(Distances, EqualABruteForceOnRandomScenes) {
  const char* const wish = std::getenv("FARCULL_DISTANCES");
  const int least = wish != nullptr ? std::stoi(wish) : trials(120);
  rational::Draws random(1);
  int answers = 0, touching = 0, nothing = 0;
  const auto seen = [&] { return touching > 5 && answers > touching && nothing > 0; };
  for (int k = 0; more_cases(k, least, seen()); ++k) {
    const Scene scene = any_scene(random, k % 4);
    double unit = 1;
    for (const Vec3& p : scene.vertices) unit = std::max(unit, p.cwiseAbs().maxCoeff());
    const Truth truth(scene);
    for (DistanceOptions options : questions(random, std::min(unit / 20, 1e300))) {
      options.verify = true;
      if (!nothing_asked(scene, options).empty()) {
        ++nothing;
        EXPECT_THROW(distances(scene, options), Error);
        continue;
      }
      const DistanceRecord record = distances(scene, options);
      ASSERT_EQ(answers_of(record), truth.answers(options)) << k;
      ASSERT_TRUE(record.verification->holds()) << k;
      ASSERT_TRUE(record.verification->adds_up()) << k;
      answers += static_cast<int>(record.distances.size());
      for (const Distance& d : record.distances) touching += d.closest.squared.is_zero();
    }
  }
}

// Small ones: a brute force takes the product of the numbers of triangles.
TEST(Distances, EqualABruteForceOnBuiltInScenesMovedApart) {
  for (const char* name : {"degenerate", "slivers:20", "mixed:4", "gap:12", "needles:8"}) {
    for (const double diagonals : {0.0, 1e-12, 1e-3, 1.0, 1e3}) {
      const Scene scene = moved_apart(make_builtin_scene(name), diagonals);
      const DistanceOptions options = {.verify = true};
      const DistanceRecord record = distances(scene, options);
      EXPECT_EQ(answers_of(record), Truth(scene).answers(options)) << name << " " << diagonals;
      EXPECT_TRUE(record.verification->holds()) << name << " " << diagonals;
    }
  }
}

bool same(const DistanceRecord& x, const DistanceRecord& y) {
  return std::ranges::equal(x.distances, y.distances, [](const Distance& a, const Distance& b) {
    return a.objects == b.objects && a.triangles == b.triangles && a.inside == b.inside &&
           a.closest.distance == b.closest.distance && a.closest.squared == b.closest.squared &&
           a.closest.points == b.closest.points && a.closest.features == b.closest.features;
  });
}

TEST(Distances, DependNeitherOnThreadsNorOnTheFrameBefore) {
  rational::Draws random(2);
  DistanceMemory memory;
  for (int k = 0; k < 20; ++k) {
    const Scene scene = distance_lab::random_scene(random, 5, 40);
    for (const DistanceOptions& options : questions(random, 1)) {
      if (!nothing_asked(scene, options).empty()) continue;
      DistanceOptions one = options, three = options;
      one.threads = 1;
      three.threads = 3;
      const DistanceRecord record = distances(scene, one);
      EXPECT_TRUE(same(record, distances(scene, three)));
      // Hints of another scene: of triangles that are far apart now, or are not there.
      EXPECT_TRUE(same(record, distances(scene, one, {}, &memory)));
      EXPECT_TRUE(same(record, distances(scene, one, {}, &memory)));
    }
  }
}

// Blobs that drift: the nearest ones of a frame bound those of the next from the start.
TEST(Distances, OfTheFrameBeforeSaveWork) {
  for (const DistancePairs pairs : {objects, nearest}) {
    Scene scene = make_builtin_scene("field:2000");
    const DistanceOptions options = {.pairs = pairs, .inside = false, .threads = 1};
    DistanceMemory memory;
    ProximityCounts with, without;
    for (int frame = 0; frame < 5; ++frame) {
      const DistanceRecord alone = distances(scene, options);
      const DistanceRecord record = distances(scene, options, {}, &memory);
      EXPECT_TRUE(same(record, alone)) << frame;
      if (frame > 0) {
        with.triangle_pairs += record.counts.triangle_pairs;
        with.box_pairs += record.counts.box_pairs;
        without.triangle_pairs += alone.counts.triangle_pairs;
        without.box_pairs += alone.counts.box_pairs;
      }
      const Vec3 by = Vec3(0.004, -0.003, 0.002) * (frame + 1);
      distance_lab::move_objects(scene, std::span(scene.objects).subspan(frame, 1), by);
    }
    EXPECT_LT(with.triangle_pairs, without.triangle_pairs);
    EXPECT_LT(with.box_pairs, without.box_pairs);
  }
}

TEST(Distances, OfOneObjectLeaveNeighboursOut) {
  Scene scene = make_builtin_scene("degenerate");
  scene.objects.resize(1);
  scene.objects[0].triangle_count = 60;
  scene.triangles.resize(60);
  scene.source_face.resize(60);
  EXPECT_THROW(distances(scene, {}), Error);
  scene.objects[0].self = true;
  const DistanceOptions options = {.verify = true};
  const DistanceRecord record = distances(scene, options);
  EXPECT_EQ(answers_of(record), Truth(scene).answers(options));
  ASSERT_EQ(record.distances.size(), 1u);
  EXPECT_EQ(record.distances[0].inside, WhichInside::unknown);
  EXPECT_THROW(distances(scene, {.pairs = nearest}), Error);
}

TEST(Distances, RefuseBadOptions) {
  const Scene scene = make_builtin_scene("degenerate");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(distances(scene, {.within = nan}), Error);
  EXPECT_THROW(distances(scene, {.within = -1}), Error);
  EXPECT_THROW(distances(scene, {.pairs = all}), Error);
  EXPECT_THROW(distances(scene, {.pairs = nearest, .k = 0}), Error);
  EXPECT_THROW(distances(scene, {.pairs = all, .within = 1, .most_pairs = 10}), Error);
  // Of all pairs of objects; four times as many within a distance.
  const Scene soup = make_builtin_scene("random-soup");
  const std::size_t questions = soup.objects.size() * (soup.objects.size() - 1) / 2;
  EXPECT_THROW(distances(soup, {.most_pairs = questions - 1}), Error);
  EXPECT_NO_THROW(distances(soup, {.most_pairs = questions}));
  EXPECT_NO_THROW(distances(soup, {.within = 1, .most_pairs = questions / 4 + 1}));
  EXPECT_THROW(distances(soup, {.within = 1, .most_pairs = questions / 4 - 1}), Error);
  EXPECT_NO_THROW(distances(scene, {.pairs = nearest, .k = SIZE_MAX}));
}

// Equal triangles, and a fan about one corner: no edge passes through a face, so that bounds alone
// would leave each object to be compared with all others.
TEST(Distances, NearestOfObjectsWithACornerInCommonTakesFewSearches) {
  for (const bool equal : {true, false}) {
    constexpr std::uint32_t kObjects = 200;
    std::vector<std::vector<reference::Triangle>> objects;
    for (std::uint32_t k = 0; k < kObjects; ++k) {
      const double x = equal ? 1 : 1 + k;
      objects.push_back({{Vec3(0, 0, 0), Vec3(x, 1, 0), Vec3(x, 1, 1)}});
    }
    const Scene scene = reference::scene_of(objects);
    const DistanceRecord record = distances(scene, {.pairs = nearest, .verify = true});
    // Each object first asks a tree over all triangles, of whose leaves it looks at one: 16
    // triangles.
    EXPECT_LT(record.counts.triangle_pairs, (16 + 8) * kObjects);
    EXPECT_TRUE(record.verification->holds());
    ASSERT_EQ(record.distances.size(), kObjects - 1);  // of 0 with each other one
    for (const Distance& d : record.distances) {
      EXPECT_EQ(d.objects.a, 0u);
      EXPECT_EQ(d.closest.distance, 0);
    }
  }
}

TEST(Distances, AnswerWhatIsNearestOfEachObject) {
  // Points on a line at 0, 1, 3, 4: of 1 and 3 as seen from 4 the nearest is 3, and so on.
  std::vector<std::vector<reference::Triangle>> points;
  for (const double x : {0.0, 1.0, 3.0, 4.0})
    points.push_back({{Vec3(x, 0, 0), Vec3(x, 0, 0), Vec3(x, 0, 0)}});
  const Scene scene = reference::scene_of(points);
  const DistanceRecord record = distances(scene, {.pairs = nearest, .k = 2});
  const auto of = nearest_of_objects(scene, record.distances, 2);
  ASSERT_EQ(of.size(), 4u);
  const auto neighbours = [&](std::uint32_t object) {
    std::vector<std::uint32_t> out;
    for (const std::size_t d : of[object].distances) {
      const ObjectPair& pair = record.distances[d].objects;
      out.push_back(pair.a == object ? pair.b : pair.a);
    }
    return out;
  };
  EXPECT_EQ(neighbours(0), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(neighbours(1), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(neighbours(2), (std::vector<std::uint32_t>{3, 1}));
  EXPECT_EQ(neighbours(3), (std::vector<std::uint32_t>{2, 1}));
}

using distance_truth::Nearest;

// Of each object the first of its nearest others, from the distances of all objects.
std::vector<Answer> nearest_answers(const Scene& scene, const distance_lab::Truth& truth) {
  std::vector<Answer> out;
  const std::vector<Answer> all = truth.answers({.pairs = objects});
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Answer* best = nullptr;
    for (const Answer& x : all) {
      const bool names = (x.objects.a == o) != (x.objects.b == o);
      if (names && (best == nullptr || x.squared < best->squared)) best = &x;
    }
    if (best != nullptr) out.push_back(*best);
  }
  return out;
}

void expect_same(const Scene& scene, const std::string& where) {
  const distance_lab::Truth slow(scene);
  distance_truth::Truth fast(scene);
  std::vector<Answer> answers;
  const auto count = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a; b < count; ++b) {
      if (a == b && !scene.objects[a].self) continue;
      const auto found = fast.nearest({a, b});
      if (!found) continue;
      answers.push_back({{a, b}, found->pairs.front(), found->squared});
      ASSERT_TRUE(std::ranges::is_sorted(found->pairs)) << where;
    }
  }
  EXPECT_EQ(answers, slow.answers({.pairs = objects})) << where;
  answers.clear();
  for (const Nearest& n : fast.nearest_of_each()) {
    const auto [a, b] = std::minmax(n.objects.a, n.objects.b);
    answers.push_back({{a, b}, n.pairs.front(), n.squared});
  }
  EXPECT_EQ(answers, nearest_answers(scene, slow)) << where;
}

TEST(DistanceTruth, IsThatOfComparingAllWithAll) {
  rational::Draws random(11);
  for (int k = 0; k < trials(60); ++k)
    expect_same(distance_lab::random_scene(random, 1 + random.below(5), 14), std::to_string(k));
  for (const char* name : {"degenerate", "slivers:12", "gap:12", "mixed:4"})
    for (const double diagonals : {0.0, 1e-12, 1.0, 1e3})
      expect_same(distance_lab::moved_apart(make_builtin_scene(name), diagonals), name);
}

// All pairs that are as near: two rows of four squares at the distance 1.
TEST(DistanceTruth, HoldsAllPairsThatAreAsNear) {
  near_lab::GridScene grid;
  for (const int z : {0, 1}) {
    std::vector<near_lab::Corners<near_lab::Integer>> row;
    for (int x = 0; x < 8; x += 2) row.push_back({{{x, 0, z}, {x + 1, 0, z}, {x, 1, z}}});
    near_lab::add_object(grid, row);
  }
  near_lab::finish(grid, 0.25, 3, [] { return false; });
  distance_truth::Truth truth(grid.scene);
  const auto found = truth.nearest({0, 1});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->squared, distance_lab::Q(1, 16));
  EXPECT_EQ(found->pairs, (std::vector<TrianglePair>{{0, 4}, {1, 5}, {2, 6}, {3, 7}}));
  // Most pairs are left out.
  EXPECT_LT(truth.computed(), 16u);
}

}  // namespace
}  // namespace farcull
