// The grid of the discrete Voronoi diagram, and triangles in its units.
//
// A coordinate x of the scene is x 2^exponent - lo, over `cell`, in units of the grid: the cells
// are the unit cubes [i, i + 1]. The scaling by a power of two keeps all finite doubles in range.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// The cubes [0, cells[0]] x [0, cells[1]] x [0, cells[2]] contain all triangles of the scene.
struct VoronoiGrid {
  int exponent = 0;
  Vec3 lo = Vec3::Zero();
  double cell = 1;
  std::array<int, 3> cells = {1, 1, 1};

  int longest() const;  // the largest of `cells`
  /// A distance in units of the grid, in world units, rounded up or kept; infinite where it is too
  /// large for a double.
  double world(double distance) const;
};

/// The grid with `resolution` cells along the longest side of the box of all triangles.
VoronoiGrid voronoi_grid(const Scene& scene, int resolution);

/// A triangle in units of the grid: each coordinate is at most 1.01 * 2^-24 longest() off.
struct GridTriangle {
  std::array<std::array<float, 3>, 3> corners;
  std::uint32_t object = 0;
};
std::vector<GridTriangle> grid_triangles(const Scene& scene, const VoronoiGrid& grid,
                                         unsigned threads);

}  // namespace farcull
