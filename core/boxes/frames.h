// Keeps the blocks and pairs found in one frame of a scene for the next frame. So triangles that
// did not move cost little in the next frame.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/boxes/meetings.h"
#include "core/scene/scene.h"

namespace farcull {

/// Results that plan_boxes() and find_boxes() keep from one frame for the next. An unfinished frame
/// leaves no results.
///
/// The corners of two triangles determine whether their boxes overlap. So two blocks without a
/// moved corner keep their pairs of triangles, and only blocks with a moved corner are examined.
/// The order of triangles is kept, too. Any order is correct, and a good order mostly stays good.
struct FrameMemory {
  MovedCorners moved;
  std::optional<std::uint64_t> frame;  // the last frame, if it was finished and decided by blocks
  double clearance = 0;
  bool neighbours = true;
  std::vector<ObjectPair> ignored;
  std::vector<TrianglePair> pairs;  // the candidates of the last frame
  bool oriented = false;  // `pairs` came from oriented boxes; reusable only if nothing moves
  BlockDecision counts;   // the decision of the last frame; only its counts are set

  /// Blocks of the last frame. The plan of that frame shares these blocks. If `blocks` is null, the
  /// members below are not used.
  std::shared_ptr<TriangleBlocks> blocks;
  std::optional<BlockTrees> trees;      // a tree for each object
  std::vector<std::uint32_t> block_of;  // per triangle: its block
  BlockPairs overlapping;               // all pairs of blocks that overlapped in the last frame
  bool normals = false;                 // triangles are also compared along their normals
  std::size_t usual = 0;                // overlapping.size() when the blocks were made
};

/// Decides as decide_by_blocks() does, for the frame after the one in `memory`. Preconditions:
/// - memory.moved has the corners that moved since the last frame.
/// - memory.clearance, memory.neighbours and memory.ignored are also valid for the new frame.
/// - If anything moved, memory.oriented is false.
BlockDecision decide_next_frame(const Scene& scene, unsigned threads, FrameMemory& memory);

}  // namespace farcull
