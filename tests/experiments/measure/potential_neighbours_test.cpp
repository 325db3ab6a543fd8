// Sets of potential neighbours and what they lose, against rationals and against the pairs that the
// diagrams leave, on small random scenes.
#include "experiments/measure/neighbour_sets.h"

#include "experiments/scenes/builtin/scenes.h"
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

// Compares the set of each object with its definition.
void check(const Scene& scene, const NeighbourOptions& options) {
  const NeighbourSets sets = neighbour_sets(scene, options);
  const std::vector<SetSize> sizes = set_sizes(scene, sets);
  const std::vector<NearestObjects> found = nearest_objects(scene);
  const VoronoiOptions diagram{.resolution = options.resolution, .widening = options.widening};
  const bool reliable = options.method == NeighbourMethod::voronoi_reliable;
  const VoronoiNeighbours kept = reliable_neighbours(scene, diagram);
  const std::vector<ObjectPair> pairs =
      reliable ? kept.objects : voronoi_neighbours(scene, diagram).objects;
  EXPECT_EQ(sets.objects.size(), pairs.size());
  const std::vector<std::uint32_t> owner = owners(scene);
  const std::vector<exact_distance::Nearest> truth = exact_distance::nearest_neighbours(scene);
  ASSERT_EQ(found.size(), truth.size());
  ASSERT_EQ(sizes.size(), truth.size());
  for (std::uint32_t o = 0; o < truth.size(); ++o) {
    std::set<std::uint32_t> nearest, triangles;
    for (const TrianglePair& pair : truth[o].pairs)
      nearest.insert(owner[pair.a] == o ? owner[pair.b] : owner[pair.a]);
    EXPECT_EQ(std::set(found[o].objects.begin(), found[o].objects.end()), nearest);
    const std::set<std::uint32_t> others = others_of(pairs, o);
    EXPECT_EQ(sizes[o].objects, others.size());
    for (std::uint32_t t = 0; t < owner.size(); ++t)
      if (owner[t] != o && others.contains(owner[t]) && !reliable) triangles.insert(t);
    for (const TrianglePair& pair : kept.triangles) {
      if (!reliable) break;
      if (owner[pair.a] == o) triangles.insert(pair.b);
      if (owner[pair.b] == o) triangles.insert(pair.a);
    }
    EXPECT_EQ(sizes[o].triangles, triangles.size());
  }
}

TEST(NeighbourSets, AreWhatTheDiagramLeaves) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(120)); ++seed) {
    SCOPED_TRACE(seed);
    const int resolution = 1 + static_cast<int>(seed * 7 % 40);
    for (const NeighbourMethod method :
         {NeighbourMethod::voronoi, NeighbourMethod::voronoi_reliable})
      check(neighbours_scene(seed), {.method = method, .resolution = resolution});
  }
}

std::uint64_t lost_by(const NeighbourOptions& options, int scenes) {
  std::uint64_t out = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(scenes)); ++seed) {
    const Scene scene = neighbours_scene(seed);
    out += sizes_of(scene, neighbour_sets(scene, options), nearest_objects(scene)).missed_pairs;
  }
  return out;
}

TEST(NeighbourSets, OfTheReliableDiagramLoseNone) {
  EXPECT_EQ(lost_by({.method = NeighbourMethod::voronoi_reliable, .resolution = 8}, 800), 0u);
}

// Twins: the published form, and the reliable one without its widening.
TEST(NeighbourSets, OfThePublishedDiagramLoseSome) {
  EXPECT_GT(lost_by({.method = NeighbourMethod::voronoi, .resolution = 8}, 400), 0u);
}
TEST(NeighbourSets, LoseSomeWithoutTheWidening) {
  EXPECT_GT(
      lost_by({.method = NeighbourMethod::voronoi_reliable, .resolution = 8, .widening = 0}, 800),
      0u);
}

