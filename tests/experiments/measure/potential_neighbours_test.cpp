// Potential neighbours and what is lost of them, against rationals and against the pairs that the
// diagrams leave, on small random scenes.
#include "experiments/measure/neighbour_sets.h"

#include <nlohmann/json.hpp>

#include "tests/lab/voronoi.h"

namespace farcull {
namespace {

using lab::neighbours_scene;

std::set<std::uint32_t> others_of(const std::vector<ObjectPair>& pairs, std::uint32_t object) {
  std::set<std::uint32_t> out;
  for (const ObjectPair& pair : pairs) {
    if (pair.a == object) out.insert(pair.b);
    if (pair.b == object) out.insert(pair.a);
  }
  return out;
}

// The record of each object is what its own definition says.
void check(const Scene& scene, const DiagramOptions& options) {
  const DiagramRecord record = potential_neighbours(scene, options);
  const VoronoiOptions diagram{.resolution = options.resolution, .widening = options.widening};
  const bool reliable = options.form == DiagramForm::reliable;
  const ReliableNeighbours kept = reliable_neighbours(scene, diagram);
  const std::vector<ObjectPair> pairs =
      reliable ? kept.objects : voronoi_neighbours(scene, diagram).objects;
  EXPECT_EQ(record.object_pairs, pairs.size());
  const std::vector<std::uint32_t> owner = owners(scene);
  const std::vector<exact_distance::Nearest> truth = exact_distance::nearest_neighbours(scene);
  ASSERT_EQ(record.objects.size(), truth.size());
  for (std::uint32_t o = 0; o < truth.size(); ++o) {
    const PotentialNeighbours& of = record.objects[o];
    std::set<std::uint32_t> nearest, triangles;
    for (const TrianglePair& pair : truth[o].pairs)
      nearest.insert(owner[pair.a] == o ? owner[pair.b] : owner[pair.a]);
    EXPECT_EQ(std::set(of.nearest.begin(), of.nearest.end()), nearest);
    if (!nearest.empty()) {
      EXPECT_NEAR(of.distance * of.distance, truth[o].squared.get_d(), 1e-14);
    }
    const std::set<std::uint32_t> others = others_of(pairs, o);
    EXPECT_EQ(of.objects, others.size());
    std::uint64_t lost = 0;
    for (const std::uint32_t other : nearest) lost += !others.contains(other);
    if (reliable) {
      EXPECT_GE(of.lost, lost);
    } else
      EXPECT_EQ(of.lost, lost);
    for (std::uint32_t t = 0; t < owner.size(); ++t)
      if (owner[t] != o && others.contains(owner[t]) && !reliable) triangles.insert(t);
    for (const TrianglePair& pair : kept.triangles) {
      if (!reliable) break;
      if (owner[pair.a] == o) triangles.insert(pair.b);
      if (owner[pair.b] == o) triangles.insert(pair.a);
    }
    EXPECT_EQ(of.triangles, triangles.size());
  }
}

TEST(PotentialNeighbours, AreWhatTheDiagramLeaves) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(120)); ++seed) {
    SCOPED_TRACE(seed);
    const int resolution = 1 + static_cast<int>(seed * 7 % 40);
    for (const DiagramForm form : {DiagramForm::published, DiagramForm::reliable})
      check(neighbours_scene(seed), {.form = form, .resolution = resolution});
  }
}

// Nearest objects that are lost in all scenes.
std::uint64_t lost_by(const DiagramOptions& options, int scenes) {
  std::uint64_t out = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(scenes)); ++seed)
    out += totals_of(potential_neighbours(neighbours_scene(seed), options)).lost;
  return out;
}

TEST(PotentialNeighbours, ReliableOnesLoseNone) {
  EXPECT_EQ(lost_by({.form = DiagramForm::reliable, .resolution = 8}, 800), 0u);
}

// Twins: the published form, and the reliable one without its widening.
TEST(PotentialNeighbours, PublishedOnesLoseSome) {
  EXPECT_GT(lost_by({.form = DiagramForm::published, .resolution = 8}, 400), 0u);
}
TEST(PotentialNeighbours, LoseSomeWithoutTheWidening) {
  EXPECT_GT(lost_by({.form = DiagramForm::reliable, .resolution = 8, .widening = 0}, 800), 0u);
}

TEST(PotentialNeighbours, RecordsAddUp) {
  const Scene scene = neighbours_scene(4, lab::kClusterKind);
  const DiagramRecord record = potential_neighbours(scene, {.resolution = 16});
  const DiagramTotals totals = totals_of(record);
  EXPECT_EQ(totals.potential_objects, 2 * record.object_pairs);
  const nlohmann::ordered_json json = diagram_json(scene, record);
  std::uint64_t lost = 0;
  for (const auto& of : json["objects"]) lost += of["lost"].get<std::uint64_t>();
  EXPECT_EQ(lost, totals.lost);
  EXPECT_EQ(json["totals"]["lost"], totals.lost);
  EXPECT_EQ(json["objects"].size(), scene.objects.size());
  const std::string csv = diagram_csv(scene, record);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), scene.objects.size() + 1);
}

TEST(PotentialNeighbours, ObjectsWithoutTrianglesHaveNone) {
  const std::array<Vec3, 3> point = {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
  const Scene scene = lab::scene_of({{point}, {}, {point}});
  const DiagramRecord record = potential_neighbours(scene, {});
  EXPECT_TRUE(record.objects[1].nearest.empty());
  EXPECT_EQ(record.objects[1].objects, 0u);
  EXPECT_EQ(record.objects[0].nearest, (std::vector<std::uint32_t>{2}));
  EXPECT_TRUE(diagram_json(scene, record)["objects"][1]["distance"].is_null());
}

}  // namespace
}  // namespace farcull
