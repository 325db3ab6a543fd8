// The discrete Voronoi diagram computed slice by slice, on a device that rasterizes distances: on
// OpenGL (core/gl/voronoi/voronoi.h) or on the CPU, cell by cell. The CPU divides each slab of
// slices into bricks, blocks of cells with the triangles that may matter there; the device computes
// the distances of the cells of each brick from these triangles.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/proximity/voronoi.h"
#include "core/proximity/voronoi_grid.h"

namespace farcull {

/// Cells from.. to - 1 along each axis, and numbers of triangles, ascending, in a list.
struct VoronoiBrick {
  std::array<int, 3> from, to;
  std::size_t first = 0, count = 0;
};
struct VoronoiBricks {
  std::vector<VoronoiBrick> bricks;
  std::vector<std::uint32_t> triangles;

  std::span<const std::uint32_t> of(const VoronoiBrick& brick) const {
    return std::span(triangles).subspan(brick.first, brick.count);
  }
};

/// A triangle that is nearest to some point of a cell, as far as the device can say.
struct VoronoiNear {
  std::uint32_t cell = 0;  // x + cells[0] y, of the slice
  std::uint32_t triangle = 0;
  float lower = 0, upper = 0;  // bounds of its distance from the centre of the cell
};

class VoronoiDevice {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  virtual ~VoronoiDevice() = default;
  VoronoiDevice() = default;
  VoronoiDevice(const VoronoiDevice&) = delete;
  VoronoiDevice& operator=(const VoronoiDevice&) = delete;

  /// Sets the triangles and the grid of all that follows. Both have to outlive it. Throws Error
  /// where the device has no room for a slice.
  virtual void start(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid) = 0;

  /// Of each cell of the slice in a brick, the two objects that are nearest to its centre among the
  /// triangles of the brick, by computed distances; of those as near the lower number first. kNone
  /// where there are fewer, and for cells of no brick. Bricks that do not meet the slice are left
  /// out; no two bricks share a cell. A distance errs by at most voronoi_bounds::error().
  virtual std::vector<std::array<std::uint32_t, 2>> nearest_two(int slice,
                                                                const VoronoiBricks& bricks) = 0;

  /// For each cell of the slice in a brick all triangles of the brick that satisfy
  /// lower <= the least upper bound of the brick's triangles + reach. Sorted by cell, then by
  /// triangle. The bounds hold (docs/voronoi.md, lemma V13). Throws Error where these are too many.
  virtual std::vector<VoronoiNear> near(int slice, const VoronoiBricks& bricks, float reach) = 0;
};

/// Of a slice, near() lists no more: 16 bytes each. Throws Error where it would.
constexpr std::size_t kVoronoiMostListed = std::size_t{1} << 24;
void require_voronoi_list(std::size_t listed);

/// On the cores of the CPU. threads: 0 for as many as there are cores.
std::unique_ptr<VoronoiDevice> cpu_voronoi_device(unsigned threads);

/// The two forms of voronoi.h, with the distances of all cells computed by the device. The answers
/// of the reliable form are as in voronoi.h; which other pairs it keeps may differ. Errors: as in
/// voronoi.h, and those of the device.
VoronoiNeighbours voronoi_neighbours(const Scene& scene, const VoronoiOptions& options,
                                     VoronoiDevice& device, const Progress& progress = {});
ReliableNeighbours reliable_neighbours(const Scene& scene, const VoronoiOptions& options,
                                       VoronoiDevice& device, const Progress& progress = {});

}  // namespace farcull
