// Oriented boxes of blocks of triangles. Boxes along the axes separate long, thin, oblique
// triangles poorly. So each block gets three directions, the principal directions of its corners.
// Two triangles are compared along the directions of the blocks of both triangles.
//
// If the projections of two sets on a direction have no common point, the sets have none. So any
// direction may be compared, and good directions separate more sets. Floats relative to one origin
// are used, and margins cover all rounding errors (docs/reliability.md, "Oriented boxes").
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

/// Three directions: those of an oriented box, of length 1 and perpendicular up to rounding.
using Frame = std::array<std::array<float, 3>, 3>;

/// A box along three directions: its middle, and half of each side.
struct OrientedBox {
  Frame frame;
  std::array<float, 3> middle, half;
};

/// Sixteen oriented boxes as columns.
struct alignas(64) WideOriented {
  std::array<std::array<std::array<float, kWide>, 3>, 3> frame;
  std::array<std::array<float, kWide>, 3> middle, half;
};

/// The triangles of a block, in the same lanes as in the block's BlockLanes.
struct alignas(64) OrientedLanes {
  std::array<std::array<std::array<float, kWide>, 3>, 3> corner;  // corner, coordinate, lane
  Frame frame;
  WideBoxes<float> boxes;  // boxes of the triangles along `frame`, grown by a margin
  FloatBox bound;          // the box around all boxes
};

/// The blocks of objects with a non-empty region. Triangles are in the order of spatial_order().
struct OrientedBlocks {
  TriangleBlocks blocks;                     // all objects with a region are gathered
  UninitializedVector<OrientedLanes> lanes;  // one for each of blocks.lanes
  std::vector<OrientedBox> boxes;            // one for each of blocks.lanes
  std::vector<BoxTree<float>> trees;         // per object, over its blocks
  std::vector<WideOriented> nodes;
  float margin = 0;  // two oriented boxes are apart if the gap along a direction is larger
};

/// Makes oriented blocks. Returns null if the coordinates are too large or too small for floats.
/// regions: as for gather_scattered(). threads: 0 for as many as there are cores.
std::shared_ptr<const OrientedBlocks> make_oriented(const Scene& scene, double clearance,
                                                    std::span<const Box> regions, unsigned threads);

/// As pair_blocks(), but appends pairs whose oriented boxes may have a common point.
void pair_oriented(const OrientedBlocks& blocks, std::uint32_t a, std::uint32_t b,
                   std::uint32_t from, std::uint32_t to, std::size_t most,
                   std::vector<BlockPair>& out);

/// As give_pairs_of_some(), but boxes must also overlap along the frame of each of the two blocks.
std::uint64_t give_pairs_of_oriented(const Scene& scene, const OrientedBlocks& blocks,
                                     const BlockPairs& pairs, double clearance, bool neighbours,
                                     unsigned threads, const TakePairs& take);

/// Gives the pairs of triangles in some pairs of blocks of the meetings: by
/// give_pairs_of_oriented() if the meetings have oriented boxes, else by give_pairs_of_some().
std::uint64_t give_pairs_of_blocks(const Scene& scene, const BlockMeetings& meetings,
                                   const BlockPairs& some, double clearance, bool neighbours,
                                   unsigned threads, const TakePairs& take);
/// Returns the pairs of triangles of all pairs of blocks, joined with meetings.kept, sorted.
std::vector<TrianglePair> pairs_of_blocks(const Scene& scene, const BlockMeetings& meetings,
                                          double clearance, bool neighbours, unsigned threads);

}  // namespace farcull
