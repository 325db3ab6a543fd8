// The discrete Voronoi diagram: its grid and distances against rationals, the published form
// against all cells one by one, the reliable form against all pairs in rationals.
#include "core/voronoi/voronoi.h"

#include "tests/lab/voronoi.h"

namespace farcull {
namespace {

using lab::neighbours_scene, rational::Q;

Q squared(const Q& x) { return x * x; }

Scene scene_of_triangles(const std::vector<std::array<Vec3, 3>>& triangles) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects;
  for (const auto& t : triangles) objects.push_back({t});
  return lab::scene_of(objects);
}

// ---- grid and distances ----

// Coordinates of any size: near 1, of very different sizes, huge, subnormal, far from the origin.
std::array<Vec3, 3> any_triangle(rational::Random& random, int kind) {
  std::array<Vec3, 3> out;
  for (Vec3& p : out) {
    if (kind == 0) p = random.cube(1);
    if (kind == 1) p = random.scaled3(-60, 10);
    if (kind == 2) p = random.cube(1) * 1.7e308;
    if (kind == 3) p = random.cube(1) * 1e-318;
    if (kind == 4) p = Vec3(1e9, -1e9, 1) + random.cube(1e-3);
    if (kind == 5) p = random.cube(1) * (random.coin() ? 1e308 : 1e-320);
    if (kind == 6) p = random.cube(1e-20) + Vec3(1e300, 0, 0);
  }
  return out;
}

TEST(VoronoiGrid, ContainsWhatTheSceneHasAndRoundsItAsSaid) {
  rational::Random random(1);
  for (int i = 0; i < trials(2000); ++i) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (int t = 0; t < 3; ++t) triangles.push_back(any_triangle(random, i % 7));
    const Scene scene = scene_of_triangles(triangles);
    const int resolution = 1 + random.below(1024);
    const VoronoiGrid grid = voronoi_grid(scene, resolution);
    ASSERT_LE(grid.longest(), resolution);
    Q scale = 1;
    mpq_mul_2exp(scale.get_mpq_t(), scale.get_mpq_t(),
                 static_cast<unsigned>(std::max(0, grid.exponent)));
    mpq_div_2exp(scale.get_mpq_t(), scale.get_mpq_t(),
                 static_cast<unsigned>(std::max(0, -grid.exponent)));
    const Q allowed = Q(grid.longest()) * Q(1.01 * 0x1p-24);
    const std::vector<GridTriangle> converted = grid_triangles(scene, grid, 1);
    for (std::uint32_t t = 0; t < 3; ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto axis = static_cast<int>(k);
          const Q exact = (Q(scene.corners(t)[c][axis]) - Q(grid.lo[axis])) * scale / Q(grid.cell);
          // A coordinate that the scaling makes subnormal may pass the box by that much.
          ASSERT_GE(exact, Q(-0x1p-900)) << "case " << i;
          ASSERT_LE(exact, Q(grid.cells[k])) << "case " << i;
          ASSERT_LE(abs(exact - Q(static_cast<double>(converted[t].corners[c][k]))), allowed)
              << "case " << i;
        }
      }
    }
  }
}

// How many of the bounds that `error` makes are wrong.
int wrong_bounds(int count, float error_share) {
  rational::Random random(2);
  int wrong = 0;
  for (int i = 0; i < count; ++i) {
    const int longest = 1 << random.below(11);
    const GridTriangle triangle = lab::drawn_triangle(random, static_cast<float>(longest));
    GridPoint point;
    for (float& x : point) x = static_cast<float>(random.below(2 * longest) + 1) * 0.5f;
    const GridDistance d = distance_of(point, triangle, error_share * voronoi_error(longest));
    const Q exact = lab::squared_distance(point, triangle);
    wrong += squared(Q(static_cast<double>(d.lower))) > exact ||
             squared(Q(static_cast<double>(d.upper))) < exact;
  }
  return wrong;
}

