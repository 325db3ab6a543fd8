// The lists of all tiles together are the list of one run, byte for byte.
#include "experiments/tiles/run_tile.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

/// Up to 4 objects of up to 6 triangles on whole numbers from 0 to 4: most boxes begin where others
/// end, and most cuts lie on such a place. Some triangles are degenerate, some vertices are shared.
Scene small_scene(RandomNumbers& random) {
  Scene scene;
  scene.name = "small";
  const auto objects = 1 + random.below(4u);
  for (std::uint32_t o = 0; o < objects; ++o) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    const std::uint32_t vertices = 3 + random.below(8u), triangles = random.below(7u);
    for (std::uint32_t v = 0; v < vertices; ++v) {
      Vec3 p;
      for (int i = 0; i < 3; ++i) p[i] = random.below(5);
      scene.vertices.push_back(p);
    }
    scene.objects.push_back({.name = "o" + std::to_string(o),
                             .first_triangle = static_cast<std::uint32_t>(scene.triangles.size()),
                             .triangle_count = triangles,
                             .self = random.below(2) == 0});
    for (std::uint32_t t = 0; t < triangles; ++t) {
      std::array<std::uint32_t, 3> corners{};
      for (std::uint32_t& v : corners) v = first + random.below(vertices);
      scene.triangles.push_back(corners);
      scene.source_face.push_back(t / 2);
    }
  }
  return scene;
}

/// One part for each object, with all vertices of the scene in it.
SceneSource source_of(const Scene& scene) {
  return [scene](const TakePart& take) {
    for (const Object& object : scene.objects) {
      Scene part;
      part.name = scene.name;
      part.vertices = scene.vertices;
      const auto from = static_cast<std::ptrdiff_t>(object.first_triangle);
      const auto to = from + static_cast<std::ptrdiff_t>(object.triangle_count);
      part.triangles.assign(scene.triangles.begin() + from, scene.triangles.begin() + to);
      part.source_face.assign(scene.source_face.begin() + from, scene.source_face.begin() + to);
      part.objects = {object};
      part.objects[0].first_triangle = 0;
      take(part);
    }
    return scene.ignored;
  };
}

std::array<std::uint64_t, 4> key_of(const std::string& row) {
  std::array<std::uint64_t, 4> key{};
  std::istringstream in(row);
  char comma = 0;
  for (std::uint64_t& number : key) in >> number >> comma;
  return key;
}

std::string joined(const std::vector<std::string>& lists) {
  std::vector<std::string> rows;
  std::string header;
  for (const std::string& list : lists) {
    std::istringstream in(list);
    std::getline(in, header);
    for (std::string row; std::getline(in, row);) rows.push_back(row);
  }
  std::ranges::sort(rows, {}, key_of);
  std::string out = header + "\n";
  for (const std::string& row : rows) out += row + "\n";
  return out;
}

using Json = nlohmann::ordered_json;

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
      question.number = {k, n};
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
  while (scene.objects.size() < 3 || scene.objects[1].triangle_count == 0)
    scene = small_scene(random);
  Session session("native");
  const TileQuestion question{.options = native(0), .number = {1, 1}};
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
  // The same triangles of other objects: their numbers would be those of another scene.
  const auto shift = [](Scene& now) {
    for (std::size_t o = 1; o < now.objects.size(); ++o) {
      if (now.objects[o].triangle_count == 0) continue;
      Object& before = now.objects[o - 1];
      ++before.triangle_count;
      now.objects[o].first_triangle++;
      now.objects[o].triangle_count--;
      return;
    }
  };
  EXPECT_THROW(run_tile(changing(shift), question, session), Error);
  const auto flip = [](Scene& now) { now.objects[0].self = !now.objects[0].self; };
  EXPECT_THROW(run_tile(changing(flip), question, session), Error);
  EXPECT_NO_THROW(run_tile(changing([](Scene&) {}), question, session));
  // The counts are the same, but the hash is another, so the records of the tiles do not fit
  // together.
  const auto move = [](Scene& now) { now.vertices[now.triangles[0][0]].x() += 1; };
  EXPECT_NE(run_tile(changing(move), question, session).part.hash, hash);
}

