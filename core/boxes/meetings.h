// Finds pairs of objects whose boxes overlap, and decides how their pairs of triangles are found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/join.h"
#include "core/boxes/triangle_blocks.h"
#include "core/scene/scene.h"

namespace farcull {

/// A meeting: two objects whose boxes overlap, each grown by half the clearance; or one object that
/// is tested against itself (a == b). Object b has at least as many blocks as object a.
struct ObjectOverlap {
  std::uint32_t a, b;
};

/// All meetings of a scene.
struct ObjectOverlaps {
  std::vector<ObjectOverlap> all;
  std::uint64_t pairs = 0;  // number of meetings of two objects
  std::uint64_t self = 0;   // number of meetings of an object with itself
  bool crowded = false;     // more than 8 pairs of objects overlap per block. `all` is empty, since
                            // a list of these pairs would take more memory than the scene
};
/// Finds all meetings. ignored: pairs of objects that are not tested; a result of in_order().
ObjectOverlaps find_meetings(const Scene& scene, const TriangleBlocks& blocks,
                             std::span<const ObjectPair> ignored);

/// Returns for each object a box that contains all its possible contacts with another object or
/// with itself. The box is empty if the object is in no meeting.
std::vector<Box> boxes_of_meetings(const TriangleBlocks& blocks,
                                   std::span<const ObjectOverlap> meetings);

/// Limit for each meeting: the number of overlapping pairs of blocks, divided by the number of
/// blocks in these pairs. If a meeting exceeds the limit, the scene uses no axis-aligned boxes.
constexpr std::size_t kPairsPerBlock = 32;
/// Oriented boxes of blocks are tried if a sample has more than this many overlapping pairs of
/// triangle boxes per triangle. Pairs of one object with a common vertex do not count.
constexpr double kOverlapsPerTriangle = 16;
/// Oriented boxes are not tried if the scene has more than this many overlapping pairs of blocks
/// per block.
constexpr std::size_t kMostPairsPerBlock = 1024;

/// How the pairs of triangles of a scene are found: by boxes of blocks, or by a tree of the boxes
/// of all triangles.
struct BlockDecision {
  BlockMeetings blocks;               // empty if there is no meeting, or if a tree is used
  Reason tree = Reason::none;         // why a tree is used; none: blocks are used
  std::uint64_t tree_n = 0;           // Stage::n for the reason `tree`
  std::uint64_t pairs = 0, self = 0;  // as in ObjectOverlaps
};

/// Decides how pairs are found. Each way finds every pair at most the clearance apart. The first
/// rule that applies decides:
/// 1. A tree, if there are too many meetings to list, or if an object in a meeting is stretched
///    beyond kUneven (core/boxes/triangle_blocks.h).
/// 2. Blocks with axis-aligned boxes, if few of these boxes overlap. Triangles are also compared
///    along normals if this drops most pairs of a sample.
/// 3. Blocks with oriented boxes, if few of these boxes overlap in a sample.
/// 4. A tree.
/// threads: 0 for one per core; the result does not depend on it. ignored: see find_meetings().
/// along_axes: true leaves out rule 3, and in rule 2 the comparison along normals.
BlockDecision decide_by_blocks(const Scene& scene, double clearance, unsigned threads = 0,
                               std::span<const ObjectPair> ignored = {}, bool along_axes = false);

/// Applies rule 1 of decide_by_blocks(). Returns empty if rule 1 does not apply.
std::optional<BlockDecision> decide_by_meetings(const TriangleBlocks& blocks,
                                                const ObjectOverlaps& meetings);
/// Applies rules 2 to 4 of decide_by_blocks(). Preconditions: decide_by_meetings() returned empty;
/// the boxes or lanes of the blocks are set. regions: a result of boxes_of_meetings().
BlockDecision decide_by_pairs(const Scene& scene, const ObjectOverlaps& meetings,
                              const std::vector<Box>& regions, double clearance, unsigned threads,
                              std::shared_ptr<const TriangleBlocks> blocks,
                              bool along_axes = false);

/// Estimates the number of triangle pairs that the blocks find, per triangle. Does not count pairs
/// of one object with a common vertex. Reads only the vertices of a sample of the blocks.
double overlaps_by_sample(const Scene& scene, const BlockMeetings& meetings, double clearance);

/// Returns the number of triangles in all blocks that occur in the pairs.
std::uint64_t triangles_in(const BlockPairs& pairs, const TriangleBlocks& blocks);

/// Returns all pairs of triangles whose boxes overlap, sorted. Returns empty if decide_by_blocks()
/// with `along_axes` chooses a tree. ignored, threads: see decide_by_blocks(). neighbours: false
/// leaves out pairs of triangles of one object that share a vertex index.
std::optional<std::vector<TrianglePair>> pairs_of_boxes(const Scene& scene,
                                                        std::span<const ObjectPair> ignored,
                                                        bool neighbours, unsigned threads);
/// Returns the pairs of these triangles (ascending) whose boxes overlap, as OrderedPairs does.
/// Throws Error if there are more than 2^32 / 3 triangles.
std::vector<TrianglePair> pairs_of_some(const Scene& scene, std::span<const std::uint32_t> items,
                                        unsigned threads);

}  // namespace farcull
