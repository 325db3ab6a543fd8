// Computes the grid of the discrete Voronoi diagram. Converts triangles to units of the grid.
#include <algorithm>

#include "core/base/parallel.h"
#include "core/voronoi/voronoi.h"

namespace farcull {
namespace {

// Returns the next larger double, for results that must not be rounded down.
double up(double x) { return std::nextafter(x, HUGE_VAL); }

}  // namespace

int VoronoiGrid::longest() const { return *std::max_element(cells.begin(), cells.end()); }

double VoronoiGrid::world(double distance) const {
  if (!(distance > 0)) return 0;
  return up(std::ldexp(up(distance * cell), -exponent));
}

VoronoiGrid voronoi_grid(const Scene& scene, int resolution) {
  Box box = Box::empty();
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const Vec3& p : scene.corners(t)) box.add(p);
  }
  VoronoiGrid out;
  if (box.is_empty()) return out;
  out.lo = box.lo;
  double largest = 0;  // largest |coordinate| along the axes in which the box extends
  for (int k = 0; k < 3; ++k) {
    if (box.lo[k] < box.hi[k]) largest = std::max({largest, -box.lo[k], box.hi[k]});
  }
  if (!(largest > 0)) return out;
  // 2^exponent scales `largest` into [1, 2). Subnormal results err by less than 2^-1074, far less
  // than a cell, which is at least 2^-53 / kVoronoiLargest.
  out.exponent = -std::ilogb(largest);
  Vec3 extent = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (box.lo[k] < box.hi[k])
      extent[k] = up(std::ldexp(box.hi[k], out.exponent) - std::ldexp(box.lo[k], out.exponent));
  }
  const double most = extent.maxCoeff();
  if (!(most > 0)) return out;
  out.cell = up(most / resolution);
  for (std::size_t k = 0; k < 3; ++k) {
    // The factor covers the two roundings of the quotient.
    const double sides = extent[static_cast<int>(k)] / out.cell * (1 + 0x1p-50);
    out.cells[k] = std::min(resolution, static_cast<int>(sides) + 1);
  }
  return out;
}

std::vector<GridTriangle> grid_triangles(const Scene& scene, const VoronoiGrid& grid,
                                         unsigned threads) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<GridTriangle> out(scene.triangles.size());
  const std::size_t chunks = chunks_for(out.size(), 4096, threads);
  for_chunks(out.size(), chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<Vec3, 3> corners = scene.corners(static_cast<std::uint32_t>(t));
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto axis = static_cast<int>(k);
          // Where the box does not extend, scaled coordinates may be infinite.
          const double at = corners[i][axis], lo = grid.lo[axis];
          const double moved =
              at == lo ? 0 : std::ldexp(at, grid.exponent) - std::ldexp(lo, grid.exponent);
          out[t].corners[i][k] = static_cast<float>(moved / grid.cell);
        }
      }
      out[t].object = owner[t];
    }
  });
  return out;
}

}  // namespace farcull
