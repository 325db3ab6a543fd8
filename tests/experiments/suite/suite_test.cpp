// The small suite as a whole: its checksum, its kinds, and our own answers to all of it.
#include "experiments/suite/writer.h"

#include "experiments/method/run.h"
#include "tests/lab/flat.h"

namespace farcull {
namespace {

// The small suite of seed 1, as it was published. Where this changes, so do the answers of everyone
// who measures with it.
constexpr const char* kSmallSuite =
    "1b76c4219b612434cdde447621e97b7108df8b3202df21bec7b20570c005f58b";

TEST(Suite, TheSmallOneHasItsChecksum) {
  const ScratchFolder folder;
  const SuiteSummary written = write_suite(folder.folder(), {});
  EXPECT_EQ(written.index.sum, kSmallSuite);
  EXPECT_EQ(written.meshes.size(), 59u);
  const SuiteIndex read = read_suite(folder.folder());
  EXPECT_EQ(read.sum, kSmallSuite);
  EXPECT_EQ(read.size, "small");
  EXPECT_EQ(read.seed, 1u);
  std::uint64_t pairs = 0;
  for (const SuiteCounts& family : written.families) pairs += family.pairs;
  EXPECT_EQ(pairs, 10070u);
  const Error again = error_of([&] { write_suite(folder.folder(), {}); });
  EXPECT_EQ(again.reason, "is there already");
  folder.replace("suite.txt", "seed 1", "seed 2");
  EXPECT_EQ(error_of([&] { read_suite(folder.folder()); }).where, folder.path("suite.txt"));
}

TEST(Suite, EachFamilyHasPairsOnBothSidesAndEachKindIsThere) {
  std::set<SuiteKind> seen;
  for (const PairFamily& family : pair_families()) {
    SuiteSettings settings;
    settings.seed = 5;
    const SuitePairs pairs = make_pairs(family.name, settings);
    const SuiteCounts counts = counts_of(pairs);
    EXPECT_GE(counts.colliding * 12, counts.pairs) << family.name;
    EXPECT_LE(counts.colliding * 12, counts.pairs * 11) << family.name;
    for (const SuitePair& pair : pairs.pairs) seen.insert(pair.kind);
  }
  EXPECT_EQ(seen.size(), 9u);
}

TEST(Suite, AnotherSeedMakesOtherPairs) {
  const PairFamily& family = pair_families().front();
  const auto first = [&](std::uint64_t seed, std::uint64_t id) {
    return make_suite_pair(family, seed, id).a;
  };
  EXPECT_FALSE(first(1, 0) == first(2, 0));
  EXPECT_FALSE(first(1, 0) == first(1, 1));
  EXPECT_TRUE(first(1, 7) == first(1, 7));
}

TEST(Suite, MeshesOfTheSmallOneAreThoseOfTheFullOne) {
  const std::vector<std::string> small = mesh_names(SuiteSize::small);
  const std::vector<std::string> full = mesh_names(SuiteSize::full);
  EXPECT_EQ(small.size(), 59u);
  EXPECT_EQ(full.size(), 87u);
  EXPECT_TRUE(std::includes(full.begin(), full.end(), small.begin(), small.end()));
  EXPECT_EQ(std::set<std::string>(full.begin(), full.end()).size(), full.size());
}

/// A pair as a scene: two objects, or one with joined vertices where the triangles are neighbours.
Scene scene_of(const SuitePair& pair) {
  Scene scene;
  scene.name = "pair";
  scene.source_face = {0, 1};
  scene.vertices.assign(pair.a.begin(), pair.a.end());
  scene.vertices.insert(scene.vertices.end(), pair.b.begin(), pair.b.end());
  scene.triangles = {{0, 1, 2}, {3, 4, 5}};
  for (const auto& [i, j] : pair.shared) scene.triangles[1][j] = i;
  if (pair.shared.empty())
    scene.objects = {{"a", 0, 1, false}, {"b", 1, 1, false}};
  else
    scene.objects = {{"ab", 0, 2, true}};
  return scene;
}

TEST(SuiteAnswers, TheLibraryIsRightAboutEveryPair) {
  Collider two_objects({.threads = 1});
  Collider one_object({.threads = 1, .self = true});
  for (const PairFamily& family : pair_families()) {
    const SuitePairs pairs = make_pairs(family.name, {});
    for (const SuitePair& pair : pairs.pairs) {
      Collider& collider = pair.shared.empty() ? two_objects : one_object;
      const Result result = collider.find(Flat(scene_of(pair)).input());
      EXPECT_EQ(result.pairs.size() + result.neighbour_pairs.size() > 0, collides(pair.kind))
          << family.name << " " << pair.id << ", " << to_string(pair.kind);
    }
  }
}

std::string asked_device() {
  const char* const value = std::getenv("FARCULL_SUITE_DEVICE");
  return value != nullptr ? value : "native";
}

/// Whether the method reports the pair; everything is left in, so that it is drawn.
bool found_by(Method method, Session& session, const Scene& scene) {
  RunOptions options;
  options.method = method;
  options.device = asked_device();
  options.resolution = 32;
  options.full = true;
  options.verify = false;
  const Record record = run(scene, options, session);
  return record.collisions.pairs.size() + record.collisions.neighbour_pairs.size() > 0;
}

TEST(SuiteAnswers, FarAndBoxesAreRightAboutASampleThatIsDrawn) {
  Session session(asked_device(), 1, {});
  for (const PairFamily& family : pair_families()) {
    const SuitePairs pairs = make_pairs(family.name, {});
    for (std::size_t i = 0; i < pairs.pairs.size(); i += 9) {
      const SuitePair& pair = pairs.pairs[i];
      for (const Method method : {Method::far, Method::boxes}) {
        EXPECT_EQ(found_by(method, session, scene_of(pair)), collides(pair.kind))
            << to_string(method) << ": " << family.name << " " << pair.id << ", "
            << to_string(pair.kind);
      }
    }
  }
}

TEST(SuiteAnswers, BoxesFindTheListsOfAllMeshes) {
  Session session(asked_device(), 0, {});
  for (const std::string& name : mesh_names(SuiteSize::small)) {
    const SuiteMesh mesh = make_mesh(name, {});
    RunOptions options;
    options.method = Method::boxes;
    options.device = asked_device();
    options.verify = false;
    const Record record = run(mesh.scene, options, session);
    std::vector<TrianglePair> listed;
    for (const SuiteMeshPair& pair : mesh.pairs) listed.push_back(pair.pair);
    EXPECT_EQ(record.collisions.all(), listed) << name;
  }
}

// ---- The kinds of contact: those of neighbours by example, all others beside contact_kind(),
// which is written otherwise.

using Corners = std::array<Vec3, 3>;

const Corners kFlat = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};  // in the plane z = 0

TEST(SuiteKinds, NeighboursMeetWhereTheyShareMoreThanTheirEdge) {
  const auto neighbours = [](const Corners& a, const Corners& b) {
    return to_string(decide_neighbours(a, b, "test"));
  };
  const Vec3 p(0, 0, 0), q(4, 0, 0);
  EXPECT_EQ(neighbours(kFlat, {p, q, Vec3(1, 1, 0)}), "neighbours-meet");
  EXPECT_EQ(neighbours(kFlat, {p, q, Vec3(1, 1, 0x1p-1074)}), "neighbours-apart");
  EXPECT_EQ(neighbours(kFlat, {p, q, Vec3(1, -1, 0)}), "neighbours-apart");
  EXPECT_EQ(neighbours(kFlat, kFlat), "neighbours-meet");
}

TEST(SuiteKinds, CollideUnlessTheyAreApart) {
  EXPECT_FALSE(collides(SuiteKind::apart));
  EXPECT_FALSE(collides(SuiteKind::neighbours_apart));
  EXPECT_TRUE(collides(SuiteKind::touch_vertex));
}

TEST(SuiteKinds, CoordinatesAreWrittenAsPrintfDoes) {
  for (const double x : {0.0, -0.0, 1.5, -0.1, 0x1p-1074, -0x1.fffffffffffffp+1023, 1e-310}) {
    std::array<char, 64> buffer;
    std::snprintf(buffer.data(), buffer.size(), "%a", x);
    EXPECT_EQ(hexadecimal(x), buffer.data());
  }
}

constexpr std::uint64_t kEach = 120;  // pairs of a family

TEST(SuiteContactKinds, AreTheLabelsInEveryFamily) {
  std::array<int, kContactKinds.size()> of_kind{};
  int degenerate = 0;
  for (const PairFamily& family : pair_families()) {
    for (std::uint64_t id = 0; id < kEach; ++id) {
      const SuitePair pair = make_suite_pair(family, 11, id);
      const ContactKind kind = contact_kind(pair.a, pair.b);
      ASSERT_EQ(name_of(kind), to_string(decide_kind(pair.a, pair.b, family.name)))
          << family.name << " " << id;
      ASSERT_EQ(contact_shape(pair.b, pair.a).kind, kind) << family.name << " " << id;
      ++of_kind[static_cast<std::size_t>(kind)];
      degenerate += shape(pair.a) != Shape::triangle || shape(pair.b) != Shape::triangle;
    }
  }
  for (const ContactKind kind : kContactKinds)
    EXPECT_GT(of_kind[static_cast<std::size_t>(kind)], 0) << name_of(kind);
  EXPECT_GT(degenerate, 0);
}

// The twin: corners that are rounded to float before the kind is decided.
TEST(SuiteContactKinds, OfRoundedCornersAreCaught) {
  const auto rounded = [](Corners t) {
    for (Vec3& p : t) p = p.cast<float>().cast<double>();
    return t;
  };
  int caught = 0;
  for (const PairFamily& family : pair_families()) {
    for (std::uint64_t id = 0; id < 20; ++id) {
      const SuitePair pair = make_suite_pair(family, 11, id);
      const Corners a = rounded(pair.a), b = rounded(pair.b);
      if (!a[0].allFinite() || !a[1].allFinite() || !a[2].allFinite()) continue;
      if (!b[0].allFinite() || !b[1].allFinite() || !b[2].allFinite()) continue;
      caught += name_of(contact_kind(a, b)) != to_string(decide_kind(pair.a, pair.b, family.name));
    }
  }
  EXPECT_GT(caught, 20);
}

}  // namespace
}  // namespace farcull
