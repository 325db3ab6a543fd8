// The library as its users see it, held against the method `exact`.
#include "experiments/library/farcull.h"
#include "experiments/method/run.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/flat.h"
#include "verify/exact.h"

namespace farcull {
namespace {

std::vector<TrianglePair> pairs_of(const std::vector<ColliderPair>& pairs) {
  std::vector<TrianglePair> out;
  for (const ColliderPair& pair : pairs) out.push_back({pair.a, pair.b});
  return out;
}

Scene self_scene(const std::string& name) {
  Scene scene = make_builtin_scene(name);
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

void expect_exact(Collider& collider, const Scene& scene, double clearance = 0) {
  const Flat flat(scene);
  const ColliderResult found = collider.find(flat.input());
  const ExactResult exact = all_colliding_pairs(scene, {.clearance = clearance});
  EXPECT_EQ(pairs_of(found.pairs), exact.pairs) << scene.name;
  EXPECT_EQ(pairs_of(found.neighbour_pairs), exact.neighbour_pairs) << scene.name;
  EXPECT_EQ(found.report.device, "cpu");
  EXPECT_GE(found.report.candidates, found.pairs.size() + found.neighbour_pairs.size());
  EXPECT_EQ(found.report.stages.back().out, found.pairs.size() + found.neighbour_pairs.size());
}

TEST(Library, OneColliderGivesTheExactPairsOfSceneAfterScene) {
  Collider collider;
  for (const char* name : {"two-spheres", "degenerate", "far-apart", "needles", "random-soup",
                           "crowd", "two-spheres@tiny", "two-spheres"})
    expect_exact(collider, make_builtin_scene(name));
}

TEST(Library, SelfCollisionWithNeighboursApart) {
  Collider collider({.self = true});
  for (const char* name : {"degenerate", "random-soup", "two-tori"})
    expect_exact(collider, self_scene(name));
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

TEST(Library, TheAnswerIsOnlyThatOfTheInput) {
  const Flat flat(make_builtin_scene("random-soup"));
  const ColliderResult usual = Collider().find(flat.input());
  for (const ColliderOptions& options :
       {ColliderOptions{.threads = 1}, ColliderOptions{.views = "1:2:3,-y"},
        ColliderOptions{.resolution = 7}, ColliderOptions{.neighbours = false},
        ColliderOptions{.device = ColliderDevice::best}}) {
    Collider collider(options);
    const ColliderResult found = collider.find(flat.input());
    EXPECT_EQ(found.pairs, usual.pairs);
    EXPECT_FALSE(found.report.device_reason.empty());
    if (options.views != "auto") {
      EXPECT_EQ(found.report.views[0].name, "1:2:3");
      EXPECT_EQ(found.report.views.size(), 2u);
    }
    if (options.resolution > 0) {
      EXPECT_LE(found.report.views[0].width, options.resolution + 5);
    }
  }
}

TEST(Library, NeighboursAreOnlyCountedWhereNobodyAsksForThem) {
  const Flat flat(make_builtin_scene("two-spheres"));
  const ColliderResult all = Collider({.self = true}).find(flat.input());
  const ColliderResult fewer = Collider({.self = true, .neighbours = false}).find(flat.input());
  EXPECT_EQ(fewer.pairs, all.pairs);
  EXPECT_TRUE(fewer.neighbour_pairs.empty());
  EXPECT_EQ(fewer.report.neighbours, all.report.neighbours);
  EXPECT_GT(all.report.neighbours, 0u);
}

TEST(Library, NothingIsNothing) {
  Collider collider;
  EXPECT_TRUE(collider.find({}).pairs.empty());
  const std::vector<double> vertices = {0, 0, 0};
  const std::vector<std::uint32_t> triangles = {0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(collider.find({vertices, {}, {}}).pairs.empty());
  EXPECT_TRUE(collider.find({vertices, triangles, {}}).pairs.empty());  // of one object
  const std::vector<std::uint32_t> starts = {0, 0, 1, 2, 2};            // empty ones among them
  EXPECT_EQ(collider.find({vertices, triangles, starts}).pairs,
            (std::vector<ColliderPair>{{0, 1}}));
}

template <class Call>
std::string refused(const Call& call) {
  return refusal(call)[0];
}

TEST(Library, RefusesBadInputAndGoesOn) {
  Collider collider;
  const Flat good(make_builtin_scene("two-spheres"));
  const auto with = [&](const auto& change) {
    Flat flat = good;
    change(flat);
    return refused([&] { collider.find(flat.input()); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(with([&](Flat& f) { f.vertices[7] = nan; }), "vertices");
  EXPECT_EQ(with([&](Flat& f) { f.vertices[7] = -HUGE_VAL; }), "vertices");
  EXPECT_EQ(with([&](Flat& f) { f.vertices.pop_back(); }), "vertices");
  EXPECT_EQ(with([&](Flat& f) { f.triangles.pop_back(); }), "triangles");
  EXPECT_EQ(with([&](Flat& f) { f.triangles[5] = 5124; }), "triangles");
  EXPECT_EQ(with([&](Flat& f) { f.starts[0] = 1; }), "object_starts");
  EXPECT_EQ(with([&](Flat& f) { f.starts[1] = 10241; }), "object_starts");
  EXPECT_EQ(with([&](Flat& f) { f.starts = {0, 9, 8}; }), "object_starts");
  expect_exact(collider, make_builtin_scene("two-spheres"));
  Collider marked({.self_objects = {true}});
  EXPECT_EQ(refused([&] { marked.find(good.input()); }), "self_objects");
}

TEST(Library, IndicesOf64BitsAnswerTheSame) {
  const Flat flat(make_builtin_scene("two-spheres"));
  std::vector<std::int64_t> wide(flat.triangles.begin(), flat.triangles.end());
  Collider collider;
  const std::vector<ColliderPair> expected = collider.find(flat.input()).pairs;
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
  const auto reason = [&](const ColliderInput& input) {
    return refusal([&] { collider.find(input); })[1];
  };
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

TEST(Library, RefusesBadOptions) {
  const auto with = [](const ColliderOptions& options) {
    return refused([&] { Collider collider(options); });
  };
  EXPECT_EQ(with({.clearance = -1}), "clearance");
  EXPECT_EQ(with({.clearance = HUGE_VAL}), "clearance");
  EXPECT_EQ(with({.views = "q"}), "views");
  EXPECT_EQ(with({.views = ""}), "views");
  EXPECT_EQ(with({.resolution = -1}), "resolution");
  EXPECT_EQ(with({.resolution = kMostPairResolution + 1}), "resolution");
  EXPECT_EQ(with({.threads = 1025}), "threads");
}

}  // namespace
}  // namespace farcull