TEST(VoronoiDistance, LiesBetweenItsBounds) { EXPECT_EQ(wrong_bounds(trials(50'000), 1), 0); }

// The twin: without the error that was derived.
TEST(VoronoiDistance, LiesOutsideOfBoundsWithoutTheError) {
  EXPECT_GT(wrong_bounds(trials(50'000), 0), 0);
}

// ---- the published form ----

// By its definition: every cell, every triangle.
std::vector<ObjectPair> by_all_cells(const Scene& scene, int resolution) {
  const VoronoiGrid grid = voronoi_grid(scene, resolution);
  const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, 1);
  std::set<ObjectPair> out;
  std::array<int, 3> cell{};
  for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0]) {
    for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1]) {
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        GridPoint centre;
        for (std::size_t k = 0; k < 3; ++k) centre[k] = static_cast<float>(cell[k]) + 0.5f;
        std::vector<std::pair<float, std::uint32_t>> near(scene.objects.size());
        for (std::uint32_t o = 0; o < near.size(); ++o) near[o] = {HUGE_VALF, o};
        for (const GridTriangle& t : triangles) {
          const float d = distance_of(centre, t, voronoi_error(grid.longest())).computed;
          near[t.object].first = std::min(near[t.object].first, d);
        }
        std::ranges::sort(near);
        if (near.size() < 2 || near[1].first == HUGE_VALF) continue;
        out.insert(
            {std::min(near[0].second, near[1].second), std::max(near[0].second, near[1].second)});
      }
    }
  }
  return {out.begin(), out.end()};
}

TEST(Voronoi, IsThatOfAllCells) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(300)); ++seed) {
    const Scene scene = neighbours_scene(seed);
    for (const int resolution : {1, 2, 7, 16}) {
      EXPECT_EQ(voronoi_neighbours(scene, {.resolution = resolution}).objects,
                by_all_cells(scene, resolution))
          << "seed " << seed << ", resolution " << resolution;
    }
  }
}

TEST(Voronoi, LosesNearestNeighboursByItsGrid) {
  lab::Losses losses;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(400)); ++seed) {
    const Scene scene = neighbours_scene(seed);
    lab::count_losses(scene, exact_distance::nearest_neighbours(scene),
                      voronoi_neighbours(scene, {.resolution = 64}).objects, losses);
  }
  EXPECT_GT(losses.lost, 0u);
  EXPECT_LT(losses.lost, losses.objects / 2);
  RecordProperty("lost", static_cast<int>(losses.lost));
}

// By how much the nearest object leads: the distance of the next one less its own. World units.
double lead_of(const Scene& scene, std::uint32_t object) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<double> squared(scene.objects.size(), HUGE_VAL);
  const auto corners = [&](std::uint32_t t) {
    return exact_distance::converted<double>(scene.corners(t));
  };
  for (std::uint32_t a = 0; a < owner.size(); ++a) {
    for (std::uint32_t b = 0; b < owner.size(); ++b) {
      if (owner[a] != object || owner[b] == object) continue;
      squared[owner[b]] =
          std::min(squared[owner[b]], exact_distance::between(corners(a), corners(b)));
    }
  }
  std::ranges::sort(squared);
  return std::sqrt(squared[1]) - std::sqrt(squared[0]);
}

// Objects that lose all nearest neighbours although these lead by that many diagonals of a cell.
std::uint64_t lost_with_lead(double diagonals) {
  std::uint64_t out = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(500)); ++seed) {
    const Scene scene = neighbours_scene(seed, seed % 2 ? lab::kClusterKind : 0);
    const int resolution = 16 << (seed % 5);
    const VoronoiNeighbours found = voronoi_neighbours(scene, {.resolution = resolution});
    const VoronoiGrid grid = voronoi_grid(scene, resolution);
    const std::vector<std::uint32_t> owner = owners(scene);
    const std::vector<exact_distance::Nearest> truth = exact_distance::nearest_neighbours(scene);
    for (std::uint32_t o = 0; o < truth.size(); ++o) {
      lab::Losses losses;
      lab::count_losses(scene, {truth[o]}, found.objects, losses);
      if (losses.lost > 0 && lead_of(scene, o) > diagonals * grid.world(std::sqrt(3))) ++out;
    }
  }
  return out;
}

TEST(Voronoi, LosesNoneThatLeadsByADiagonal) { EXPECT_EQ(lost_with_lead(1.01), 0u); }

// The twin: a twentieth of a diagonal is not enough.
TEST(Voronoi, LosesSomeThatLeadByLess) { EXPECT_GT(lost_with_lead(0.05), 0u); }

// ---- the reliable form ----

// Nearest pairs of triangles that are not among those found, and upper bounds that are too low.
struct Faults {
  std::uint64_t lost = 0, pairs = 0, upper = 0, objects = 0;
};
Faults faults_of_reliable(std::uint64_t scenes, double widening) {
  Faults out;
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    const Scene scene = neighbours_scene(seed);
    constexpr std::array<int, 7> kResolutions = {1, 2, 3, 5, 8, 16, 33};
    const VoronoiNeighbours found =
        reliable_neighbours(scene, {.resolution = kResolutions[seed % 7], .widening = widening});
    const std::vector<exact_distance::Nearest> truth = exact_distance::nearest_neighbours(scene);
    const std::vector<std::uint32_t> owner = owners(scene);
    for (std::size_t o = 0; o < truth.size(); ++o) {
      out.upper += squared(Q(found.upper[o])) < truth[o].squared;
      for (const TrianglePair& pair : truth[o].pairs) {
        ++out.pairs;
        out.lost += !std::ranges::binary_search(found.triangles, pair);
        out.objects += !lab::holds(found.objects, owner[pair.a], owner[pair.b]);
      }
    }
  }
  return out;
}

