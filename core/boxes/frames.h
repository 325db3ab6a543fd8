// Keeps results of boxes of blocks from one frame of a scene to the next, so that triangles that
// did not move cost little.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/boxes/meetings.h"
#include "core/scene/scene.h"

namespace farcull {

/// What plan_boxes() and find_boxes() keep from one frame for the next. A frame that is not
/// finished keeps nothing.
///
/// Corners alone decide whether two boxes overlap. So two blocks without a moved corner keep their
/// pairs of triangles, and only blocks with a moved corner are examined. The order of triangles is
/// kept as well: any order gives right results, and a good order stays good for a while.
struct FrameMemory {
  MovedCorners moved;
  std::optional<std::uint64_t> frame;  // the last frame, if it was finished and decided by blocks
  double clearance = 0;
  bool neighbours = true;
  std::vector<ObjectPair> ignored;
  std::vector<TrianglePair> pairs;  // the candidates of the last frame
  bool oriented = false;  // `pairs` are from oriented boxes: usable only while nothing moves
  BlockDecision counts;   // the decision of the last frame; only its counts are set

  /// Blocks of the last frame. The plan of that frame shares them. If null, the members below are
  /// not used.
  std::shared_ptr<TriangleBlocks> blocks;
  std::optional<BlockTrees> trees;      // a tree for each object
  std::vector<std::uint32_t> block_of;  // per triangle: its block
  BlockPairs overlapping;               // all pairs of blocks that overlap in the last frame
  bool normals = false;                 // triangles are also compared along their normals
  std::size_t usual = 0;                // overlapping.size() when the blocks were made
};

/// Decides as decide_by_blocks(), for the frame that follows the frame in `memory`. Preconditions:
/// - memory.moved has the corners that moved since the last frame.
/// - The clearance, neighbours and ignored objects are those of the last frame.
/// - If anything moved, memory.oriented is false.
BlockDecision decide_next_frame(const Scene& scene, unsigned threads, FrameMemory& memory);

}  // namespace farcull
