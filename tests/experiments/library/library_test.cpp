// The library as its users see it, held against the method `exact`.
#include "experiments/library/distance.h"
#include "experiments/library/input.h"
#include "experiments/method/run.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/distances.h"
#include "tests/lab/flat.h"

namespace farcull {
namespace {

std::vector<TrianglePair> pairs_of(const std::vector<Pair>& pairs) {
  std::vector<TrianglePair> out;
  for (const Pair& pair : pairs) out.push_back({pair.a, pair.b});
  return out;
}

void expect_exact(Collider& collider, const Scene& scene, double clearance = 0) {
  const Flat flat(scene);
  const Result found = collider.find(flat.input());
  const ExactResult exact = all_colliding_pairs(scene, {.clearance = clearance});
  EXPECT_EQ(pairs_of(found.pairs), exact.pairs) << scene.name;
  EXPECT_EQ(pairs_of(found.neighbour_pairs), exact.neighbour_pairs) << scene.name;
  EXPECT_GE(found.report.candidates, found.pairs.size() + found.neighbour_pairs.size());
  EXPECT_EQ(found.report.stages.back().out, found.pairs.size() + found.neighbour_pairs.size());
}

TEST(Library, OneColliderGivesTheExactPairsOfSceneAfterScene) {
  Collider collider;
  for (const char* name : {"two-spheres", "degenerate", "far-apart", "needles", "random-soup",
                           "crowd", "two-spheres@tiny", "two-spheres"})
    expect_exact(collider, make_builtin_scene(name));
}

TEST(Library, SelfCollisionOfSomeObjects) {
  Scene scene = make_builtin_scene("random-soup");
  Collider none, first({.self_objects = {true, false, false, false, false, false, false, false}});
  const std::size_t without = none.find(Flat(scene).input()).pairs.size();
  scene.objects[0].self = true;
  expect_exact(first, scene);
  EXPECT_GT(first.find(Flat(scene).input()).pairs.size(), without);
}

TEST(Library, ClearanceFindsWhatIsNear) {
  const Scene scene = make_builtin_scene("needles");
  Collider collider({.clearance = 0.05});
  expect_exact(collider, scene, 0.05);
  EXPECT_GT(collider.find(Flat(scene).input()).pairs.size(),
            all_colliding_pairs(scene).pairs.size());
}

// Frames one after the other, in which some vertices move, triangles or objects become others, or
// the input is bad. The collider keeps what did not move; each answer is that of a new one.
TEST(Library, FramesAreAsFresh) {
  RandomNumbers random(3);
  Flat flat(make_builtin_scene("two-spheres"));
  Collider collider;
  std::size_t changes = 0;
  std::vector<Pair> last;
  for (int frame = 0; frame < 40; ++frame) {
    const std::size_t at = 3 * random.below(flat.vertices.size() / 3);
    const int kind = random.below(7);
    if (kind == 0) {
      std::swap(flat.triangles[random.below(flat.triangles.size())],
                flat.triangles[random.below(flat.triangles.size())]);
    }
    if (kind == 1) flat.starts[1] = 5120 + random.below(3u);
    if (kind == 2 || kind == 3) {  // refused twice, though it is what was there before
      const Flat good = flat;
      if (kind == 2) flat.vertices[at] = HUGE_VAL;
      if (kind == 3) flat.triangles[at] = 5124;
      for (int twice = 0; twice < 2; ++twice) EXPECT_THROW(collider.find(flat.input()), Error);
      flat = good;
    }
    if (kind > 4) {
      for (std::size_t k = at; k < std::min(at + 120, flat.vertices.size()); ++k)
        flat.vertices[k] += 0.05 * random.between(-1, 1);
    }
    const std::vector<std::int64_t> wide(flat.triangles.begin(), flat.triangles.end());
    const Result found = random.below(2) == 0
                             ? collider.find(flat.input())
                             : collider.find({flat.vertices, {}, flat.starts, wide});
    const Result fresh = Collider().find(flat.input());
    ASSERT_EQ(found.pairs, fresh.pairs) << frame;
    ASSERT_EQ(found.neighbour_pairs, fresh.neighbour_pairs) << frame;
    changes += found.pairs != last;
    last = found.pairs;
  }
  EXPECT_GT(changes, 10u);
}

// Bit for bit, so that a zero of the other sign counts too.
TEST(LibraryInput, SaysWhichVerticesAreNew) {
  Flat flat(make_builtin_scene("two-spheres"));
  TakenInput taken;
  const auto change = [&] {
    FrameChange out;
    load_input(flat.input(), false, {}, taken, &out);
    return out;
  };
  EXPECT_FALSE(change().same);
  const FrameChange none = change();
  EXPECT_TRUE(none.same && none.vertices.empty());
  const auto vertices = static_cast<std::uint32_t>(flat.vertices.size() / 3);
  for (const std::uint32_t v : {0u, 1u, 511u, 512u, vertices - 1}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double& x = flat.vertices[3 * v + axis];
      x = x == 0 ? -x : std::nextafter(x, 9.0);
      const FrameChange one = change();
      EXPECT_TRUE(one.same);
      EXPECT_EQ(one.vertices, std::vector<std::uint32_t>{v}) << axis;
    }
  }
  std::swap(flat.triangles[7], flat.triangles[8]);
  EXPECT_FALSE(change().same);
  EXPECT_TRUE(change().same);
  flat.starts[1] += 1;
  EXPECT_FALSE(change().same);
  flat.vertices.insert(flat.vertices.end(), {0.0, 0.0, 0.0});
  EXPECT_FALSE(change().same);
}

template <class Call>
std::string refused(const Call& call) {
  return refusal(call)[0];
}

TEST(Library, IndicesOf64BitsAnswerTheSame) {
  const Flat flat(make_builtin_scene("two-spheres"));
  std::vector<std::int64_t> wide(flat.triangles.begin(), flat.triangles.end());
  Collider collider;
  const std::vector<Pair> expected = collider.find(flat.input()).pairs;
  EXPECT_GT(expected.size(), 0u);
  const auto find = [&] { return collider.find({flat.vertices, {}, flat.starts, wide}).pairs; };
  EXPECT_EQ(find(), expected);
  EXPECT_EQ(refused([&] {
              collider.find({flat.vertices, flat.triangles, flat.starts, wide});
            }),
            "triangles");
  // In 32 bits each of the first two would be what it is in place of.
  for (const std::int64_t bad :
       {wide[5] + (std::int64_t{1} << 32), wide[5] - (std::int64_t{1} << 32), std::int64_t{-1},
        static_cast<std::int64_t>(flat.vertices.size() / 3)}) {
    const std::int64_t good = std::exchange(wide[5], bad);
    EXPECT_EQ(refused(find), "triangles") << bad;
    wide[5] = good;
  }
  EXPECT_EQ(find(), expected);
  wide.pop_back();
  EXPECT_EQ(refused(find), "triangles");
}

// Numbers are copied and checked in blocks: a bad one is named wherever in a block it stands.
TEST(Library, NamesTheFirstBadNumberAtEachPlace) {
  const Flat good(make_builtin_scene("two-spheres"));
  const std::vector<std::int64_t> wide(good.triangles.begin(), good.triangles.end());
  Collider collider;
  const auto reason = [&](const Input& input) { return refusal([&] { collider.find(input); })[1]; };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto vertices = static_cast<std::uint32_t>(good.vertices.size() / 3);
  for (const std::size_t at : {0, 1, 2, 1022, 1023, 1024, 1025, 2047, 2048, 5000}) {
    for (const double value : {nan, -nan, HUGE_VAL, -HUGE_VAL}) {
      Flat flat = good;
      flat.vertices[at] = flat.vertices[at + 700] = value;
      EXPECT_EQ(reason(flat.input()), "vertex " + std::to_string(at / 3) + " is not finite");
    }
    Flat flat = good;
    flat.triangles[at] = vertices;
    flat.triangles[at + 700] = ~std::uint32_t{0};
    const std::string named = "triangle " + std::to_string(at / 3) + " names vertex ";
    const std::string of = " of " + std::to_string(vertices);
    EXPECT_EQ(reason(flat.input()), named + std::to_string(vertices) + of);
    std::vector<std::int64_t> bad = wide;
    bad[at] = -1;
    bad[at + 700] = vertices;
    EXPECT_EQ(reason({good.vertices, {}, good.starts, bad}), named + "-1" + of);
  }
  Flat largest = good;  // the largest doubles are finite
  largest.vertices.back() = std::numeric_limits<double>::max();
  largest.vertices[0] = -std::numeric_limits<double>::max();
  largest.vertices[1] = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(reason(largest.input()), "nothing was thrown");
}

// The twin is NamesTheFirstBadNumberAtEachPlace, where triangles use the vertices.
TEST(Library, PassesOverUnusedVerticesThatAreNoNumbers) {
  Flat flat(make_builtin_scene("two-spheres"));
  Collider collider;
  const std::vector<Pair> expected = collider.find(flat.input()).pairs;
  const auto first = static_cast<std::uint32_t>(flat.vertices.size() / 3);
  flat.vertices.insert(flat.vertices.end(), {HUGE_VAL, 0, 0, 0, 1, std::nan("")});
  for (int call = 0; call < 4; ++call) {
    const Result found = collider.find(flat.input());
    EXPECT_EQ(found.pairs, expected);
    EXPECT_EQ(found.report.passed_over, 2u);
  }
  flat.triangles[4] = first + 1;
  EXPECT_EQ(refusal([&] { collider.find(flat.input()); })[1],
            "vertex " + std::to_string(first + 1) + " is not finite");
}

TEST(Library, RefusesBadOptions) {
  const auto with = [](const Options& options) {
    return refused([&] { Collider collider(options); });
  };
  EXPECT_EQ(with({.clearance = -1}), "clearance");
  EXPECT_EQ(with({.clearance = HUGE_VAL}), "clearance");
  EXPECT_EQ(with({.threads = 1025}), "threads");
}

// ---- Distances as users of the library see them, held against those of the method.

void expect_same(const std::vector<DistanceAnswer>& found, const DistanceRecord& record) {
  ASSERT_EQ(found.size(), record.distances.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const DistanceAnswer& x = found[k];
    const Distance& y = record.distances[k];
    EXPECT_EQ((ObjectPair{x.object_a, x.object_b}), y.objects);
    EXPECT_EQ((TrianglePair{x.triangle_a, x.triangle_b}), y.triangles);
    EXPECT_EQ(x.distance, y.closest.distance);
    EXPECT_EQ(x.squared, y.closest.squared.text());
    EXPECT_EQ(x.feature_a, to_string(y.closest.features[0]));
    EXPECT_EQ(x.feature_b, to_string(y.closest.features[1]));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(x.point_a[axis], y.closest.points[0][axis]);
      EXPECT_EQ(x.point_b[axis], y.closest.points[1][axis]);
    }
    EXPECT_EQ(static_cast<int>(x.inside), static_cast<int>(y.inside));
  }
}