TEST(NeighbourSets, OfObjectsWithoutTrianglesAreEmpty) {
  const std::array<Vec3, 3> point = {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
  const Scene scene = lab::scene_of({{point}, {}, {point}});
  const std::vector<NearestObjects> found = nearest_objects(scene);
  EXPECT_TRUE(found[1].objects.empty());
  EXPECT_EQ(found[0].objects, (std::vector<std::uint32_t>{2}));
  const NeighbourSets sets =
      neighbour_sets(scene, {.method = NeighbourMethod::voronoi, .resolution = 16});
  EXPECT_EQ(set_sizes(scene, sets)[1].objects, 0u);
}

// ---- Sets of neighbours: sizes that can be counted by hand, nothing lost by methods that promise
// it, and spoiled sets, whose losses are counted.

// Objects of one, two and one triangles at the heights 0, 1 and 3.
Scene tower() {
  const auto at = [](double z, double x) {
    return std::array{Vec3(x, 0, z), Vec3(x + 1, 0, z), Vec3(x, 1, z)};
  };
  return lab::scene_of({{at(0, 0)}, {at(1, 0), at(1, 10)}, {at(3, 0)}});
}

NeighbourSets sets_with(std::vector<ObjectPair> objects, std::vector<TrianglePair> pairs) {
  return {.objects = std::move(objects), .has_pairs = true, .pairs = std::move(pairs)};
}

TEST(NeighbourSets, HaveTheSizesThatCanBeCounted) {
  const Scene scene = tower();
  const std::vector<NearestObjects> truth = nearest_objects(scene);
  // Triangle 0 is object 0, triangles 1 and 2 are object 1, triangle 3 is object 2.
  const NeighbourSizes all =
      sizes_of(scene, sets_with({{0, 1}, {1, 2}}, {{0, 1}, {0, 2}, {1, 3}}), truth);
  EXPECT_EQ(all.with_nearest, 3u);
  EXPECT_EQ(all.missed, 0u);
  EXPECT_EQ(all.nearest_pairs, 3u) << "of 0 and 1 each other's, of 2 that of 1";
  EXPECT_EQ(all.missed_pairs, 0u);
  EXPECT_EQ(all.object_pairs, 2u);
  EXPECT_EQ(all.triangle_pairs, 3u);
  EXPECT_EQ(all.set_objects, 4u) << "1, 2 and 1";
  EXPECT_EQ(all.median_objects, 1u);
  EXPECT_EQ(all.most_objects, 2u);
  EXPECT_EQ(all.set_triangles, 5u) << "{1, 2}, {0, 3} and {1}";
  EXPECT_EQ(all.median_triangles, 2u);
  // The twin: what is not there is counted as lost.
  const NeighbourSizes less = sizes_of(scene, sets_with({{0, 1}}, {{0, 2}}), truth);
  EXPECT_EQ(less.missed, 1u) << "object 2";
  EXPECT_EQ(less.missed_pairs, 3u) << "the pair of triangles 0 and 1, twice, and 1 and 3";
}

TEST(NeighbourSets, OfWholeObjectsHaveAllTheirTriangles) {
  const Scene scene = tower();
  const NeighbourSets named{.objects = {{0, 1}, {1, 2}}, .left = {{1, 2}, {2, 1}}};
  const NeighbourSizes sizes = sizes_of(scene, named, nearest_objects(scene));
  EXPECT_EQ(sizes.triangle_pairs, 4u);
  EXPECT_EQ(sizes.set_triangles, 6u) << "2, 1 + 1 and 2";
  EXPECT_EQ(sizes.missed + sizes.missed_pairs, 0u);
}

// Boxes and trees promise it for any finite scene; the truth is computed in rationals, by code that
// shares nothing with either.
TEST(NeighbourSets, OfBoxesAndTreesLoseNothing) {
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene scene = lab::neighbours_scene(seed);
    const auto truth = exact_distance::nearest_neighbours(scene);
    // A power of two changes no other digit, so the truth stays.
    if (seed % 3 == 1)
      for (Vec3& v : scene.vertices) v = v * 0x1p-520;  // squares are below the normal numbers
    else if (seed % 3 == 2)
      for (Vec3& v : scene.vertices) v = v * 0x1p510;
    for (const NeighbourMethod method : {NeighbourMethod::boxes, NeighbourMethod::trees}) {
      const NeighbourSets sets = neighbour_sets(scene, {.method = method});
      lab::Losses losses;
      lab::count_losses(scene, truth, sets.objects, losses);
      EXPECT_EQ(losses.lost, 0u) << to_string(method);
    }
  }
}

TEST(NeighbourSets, SayWhyThereAreNone) {
  const Scene scene = make_builtin_scene("ground@tiny");
  const NeighbourOptions options{
      .method = NeighbourMethod::voronoi_reliable, .resolution = 64, .most_pairs = 1};
  const NeighbourSets none = neighbour_sets(scene, options);
  EXPECT_TRUE(has_text(none.left_out, "too many pairs"));
  EXPECT_THROW(sizes_of(scene, none, nearest_objects(scene)), std::logic_error);
  // The twin: an option that is out of range is no reason of the scene.
  EXPECT_EQ(error_of([&] {
              neighbour_sets(scene, {.method = NeighbourMethod::voronoi, .resolution = 0});
            }).where,
            "resolution");
}

}  // namespace
}  // namespace farcull
