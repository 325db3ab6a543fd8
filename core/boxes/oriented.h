// Oriented boxes of blocks of triangles. Axis-aligned boxes separate long, thin, oblique triangles
// poorly. So each block gets three directions: the principal directions of its triangle corners.
// Two triangles are compared along the directions of both blocks.
//
// If the projections of two sets on a direction are disjoint, the sets are disjoint. So any
// direction may be used, and good directions separate more sets. Coordinates are floats relative to
// one origin, and margins cover all rounding errors (docs/reliability.md, "Oriented boxes").
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/uninitialized.h"
#include "core/boxes/block.h"
#include "core/boxes/join.h"
#include "core/boxes/triangle_blocks.h"

namespace farcull {

/// The three axes of an oriented box: unit vectors that are perpendicular, up to rounding.
using Frame = std::array<std::array<float, 3>, 3>;

/// An oriented box: its axes, its centre, and half of each side length.
struct OrientedBox {
  Frame frame;
  std::array<float, 3> middle, half;
};

/// Sixteen oriented boxes, stored as one column for each number.
struct alignas(64) WideOriented {
  std::array<std::array<std::array<float, kWide>, 3>, 3> frame;
  std::array<std::array<float, kWide>, 3> middle, half;
};

/// The triangles of a block. Each triangle has the same lane as in BlockLanes.
struct alignas(64) OrientedLanes {
  std::array<std::array<std::array<float, kWide>, 3>, 3> corner;  // corner, coordinate, lane
  Frame frame;
  WideBoxes<float> boxes;  // boxes of the triangles along `frame`, grown by a margin
  FloatBox bound;          // the box around all boxes
};

/// The blocks of objects with a non-empty region. Triangles are in the order of spatial_order().
struct OrientedBlocks {
  TriangleBlocks blocks;                     // every object is gathered
  UninitializedVector<OrientedLanes> lanes;  // one for each element of blocks.lanes
  std::vector<OrientedBox> boxes;            // one for each element of blocks.lanes
  std::vector<BoxTree<float>> trees;         // per object: the tree over its blocks
  std::vector<WideOriented> nodes;
  float margin = 0;  // two boxes are disjoint if their gap along a direction is larger than this
};

/// Makes oriented blocks. Returns null if the coordinates are too large or too small for floats.
/// regions: see gather_scattered(). threads: 0 for one per core.
std::shared_ptr<const OrientedBlocks> make_oriented(const Scene& scene, double clearance,
                                                    std::span<const Box> regions, unsigned threads);

/// Like pair_blocks(), but appends the pairs of blocks whose oriented boxes may overlap.
void pair_oriented(const OrientedBlocks& blocks, std::uint32_t a, std::uint32_t b,
                   std::uint32_t from, std::uint32_t to, std::size_t most,
                   std::vector<BlockPair>& out);

/// Like give_pairs_of_some(), but triangles must also overlap along the axes of both blocks.
std::uint64_t give_pairs_of_oriented(const Scene& scene, const OrientedBlocks& blocks,
                                     const BlockPairs& pairs, double clearance, bool neighbours,
                                     unsigned threads, const TakePairs& take);

/// Gives the pairs of triangles in the pairs of blocks `some`. Calls give_pairs_of_oriented() if
/// `meetings` has oriented boxes, else give_pairs_of_some().
std::uint64_t give_pairs_of_blocks(const Scene& scene, const BlockMeetings& meetings,
                                   const BlockPairs& some, double clearance, bool neighbours,
                                   unsigned threads, const TakePairs& take);
/// Returns the pairs of triangles in meetings.pairs, merged with meetings.kept, sorted.
std::vector<TrianglePair> pairs_of_blocks(const Scene& scene, const BlockMeetings& meetings,
                                          double clearance, bool neighbours, unsigned threads);

}  // namespace farcull
