// Results of boxes of blocks that are kept from one frame of a scene to the next, so that triangles
// that did not move cost little.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/boxes/meetings.h"
#include "core/scene/scene.h"

namespace farcull {

/// What plan_boxes() and find_boxes() of one frame keep for those of the next. A frame that does
/// not come to its end leaves nothing behind for the next one.
///
/// Whether the boxes of two triangles or blocks overlap depends on their corners alone. So two
/// blocks in which no corner moved keep their pairs, and only blocks with a corner that moved are
/// examined. The order of triangles is kept too: any order gives right results, and a good order
/// stays good for a while.
struct FrameMemory {
  MovedCorners moved;
  std::optional<std::uint64_t> frame;  // last frame that was planned, found and decided by blocks
  double clearance = 0;
  bool neighbours = true;
  std::vector<ObjectPair> ignored;
  std::vector<TrianglePair> pairs;  // candidates from the blocks of the last frame
  bool oriented = false;  // pairs are from oriented boxes: usable only while nothing moves
  BlockDecision counts;   // of the last frame; only its numbers

  /// Blocks of the last frame, with all triangles of scattered objects in order. Null: not made
  /// yet, and the members below are empty. The plan of that frame shares them.
  std::shared_ptr<TriangleBlocks> blocks;
  std::optional<BlockTrees> trees;      // of all objects
  std::vector<std::uint32_t> block_of;  // per triangle
  BlockPairs overlapping;               // all pairs of the last frame that overlap
  bool normals = false;                 // their triangles are compared along normals too
  std::size_t usual = 0;                // overlapping.size() when the blocks were made
};

/// decide_by_blocks() for the frame after the one in `memory`. Preconditions: memory.moved says
/// what moved since memory.frame; its clearance, neighbours and ignored objects are unchanged; and
/// if anything moved, the last frame was not decided by oriented boxes.
BlockDecision decide_next_frame(const Scene& scene, unsigned threads, FrameMemory& memory);

}  // namespace farcull
