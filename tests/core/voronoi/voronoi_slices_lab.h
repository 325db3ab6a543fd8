// What tests of a diagram that a device computes slice by slice share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/voronoi/voronoi.h"
#include "tests/core/base/rational.h"
#include "tests/core/voronoi/voronoi_lab.h"

namespace farcull::lab {

// A triangle in the unit cubes of a grid, often a needle, a segment or a point.
inline GridTriangle drawn_triangle(rational::Random& random, float longest) {
  GridTriangle out;
  const auto number = [&] { return static_cast<float>(random.uniform(0, longest)); };
  const float thin = std::exp2(static_cast<float>(-random.below(40)));
  for (auto& corner : out.corners) corner = {number(), number(), number()};
  auto& [a, b, c] = out.corners;
  switch (random.below(6)) {
    case 0:  // a needle
      for (std::size_t k = 0; k < 3; ++k) c[k] = std::min(longest, b[k] + thin);
      break;
    case 1:  // three points close to a line
      for (std::size_t k = 0; k < 3; ++k) c[k] = 0.5f * (a[k] + b[k]);
      c[0] = std::min(longest, c[0] + thin);
      break;
    case 2:
      c = b;
      break;
    case 3:
      c = b = a;
      break;
    default:
      break;
  }
  return out;
}

// A grid as one brick for each 8 x 8 x 8 cells, with all triangles.
inline VoronoiBricks all_bricks(const VoronoiGrid& grid, std::size_t triangles) {
  VoronoiBricks out;
  for (std::uint32_t t = 0; t < triangles; ++t) out.triangles.push_back(t);
  for (int z = 0; z < grid.cells[2]; z += 8) {
    for (int y = 0; y < grid.cells[1]; y += 8) {
      for (int x = 0; x < grid.cells[0]; x += 8) {
        out.bricks.push_back({{x, y, z},
                              {std::min(x + 8, grid.cells[0]), std::min(y + 8, grid.cells[1]),
                               std::min(z + 8, grid.cells[2])},
                              0,
                              triangles});
      }
    }
  }
  return out;
}

struct SliceCounts {
  std::uint64_t cells = 0;  // compared
  std::uint64_t same = 0;   // with the owners of the CPU's own diagram
  std::uint64_t wrong = 0;  // with an owner that the errors do not explain
};

// Each cell's owners beside the distances of the CPU's diagram. An owner may differ only where the
// distances tie within the errors of both.
inline void compare_with_all_cells(const Scene& scene, int resolution, VoronoiDevice& device,
                                   SliceCounts& counts) {
  const VoronoiGrid grid = voronoi_grid(scene, resolution);
  const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, 1);
  const float within = 2 * (voronoi_error(grid.longest()) + voronoi_bounds::error(grid.longest()));
  device.start(triangles, grid);
  const VoronoiBricks bricks = all_bricks(grid, triangles.size());
  std::vector<std::pair<float, std::uint32_t>> near(scene.objects.size()), sorted;
  for (int z = 0; z < grid.cells[2]; ++z) {
    const auto owners_of = device.nearest_two(z, bricks);
    for (std::uint32_t cell = 0; cell < owners_of.size(); ++cell) {
      const auto x = static_cast<int>(cell) % grid.cells[0];
      const auto y = static_cast<int>(cell) / grid.cells[0];
      const GridPoint centre = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                                static_cast<float>(z) + 0.5f};
      for (std::uint32_t o = 0; o < near.size(); ++o) near[o] = {HUGE_VALF, o};
      for (const GridTriangle& t : triangles) {
        const float d = distance_of(centre, t, voronoi_error(grid.longest())).computed;
        near[t.object].first = std::min(near[t.object].first, d);
      }
      sorted = near;
      std::sort(sorted.begin(), sorted.end());
      const auto& [a, b] = owners_of[cell];
      ++counts.cells;
      counts.same += a == sorted[0].second && b == sorted[1].second;
      const auto ties = [&](std::uint32_t object, float distance) {
        return object < near.size() && std::abs(near[object].first - distance) <= within;
      };
      counts.wrong += a == b || !ties(a, sorted[0].first) || !ties(b, sorted[1].first);
    }
  }
}

struct SliceLosses {
  std::uint64_t pairs = 0, lost = 0, upper = 0;
};

// Nearest pairs of triangles of random scenes that the reliable form loses on the device, and upper
// bounds that are too low.
inline SliceLosses losses_of_reliable(VoronoiDevice& device, int scenes, double widening) {
  SliceLosses out;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(scenes); ++seed) {
    const Scene scene = neighbours_scene(seed);
    constexpr std::array<int, 7> kResolutions = {1, 2, 3, 5, 8, 11, 20};
    const ReliableNeighbours found = reliable_neighbours(
        scene, {.resolution = kResolutions[seed % 7], .widening = widening}, device);
    const std::vector<exact_distance::Nearest> truth = exact_distance::nearest_neighbours(scene);
    for (std::size_t o = 0; o < truth.size(); ++o) {
      const rational::Q upper = std::isfinite(found.upper[o]) ? found.upper[o] : 1e300;
      out.upper += upper * upper < truth[o].squared;
      for (const TrianglePair& pair : truth[o].pairs) {
        ++out.pairs;
        out.lost += !std::binary_search(found.triangles.begin(), found.triangles.end(), pair);
      }
    }
  }
  return out;
}

}  // namespace farcull::lab
