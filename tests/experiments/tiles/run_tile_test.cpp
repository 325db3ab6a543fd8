// The lists of all tiles together are the list of one run, byte for byte.
#include "experiments/tiles/run_tile.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/ignored.h"
#include "experiments/scenes/scene_file.h"
#include "tests/experiments/tiles/tile_lab.h"

namespace farcull {
namespace {

RunOptions native(double clearance) {
  RunOptions out;
  out.device = "native";
  out.clearance = clearance;
  return out;
}

TEST(Tiles, GiveTheListOfOneRunOnRandomScenes) {
  RandomNumbers random(4);
  Session session("native");
  std::uint64_t pairs = 0, elsewhere = 0, shared = 0, ignored = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    SCOPED_TRACE(trial);
    Scene scene = small_scene(random);
    RunOptions options = native(trial % 3 == 0 ? 0.5 * random.below(3) : 0);
    options.contacts = trial % 5 == 0 ? ContactDetail::kinds : ContactDetail::none;
    const PairColumns columns = {.faces = trial % 2 == 0,
                                 .contacts = options.contacts != ContactDetail::none};
    TileQuestion question{.options = options};
    if (trial % 4 == 0 && scene.objects.size() > 1) {
      options.ignored = {{0, 1}};
      question.ignored = [](const Scene&) { return std::vector<ObjectPair>{{0, 1}}; };
    }
    if (trial % 8 < 2 && scene.objects.size() > 2) scene.ignored = {{0, 2}, {1, 2}};
    const Record whole = run(scene, options, session);
    if (!scene.ignored.empty()) {
      Scene all = scene;
      all.ignored.clear();
      const Record more = run(all, options, session);
      ignored += more.collisions.pairs.size() - whole.collisions.pairs.size();
    }
    std::vector<std::string> lists;
    const std::size_t n = 1 + random.below(std::size_t{5});
    std::uint64_t home = 0, candidates = 0;
    for (std::size_t k = 1; k <= n; ++k) {
      question.tile = {k, n};
      const TileRun tile = run_tile(source_of(scene), question, session);
      EXPECT_EQ(tile.part.hash, whole.scene_hash);
      ASSERT_TRUE(tile.record.verification);
      EXPECT_EQ(tile.record.verification->false_negatives, 0);
      home += tile.part.home;
      candidates += tile.record.found.count;
      elsewhere += tile.elsewhere;
      shared += tile.part.scene.triangles.size();
      lists.push_back(tile_list(tile, columns));
    }
    EXPECT_EQ(home, scene.triangles.size());
    shared -= home;
    EXPECT_EQ(candidates, whole.found.count);
    ASSERT_EQ(joined(lists), pairs_csv(scene, whole, columns));
    pairs += whole.collisions.pairs.size() + whole.collisions.neighbour_pairs.size();
  }
  // The scenes ask what they are meant to ask.
  EXPECT_GT(pairs, 5000);
  EXPECT_GT(elsewhere, 1000);
  EXPECT_GT(shared, 1000);
  EXPECT_GT(ignored, 100);  // so a tile that forgets what the scene ignores has another list
}

TEST(Tiles, NoticeASceneThatChangesBetweenTheReadings) {
  RandomNumbers random(5);
  Scene scene = small_scene(random);
  while (scene.triangles.size() < 4) scene = small_scene(random);
  Session session("native");
  const TileQuestion question{.options = native(0), .tile = {1, 1}};
  const std::string hash = run_tile(source_of(scene), question, session).part.hash;
  int reading = 0;
  const auto changing = [&](const std::function<void(Scene&)>& change) -> SceneSource {
    reading = 0;
    return [&scene, &reading, change](const TakePart& take) {
      Scene now = scene;
      if (++reading == 2) change(now);
      return source_of(now)(take);
    };
  };
  const auto drop = [](Scene& now) {
    while (now.objects.back().triangle_count == 0) now.objects.pop_back();
    --now.objects.back().triangle_count;
  };
  EXPECT_THROW(run_tile(changing(drop), question, session), Error);
  // No census tells this; the hash does, so the records of the tiles do not fit together.
  const auto move = [](Scene& now) { now.vertices[now.triangles[0][0]].x() += 1; };
  EXPECT_NE(run_tile(changing(move), question, session).part.hash, hash);
}

TEST(Tiles, AreCutByAFixedRuleIntoEvenParts) {
  RandomNumbers random(6);
  Scene scene;
  scene.name = "even";
  for (std::uint32_t t = 0; t < 100'000; ++t) {  // more than the sample holds
    const double x = 100 * random.unit(), y = random.unit();
    for (int k = 0; k < 3; ++k) scene.vertices.emplace_back(x + 0.1 * k, y, 0);
    scene.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    scene.source_face.push_back(t);
  }
  scene.objects = {{"a", 0, 50'000}, {"b", 50'000, 50'000}};
  const Census census = take_census(source_of(scene), 0);
  EXPECT_LE(census.sample.size(), 65'536);
  EXPECT_GT(census.sample.size(), 20'000);
  const Cuts cuts = choose_cuts(census, 4);
  EXPECT_EQ(cuts.axis, 1);  // along x some boxes meet two tiles, along z all begin at one place
  EXPECT_EQ(cuts.at, choose_cuts(take_census(source_of(scene), 0), 4).at);
  std::uint64_t home = 0;
  for (const TileCount& count : count_tiles(source_of(scene), cuts, 0)) {
    home += count.home;
    EXPECT_NEAR(static_cast<double>(count.triangles), 25'000, 1'000);
  }
  EXPECT_EQ(home, 100'000);
}

TEST(Tiles, ReadTheNumberOfATile) {
  EXPECT_EQ(parse_tile("2/4").k, 2);
  EXPECT_EQ(parse_tile("2/4").n, 4);
  for (const char* bad : {"", "2", "0/4", "5/4", "a/4", "1/", "1/4/2", "-1/4", "1/100000"})
    EXPECT_THROW(parse_tile(bad), Error) << bad;
  EXPECT_EQ(parse_tiles("3"), 3);
  for (const char* bad : {"", "0", "1/2", "10001"}) EXPECT_THROW(parse_tiles(bad), Error) << bad;
}

TEST(Tiles, RefuseOtherMethodsAndLimits) {
  RandomNumbers random(7);
  Session session("native");
  TileQuestion question{.options = native(0)};
  question.options.limit = 3;
  EXPECT_THROW(run_tile(source_of(small_scene(random)), question, session), std::logic_error);
  question.options.limit = 0;
  question.options.method = Method::exact;
  EXPECT_THROW(run_tile(source_of(small_scene(random)), question, session), std::logic_error);
}

// What load_scene() reads at once.
void expect_same(const std::vector<std::string>& arguments, std::size_t least_parts) {
  SCOPED_TRACE(arguments[0]);
  const Scene scene = load_scene(arguments);
  std::vector<std::string> names, known;
  std::vector<std::uint32_t> faces;
  std::size_t parts = 0;
  const SceneSource source = [&](const TakePart& take) { return stream_scene(arguments, take); };
  source([&](Scene& part) {
    ++parts;
    EXPECT_EQ(part.name, scene.name);
    for (const Object& object : part.objects) names.push_back(object.name);
    faces.insert(faces.end(), part.source_face.begin(), part.source_face.end());
  });
  for (const Object& object : scene.objects) known.push_back(object.name);
  EXPECT_GE(parts, least_parts);
  EXPECT_EQ(names, known);
  EXPECT_EQ(faces, scene.source_face);
  const Census census = take_census(source, 0, true);
  EXPECT_EQ(census.names, known);
  EXPECT_EQ(census.ignored, scene.ignored);
  const TileScene all = gather_tile(source, census, {}, 0);
  EXPECT_EQ(all.hash, scene_hash(scene));
  EXPECT_EQ(all.scene.triangles.size(), scene.triangles.size());
  if (scene.objects.size() == all.scene.objects.size()) {
    EXPECT_EQ(scene_hash(all.scene), scene_hash(scene));
  }
}

TEST(Tiles, ReadAScenePartByPartAsAtOnce) {
  expect_same({"field:200000"}, 3);
  expect_same({"field:3000@seed9"}, 1);
  expect_same({"field:3000@far"}, 1);
  expect_same({"two-spheres"}, 1);
}

}  // namespace
}  // namespace farcull