TEST(LibraryDistances, AreThoseOfTheMethodSceneAfterScene) {
  rational::Draws random(1);
  DistanceFinder all_pairs({.exact = true});
  DistanceFinder near({.kind = DistanceKind::nearest, .k = 2, .exact = true});
  DistanceFinder within({.kind = DistanceKind::all, .within = 3, .exact = true, .threads = 2});
  for (int k = 0; k < 20; ++k) {
    Scene scene = distance_lab::random_scene(random, 4, 12);
    for (Object& object : scene.objects) object.self = false;
    std::erase_if(scene.objects, [](const Object& object) { return object.triangle_count == 0; });
    if (!nothing_asked(scene, {}).empty()) {
      EXPECT_THROW(all_pairs.find(Flat(scene).input()), Error);
      continue;
    }
    expect_same(all_pairs.find(Flat(scene).input()), distances(scene, {}));
    expect_same(near.find(Flat(scene).input()),
                distances(scene, {.pairs = DistancePairs::nearest, .k = 2}));
    expect_same(within.find(Flat(scene).input()),
                distances(scene, {.pairs = DistancePairs::all, .within = 3}));
  }
}

// Contacts in doubles name the pairs of the exact ones, in their order, with numbers that are as
// near as distance.h says (tests/verify/closest_test.cpp has each promise).
TEST(LibraryDistances, ContactsAreThoseOfExactArithmetic) {
  rational::Draws random(2);
  std::size_t apart = 0, meet = 0, fewer = 0;
  for (int k = 0; k < 20; ++k) {
    Scene scene = distance_lab::random_scene(random, 4, 12);
    std::erase_if(scene.objects, [](const Object& object) { return object.triangle_count == 0; });
    if (scene.objects.size() < 3) continue;
    const Flat flat(scene);
    Box box = Box::empty();
    for (const Vec3& p : scene.vertices) box.add(p);
    const double size = (box.hi - box.lo).maxCoeff();
    DistanceFinderOptions options{.kind = DistanceKind::all, .within = size / 8, .self = true};
    if (k % 2 == 0) options.ignore = {{2, 1}};
    const std::vector<DistanceAnswer> found = distances(flat.input(), options);
    options.exact = true;
    const std::vector<DistanceAnswer> exact = distances(flat.input(), options);
    ASSERT_EQ(found.size(), exact.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const DistanceAnswer &x = found[i], &y = exact[i];
      EXPECT_EQ(std::tie(x.object_a, x.object_b, x.triangle_a, x.triangle_b),
                std::tie(y.object_a, y.object_b, y.triangle_a, y.triangle_b));
      EXPECT_EQ(object_of(flat.starts, x.triangle_a), x.object_a);
      EXPECT_EQ(object_of(flat.starts, x.triangle_b), x.object_b);
      EXPECT_LE(std::abs(x.distance - y.distance), 0x1p-31 * y.distance);
      EXPECT_TRUE(x.squared.empty() && !y.squared.empty());
      double length = 0;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(x.normal[axis], y.normal[axis], 0x1p-15);
        length += x.normal[axis] * x.normal[axis];
      }
      EXPECT_NEAR(length, x.distance > 0, 1e-12);
      (x.distance > 0 ? apart : meet) += 1;
    }
    // The twin: another distance.
    options.within = size / 32;
    fewer += distances(flat.input(), options).size() < exact.size();
  }
  EXPECT_GT(apart, 100u);
  EXPECT_GT(meet, 0u);
  EXPECT_GT(fewer, 5u);
  EXPECT_EQ(object_of({}, 7), 0u);
}