TEST(Tiles, AreCutByAFixedRuleIntoEvenParts) {
  RandomNumbers random(6);
  Scene scene;
  scene.name = "even";
  for (std::uint32_t t = 0; t < 100'000; ++t) {  // more than the sample holds
    const double x = 100 * random.unit(), y = random.unit();
    add_triangle(scene, {Vec3(x, y, 0), Vec3(x + 0.1 * 1, y, 0), Vec3(x + 0.1 * 2, y, 0)});
  }
  scene.objects = {{"a", 0, 50'000}, {"b", 50'000, 50'000}};
  const Census census = take_census(source_of(scene), 0);
  EXPECT_LE(census.sample.size(), 65'536);
  EXPECT_GT(census.sample.size(), 20'000);
  const Cuts cuts = choose_cuts(census, 4);
  EXPECT_EQ(cuts.axis, 1);  // along x some boxes meet two tiles, along z all begin at one place
  EXPECT_EQ(cuts.at, choose_cuts(take_census(source_of(scene), 0), 4).at);
  std::uint64_t home = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const TileScene part = gather_tile(source_of(scene), census, tile_of(cuts.axis, cuts.at, k));
    home += part.home;
    EXPECT_NEAR(static_cast<double>(part.scene.triangles.size()), 25'000, 1'000);
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

Json json_of(const TileRun& run, bool faces = false) {
  const TileList list{
      .text = tile_list(run, {.faces = faces}), .file = "list.csv", .columns = {.faces = faces}};
  return tile_json(run, &list);
}

// Tiles whose records say the same share what they ignore, object by object, whatever its names.
TEST(Tiles, SayWhichObjectsTheyIgnore) {
  RandomNumbers random(8);
  Scene scene = small_scene(random);
  while (scene.objects.size() < 4) scene = small_scene(random);
  Session session("native");
  TileQuestion question{.options = native(0), .number = {1, 2}};
  const auto asked = [&] {
    return json_of(run_tile(source_of(scene), question, session))["tile"]["options"];
  };
  const Json none = asked();
  scene.ignored = {{0, 1}};
  const Json by_scene = asked();
  EXPECT_NE(by_scene, none);
  scene.ignored = {{0, 2}};
  EXPECT_NE(asked(), by_scene);
  scene.ignored = {};
  question.ignored = [](const Scene&) { return std::vector<ObjectPair>{{0, 1}}; };
  EXPECT_EQ(asked(), by_scene);
  question.ignored = [](const Scene&) { return std::vector<ObjectPair>{{0, 2}}; };
  EXPECT_NE(asked(), by_scene);
  // Lists with faces: of the same triangles from other faces.
  const TileRun one = run_tile(source_of(scene), question, session);
  scene.source_face.back() += 1;
  const TileRun other = run_tile(source_of(scene), question, session);
  EXPECT_EQ(one.part.hash, other.part.hash);
  EXPECT_EQ(json_of(one)["tile"]["options"], json_of(other)["tile"]["options"]);
  EXPECT_NE(json_of(one, true)["tile"]["options"], json_of(other, true)["tile"]["options"]);
}

// Missed pairs have the numbers of the whole scene.
TEST(Tiles, NameMissedPairsAsInTheWholeScene) {
  const Scene scene = load_scene({"field:3000"});
  Session session("native");
  TileRun tile = run_tile(source_of(scene), {.options = native(0), .number = {3, 3}}, session);
  ASSERT_GT(tile.part.numbers.objects.front(), 0);
  const auto last = static_cast<std::uint32_t>(tile.part.scene.triangles.size()) - 1;
  tile.record.verification->examples = {{0, last}};
  const Json example = json_of(tile)["verification"]["examples"][0];
  EXPECT_EQ(example["a"]["object"], tile.part.numbers.objects.front());
  EXPECT_EQ(example["a"]["triangle"], tile.part.numbers.triangles.front());
  EXPECT_EQ(example["b"]["object"], tile.part.numbers.objects.back());
  EXPECT_EQ(example["b"]["triangle"], tile.part.numbers.triangles.back());
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
  const TileScene all = gather_tile(source, census, {});
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

// ---- Each pair of triangles whose boxes overlap, or are at most the clearance apart, belongs to
// exactly one tile, and both triangles meet that tile (docs/tiles.md). Twins with one word of the
// definitions changed lose or repeat pairs.

// The definitions, as they are or changed.
struct Rules {
  std::function<bool(const Tile&, double, double, double)> meets = farcull::meets;
  std::function<bool(const Tile&, double)> holds = farcull::holds;
  std::function<double(double, double)> place = [](double a, double b) { return std::max(a, b); };
};

struct Faults {
  int lost = 0, repeated = 0;
};

// Boxes and cuts on whole numbers, which are equal often.
Faults faults_of(const Rules& rules) {
  RandomNumbers random(1);
  Faults out;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<Box> boxes(4);
    for (Box& box : boxes) {
      for (int i = 0; i < 3; ++i) {
        box.lo[i] = random.below(5);
        box.hi[i] = box.lo[i] + random.below(3);
      }
    }
    std::vector<double> cuts(random.below(std::size_t{5}));
    for (double& cut : cuts) cut = random.below(6);
    std::ranges::sort(cuts);
    const int axis = random.below(3);
    const double clearance = trial % 2 == 0 ? 0 : 0.5 * random.below(5);
    const auto near = [&](const Box& a, const Box& b) {
      return ((a.lo - b.hi).array() <= clearance).all() &&
             ((b.lo - a.hi).array() <= clearance).all();
    };
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (!near(boxes[a], boxes[b])) continue;
        int times = 0;
        for (std::size_t k = 0; k <= cuts.size(); ++k) {
          const Tile tile = tile_of(axis, cuts, k);
          const auto meets = [&](const Box& box) {
            return rules.meets(tile, box.lo[axis], box.hi[axis], clearance);
          };
          times += meets(boxes[a]) && meets(boxes[b]) &&
                   rules.holds(tile, rules.place(boxes[a].lo[axis], boxes[b].lo[axis]));
        }
        out.lost += times == 0;
        out.repeated += times > 1;
      }
    }
  }
  return out;
}

TEST(Tiles, EachPairBelongsToOneTile) {
  const Faults faults = faults_of({});
  EXPECT_EQ(faults.lost, 0);
  EXPECT_EQ(faults.repeated, 0);
}

TEST(TilesTwin, OfOtherDefinitionsPairsAreLostOrRepeated) {
  const auto lost = [](const Rules& rules) { return faults_of(rules).lost; };
  // A triangle that ends on the cut is dropped; or one that ends within the clearance of it.
  EXPECT_GT(
      lost({.meets = [](const Tile& tile, double lo, double hi,
                        double clearance) { return lo < tile.to && tile.from - hi < clearance; }}),
      0);
  EXPECT_GT(lost({.meets = [](const Tile& tile, double lo, double hi,
                              double) { return lo < tile.to && hi >= tile.from; }}),
            0);
  // A pair has its place where the earlier of its boxes begins.
  EXPECT_GT(lost({.place = [](double a, double b) { return std::min(a, b); }}), 0);
  // Tiles hold both of their ends.
  const Faults both = faults_of(
      {.meets = [](const Tile& tile, double lo, double hi,
                   double clearance) { return lo <= tile.to && tile.from - hi <= clearance; },
       .holds = [](const Tile& tile, double at) { return at >= tile.from && at <= tile.to; }});
  EXPECT_EQ(both.lost, 0);
  EXPECT_GT(both.repeated, 0);
}

TEST(Tiles, TheFirstAndTheLastTileHaveNoEnd) {
  const std::vector<double> cuts = {1, 1, 2};
  EXPECT_TRUE(holds(tile_of(0, cuts, 0), -HUGE_VAL));
  EXPECT_FALSE(holds(tile_of(0, cuts, 0), 1));
  EXPECT_FALSE(holds(tile_of(0, cuts, 1), 1));  // between equal cuts lies nothing
  EXPECT_TRUE(holds(tile_of(0, cuts, 2), 1));
  EXPECT_TRUE(holds(tile_of(0, cuts, 3), 1e308));
}

}  // namespace
}  // namespace farcull
