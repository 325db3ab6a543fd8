// The diagram on OpenGL beside that of the CPU, and the reliable form on OpenGL against rationals.
#include "core/gl/voronoi/voronoi.h"

#include "tests/lab/gl.h"
#include "tests/lab/voronoi.h"
#include "tests/lab/voronoi_device.h"

namespace farcull {
namespace {

using lab::neighbours_scene;

TEST(GlVoronoi, PublishedIsThatOfTheCpuWithinTheErrors) {
  const std::unique_ptr<VoronoiDevice> device = gl_voronoi_device(lab::context());
  lab::SliceCounts counts;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Scene scene = neighbours_scene(seed);
    for (const int resolution : {1, 7, 16}) {
      lab::compare_with_all_cells(scene, resolution, *device, counts);
      ASSERT_EQ(counts.wrong, 0u) << "seed " << seed << ", resolution " << resolution;
    }
  }
  EXPECT_GT(counts.cells, 5'000u);
  EXPECT_GT(counts.same, counts.cells * 9 / 10);
}

TEST(GlVoronoi, NamesTheNeighboursThatTheCpuNames) {
  const std::unique_ptr<VoronoiDevice> device = gl_voronoi_device(lab::context());
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Scene scene = neighbours_scene(seed, 0);  // no ties: triangles of any size
    const VoronoiOptions options{.resolution = 24};
    EXPECT_EQ(voronoi_neighbours(scene, options, *device).objects,
              voronoi_neighbours(scene, options).objects)
        << "seed " << seed;
  }
}

// The bounds hold, and no triangle that satisfies the rule is left out.
TEST(GlVoronoi, ListsWhatTheBoundsKeep) {
  const std::unique_ptr<VoronoiDevice> device =
      gl_voronoi_device(lab::context(), {.list = 1});  // grows on the way
  const auto cpu = std::make_unique<lab::CpuVoronoiDevice>(1);
  std::uint64_t listed = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Scene scene = neighbours_scene(seed);
    const VoronoiGrid grid = voronoi_grid(scene, 9);
    const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, 1);
    const VoronoiBricks bricks = lab::all_bricks(grid, triangles.size());
    const float error = 2 * voronoi_bounds::error(grid.longest());
    device->start(triangles, grid);
    cpu->start(triangles, grid);
    for (int z = 0; z < grid.cells[2]; ++z) {
      const std::vector<VoronoiNear> gl = device->near(z, bricks, 1.75f);
      // What the CPU keeps with a reach that is smaller by the errors is there.
      const auto key = [](const VoronoiNear& n) { return std::pair(n.cell, n.triangle); };
      std::size_t at = 0;
      for (const VoronoiNear& n : cpu->near(z, bricks, 1.75f - 4 * error)) {
        while (at < gl.size() && key(gl[at]) < key(n)) ++at;
        ASSERT_TRUE(at < gl.size() && key(gl[at]) == key(n)) << "seed " << seed;
        EXPECT_NEAR(gl[at].upper, n.upper, error);
      }
      listed += gl.size();
    }
  }
  EXPECT_GT(listed, 1000u);
}

TEST(GlVoronoi, ReliableLosesNone) {
  const std::unique_ptr<VoronoiDevice> device = gl_voronoi_device(lab::context());
  const lab::SliceLosses losses = lab::losses_of_reliable(*device, 80, 1);
  EXPECT_GT(losses.pairs, 150u);
  EXPECT_EQ(losses.lost, 0u);
  EXPECT_EQ(losses.upper, 0u);
}
// The twin: without the widening.
TEST(GlVoronoi, ReliableLosesSomeWithoutTheWidening) {
  const std::unique_ptr<VoronoiDevice> device = gl_voronoi_device(lab::context());
  EXPECT_GT(lab::losses_of_reliable(*device, 80, 0).lost, 0u);
}

TEST(GlVoronoi, RefusesASliceThatHasNoRoom) {
  const std::unique_ptr<VoronoiDevice> device = gl_voronoi_device(lab::context());
  const Scene scene = lab::scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                                     {{Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}});
  EXPECT_THROW(voronoi_neighbours(scene, {.resolution = kVoronoiLargest}, *device), Error);
  // It says so from then on.
  EXPECT_THROW(voronoi_neighbours(scene, {.resolution = 4}, *device), Error);
}

}  // namespace
}  // namespace farcull