TEST(VoronoiReliable, KeepsEveryNearestPair) {
  const Faults faults = faults_of_reliable(static_cast<std::uint64_t>(trials(10'000)), 1);
  EXPECT_GT(faults.pairs, 20'000u / 8);
  EXPECT_EQ(faults.lost, 0u);
  EXPECT_EQ(faults.objects, 0u);
  EXPECT_EQ(faults.upper, 0u);
}

// Twins: without the widening, and with half of it.
TEST(VoronoiReliable, LosesPairsWithoutTheWidening) {
  EXPECT_GT(faults_of_reliable(static_cast<std::uint64_t>(trials(500)), 0).lost, 0u);
}
TEST(VoronoiReliable, LosesPairsWithHalfTheWidening) {
  EXPECT_GT(faults_of_reliable(static_cast<std::uint64_t>(trials(1000)), 0.5).lost, 0u);
}

TEST(VoronoiReliable, DoesNotDependOnThreads) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = lab::random_scene(seed);
    for (const int resolution : {3, 20, 64}) {
      const VoronoiOptions one{.resolution = resolution, .threads = 1};
      const VoronoiNeighbours kept = reliable_neighbours(scene, one);
      const VoronoiNeighbours named = voronoi_neighbours(scene, one);
      for (const unsigned threads : {2u, 5u}) {
        const VoronoiOptions more{.resolution = resolution, .threads = threads};
        const VoronoiNeighbours same = reliable_neighbours(scene, more);
        EXPECT_EQ(same.triangles, kept.triangles);
        EXPECT_EQ(same.objects, kept.objects);
        EXPECT_EQ(same.upper, kept.upper);
        EXPECT_EQ(same.counts.distances, kept.counts.distances);
        EXPECT_EQ(voronoi_neighbours(scene, more).objects, named.objects);
      }
    }
  }
}

// Pairs of objects that cross, at coordinates of any size: each has the other, 0 apart.
TEST(VoronoiReliable, TakesAnyFiniteCoordinates) {
  for (const double size : {1e308, 1.0, 1e-300, 1e-318, 4.94065645841246544e-324}) {
    const std::array<Vec3, 3> t = {Vec3(0, 0, 0), Vec3(size, -0.0, 0), Vec3(0, size, 0)};
    const std::array<Vec3, 3> far = {Vec3(-size, -size, -size), Vec3(-size, -size, -size),
                                     Vec3(-size, -size, -size)};
    const Scene scene = scene_of_triangles({t, t, far});
    for (const int resolution : {1, 16, 100}) {
      const VoronoiNeighbours found = reliable_neighbours(scene, {.resolution = resolution});
      EXPECT_TRUE(lab::holds(found.objects, 0, 1)) << size;
      EXPECT_TRUE(lab::holds(found.objects, 0, 2)) << size;
    }
  }
}

TEST(VoronoiReliable, TakesScenesWithoutNeighbours) {
  const std::array<Vec3, 3> point = {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
  for (const auto& objects : std::vector<std::vector<std::vector<std::array<Vec3, 3>>>>{
           {}, {{}}, {{}, {}}, {{point}}, {{point}, {}}}) {
    const Scene scene = lab::scene_of(objects);
    EXPECT_TRUE(reliable_neighbours(scene, {}).triangles.empty());
    EXPECT_TRUE(voronoi_neighbours(scene, {}).objects.empty());
    for (const double upper : reliable_neighbours(scene, {}).upper) EXPECT_EQ(upper, HUGE_VAL);
  }
  const Scene two = lab::scene_of({{point}, {}, {point}});
  EXPECT_EQ(reliable_neighbours(two, {}).triangles, (std::vector<TrianglePair>{{0, 1}}));
  EXPECT_EQ(voronoi_neighbours(two, {}).objects, (std::vector<ObjectPair>{{0, 2}}));
}

TEST(VoronoiReliable, RefusesBadOptions) {
  const Scene scene = neighbours_scene(0);
  for (const int resolution : {-1, 0, kVoronoiLargest + 1}) {
    EXPECT_THROW(reliable_neighbours(scene, {.resolution = resolution}), Error);
    EXPECT_THROW(voronoi_neighbours(scene, {.resolution = resolution}), Error);
  }
  for (const double widening : {-0.1, 1.1, std::nan("")})
    EXPECT_THROW(reliable_neighbours(scene, {.widening = widening}), Error);
}

}  // namespace
}  // namespace farcull
