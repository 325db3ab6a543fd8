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
// block is left out where no cell in it can add to the answer. voronoi_device.h has both forms
// slice after slice, on a device.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/proximity/near_pairs.h"
#include "core/scene/scene.h"

namespace farcull {

struct VoronoiOptions {
  int resolution = 64;  // cells along the longest side of the scene's box; 1 to kVoronoiLargest
  /// Half diagonals of a cell by which the reliable form widens it, 0 to 1. 1 is what the proof
  /// asks for; less is there to show that it is needed.
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

/// What the reliable form keeps.
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

}  // namespace farcull
