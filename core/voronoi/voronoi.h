// The discrete Voronoi diagram of objects, and the neighbours that it finds.
//
// As published: Sud, Govindaraju, Gayle, Kabul, Manocha (Fast Proximity Computation Among
// Deformable Models using Discrete Voronoi Diagrams, SIGGRAPH 2006), after Hoff, Keyser, Lin,
// Manocha, Culver (Fast Computation of Generalized Voronoi Diagrams Using Graphics Hardware,
// SIGGRAPH 1999). A grid of cubes covers the scene, and each cell knows the two objects that are
// nearest to its centre, with distances in float. Two objects are potential neighbours where some
// cell names both. A cell that lies between the nearest points of two objects may have its centre
// nearer to a third one, so this loses neighbours.
//
// The reliable form beside it keeps in each cell every triangle that may hold an end of a shortest
// segment between two objects whose middle lies in the cell (theorem V9). It loses none.
// docs/voronoi.md has definitions and proofs.
//
// Both walk down a tree of blocks of cells, where the published form fills slice after slice. A
// block is left out if no cell in it can add to the answer.
//
// Both can also be computed slice by slice, on a device that rasterizes distances: on OpenGL
// (core/gl/voronoi.h) or on the CPU, cell by cell. The CPU divides each slab of slices into bricks,
// blocks of cells with the triangles that may matter there; the device computes the distances of
// the cells of each brick from these triangles.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/scene.h"
#include "core/voronoi/grid.h"

namespace farcull {

struct VoronoiOptions {
  int resolution = 64;  // cells along the longest side of the scene's box; 1 to kVoronoiLargest
  /// Half diagonals of a cell by which the reliable form widens it, 0 to 1. The proof
  /// asks for 1; less is there to show that it is needed.
  double widening = 1;
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
  std::uint64_t most_pairs = std::uint64_t{1} << 27;  // of triangles, that the reliable form keeps
};
constexpr int kVoronoiLargest = 1 << 14;

struct VoronoiCounts {
  std::array<int, 3> cells{};   // of the grid
  std::uint64_t blocks = 0;     // of cells, single cells among them, whose distances were computed
  std::uint64_t distances = 0;  // of a point and a triangle
};

/// Pairs of objects, sorted, each once: some cell has these two as its nearest objects. Of objects
/// as near (as floats) the first counts. Objects without triangles have no neighbours.
struct VoronoiNeighbours {
  std::vector<ObjectPair> objects;
  VoronoiCounts counts;
};

/// The published form. Preconditions: the scene satisfies validate(). Throws Error for options that
/// are out of range.
VoronoiNeighbours voronoi_neighbours(const Scene& scene, const VoronoiOptions& options,
                                     const Progress& progress = {});

/// The answer of the reliable form.
struct ReliableNeighbours {
  /// Let d be the least distance of an object A from another one. Every pair of triangles, one of
  /// A and one of another object, that are d apart is among these. Sorted, each once.
  std::vector<TrianglePair> triangles;
  std::vector<ObjectPair> objects;  // that these belong to; sorted, each once
  /// For each object an upper bound of d, in world units, rounded up; infinite where it has no
  /// triangle or no other object has one.
  std::vector<double> upper;
  VoronoiCounts counts;
};

/// The reliable form. Preconditions and errors as above. Throws Error where it would keep more
/// pairs than most_pairs and some millions: a cell then contains too much of the scene.
ReliableNeighbours reliable_neighbours(const Scene& scene, const VoronoiOptions& options,
                                       const Progress& progress = {});

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

  /// For each cell of the slice in a brick the two objects that are nearest to its centre among the
  /// triangles of the brick, by computed distances; the lower number first among those as near.
  /// kNone where there are fewer, and for cells of no brick. Bricks that do not meet the slice are
  /// left out; no two bricks share a cell. A distance errs by at most voronoi_bounds::error().
  virtual std::vector<std::array<std::uint32_t, 2>> nearest_two(int slice,
                                                                const VoronoiBricks& bricks) = 0;

  /// For each cell of the slice in a brick all triangles of the brick that satisfy
  /// lower <= the least upper bound of the brick's triangles + reach. Sorted by cell, then by
  /// triangle. The bounds hold (docs/voronoi.md, lemma V13). Throws Error where these are too many.
  virtual std::vector<VoronoiNear> near(int slice, const VoronoiBricks& bricks, float reach) = 0;
};

/// near() lists no more for a slice: 16 bytes each. Throws Error if it would.
constexpr std::size_t kVoronoiMostListed = std::size_t{1} << 24;
void require_voronoi_list(std::size_t listed);

/// On the cores of the CPU. threads: 0 for as many as there are cores.
std::unique_ptr<VoronoiDevice> cpu_voronoi_device(unsigned threads);

/// The two forms above, with the distances of all cells computed by the device. The answers
/// of the reliable form are as above; which other pairs it keeps may differ. Errors: as above, and
/// those of the device.
VoronoiNeighbours voronoi_neighbours(const Scene& scene, const VoronoiOptions& options,
                                     VoronoiDevice& device, const Progress& progress = {});
ReliableNeighbours reliable_neighbours(const Scene& scene, const VoronoiOptions& options,
                                       VoronoiDevice& device, const Progress& progress = {});

}  // namespace farcull