TEST(LibraryDistances, OfObjectsThatAreAskedAboutByThemselves) {
  Scene scene = make_builtin_scene("degenerate");
  scene.objects[1].self = true;
  DistanceFinder finder({.self_objects = {false, true}, .exact = true});
  expect_same(finder.find(Flat(scene).input()), distances(scene, {}));
  EXPECT_THROW(DistanceFinder({.self_objects = {true}}).find(Flat(scene).input()), Error);
}

TEST(LibraryDistances, LeaveIgnoredObjectsOut) {
  Scene scene = make_builtin_scene("cylinders:3");
  const Flat flat(scene);
  const auto answers = distances(flat.input(), {.exact = true, .ignore = {{2, 0}, {0, 2}}});
  scene.ignored = {{0, 2}};
  expect_same(answers, distances(scene, {}));
  EXPECT_EQ(answers.size(), 2u);
  EXPECT_EQ(distances(flat.input()).size(), 3u);  // the twin
  const auto where = [&](const DistanceFinderOptions& options) {
    return refusal([&] { distances(flat.input(), options); })[0];
  };
  EXPECT_EQ(where({.ignore = {{0, 3}}}), "ignore");
  EXPECT_EQ(where({.ignore = {{1, 1}}}), "ignore");
  EXPECT_EQ(where({.ignore = {{0, 1}, {0, 2}, {1, 2}}}), "ignore");
  EXPECT_EQ(where({.kind = DistanceKind::nearest, .ignore = {{0, 1}}}), "ignore");
}

}  // namespace
}  // namespace farcull
