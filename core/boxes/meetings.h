// Finds objects that can meet, and decides if boxes of blocks find the pairs of triangles.
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

/// A meeting: two objects whose boxes, grown by half the clearance, overlap; or one object that is
/// tested against itself (a == b). Object a has no more blocks than b.
struct ObjectOverlap {
  std::uint32_t a, b;
};

/// All meetings of a scene.
struct ObjectOverlaps {
  std::vector<ObjectOverlap> all;
  std::uint64_t pairs = 0;  // number of meetings of two objects
  std::uint64_t self = 0;   // number of meetings of an object with itself
  bool crowded = false;     // `all` was left empty, since more than 8 pairs of objects overlap per
                            // block. Their list would take more memory than the scene
};
/// ignored: pairs of objects that are not tested against each other; a result of in_order().
ObjectOverlaps find_meetings(const Scene& scene, const TriangleBlocks& blocks,
                             std::span<const ObjectPair> ignored);

/// Returns for each object the box in which it can meet another object or itself. The box is empty
/// if the object can meet nothing.
std::vector<Box> boxes_of_meetings(const TriangleBlocks& blocks,
                                   std::span<const ObjectOverlap> meetings);

/// The limit for each meeting: overlapping pairs of blocks, divided by the number of blocks in
/// these pairs. If a meeting exceeds the limit, boxes of blocks along the axes are not used.
constexpr std::size_t kPairsPerBlock = 32;
/// Oriented boxes of blocks are tried if, in a sample, more than this many pairs of triangles'
/// boxes overlap per triangle, as for oblique slivers. Pairs of neighbours are not counted.
constexpr double kOverlapsPerTriangle = 16;
/// Oriented boxes are not tried if the scene has more than this many overlapping pairs of blocks
/// per block.
constexpr std::size_t kMostPairsPerBlock = 1024;

/// How the pairs of a scene are found: by boxes of blocks, or by a tree of the boxes of all
/// triangles.
struct BlockDecision {
  BlockMeetings blocks;               // empty if nothing can meet, or if a tree decides
  Reason tree = Reason::none;         // why a tree decides; none: blocks decide
  std::uint64_t tree_n = 0;           // the number in the text of `tree`
  std::uint64_t pairs = 0, self = 0;  // as in ObjectOverlaps
};

/// Decides how pairs are found. Each way finds every pair at most the clearance apart. The first
/// rule that fits decides:
/// 1. A tree, if too many objects meet to list the meetings, or if an object is stretched beyond
///    kUneven (core/boxes/triangle_blocks.h).
/// 2. Blocks with boxes along the axes, if few of these boxes overlap. Triangles are also compared
///    along normals if this drops most pairs of a sample.
/// 3. Blocks with oriented boxes, if few of these boxes overlap in a sample.
/// 4. A tree.
/// threads: 0 for as many as there are cores; changes no answer. ignored: as for find_meetings().
/// along_axes: true leaves out rule 3 and the normals of rule 2.
BlockDecision decide_by_blocks(const Scene& scene, double clearance, unsigned threads = 0,
                               std::span<const ObjectPair> ignored = {}, bool along_axes = false);

/// Returns the decision of decide_by_blocks(), or empty if blocks and meetings do not determine it.
std::optional<BlockDecision> decide_by_meetings(const TriangleBlocks& blocks,
                                                const ObjectOverlaps& meetings);
/// Returns the decision of decide_by_blocks(). Preconditions: decide_by_meetings() returned empty;
/// the blocks have their boxes or lanes. regions: a result of boxes_of_meetings().
BlockDecision decide_by_pairs(const Scene& scene, const ObjectOverlaps& meetings,
                              const std::vector<Box>& regions, double clearance, unsigned threads,
                              std::shared_ptr<const TriangleBlocks> blocks,
                              bool along_axes = false);

/// Estimates how many pairs of triangles are left per triangle of the blocks, not counting
/// neighbours. Samples pairs of blocks, and reads only vertices of these blocks.
double overlaps_by_sample(const Scene& scene, const BlockMeetings& meetings, double clearance);

/// Returns the number of triangles in all blocks that occur in the pairs.
std::uint64_t triangles_in(const BlockPairs& pairs, const TriangleBlocks& blocks);

/// Returns all pairs of triangles whose boxes overlap, sorted. Returns empty if decide_by_blocks(),
/// with boxes along the axes alone, chooses a tree. ignored, threads: as for decide_by_blocks().
/// neighbours: false leaves out pairs of one object that share a vertex index.
std::optional<std::vector<TrianglePair>> pairs_of_boxes(const Scene& scene,
                                                        std::span<const ObjectPair> ignored,
                                                        bool neighbours, unsigned threads);
/// Returns the pairs of these triangles (ascending) whose boxes overlap, as OrderedPairs does.
std::vector<TrianglePair> pairs_of_some(const Scene& scene, std::span<const std::uint32_t> items,
                                        unsigned threads);

}  // namespace farcull
