// Which objects of a scene can meet, and whether boxes of blocks of their triangles find the pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/join.h"
#include "core/boxes/triangle_blocks.h"
#include "core/scene/scene.h"

namespace farcull {

/// Two objects whose boxes, grown by half the clearance, overlap, or one that is tested against
/// itself (a == b). a has no more blocks than b.
struct ObjectOverlap {
  std::uint32_t a, b;
};

/// All meetings of a scene.
struct ObjectOverlaps {
  std::vector<ObjectOverlap> all;
  std::uint64_t pairs = 0;  // of two objects
  std::uint64_t self = 0;   // of an object with itself
  bool crowded = false;     // there are more pairs of objects than 8 for each block. They are not
                            // listed, since that takes more memory than the scene: `all` is empty
};
/// ignored: objects that are not tested against each other, as in_order() gives them.
ObjectOverlaps find_meetings(const Scene& scene, const TriangleBlocks& blocks,
                             std::span<const ObjectPair> ignored);

/// Per object the box in which it can meet another one or itself; empty if it cannot.
std::vector<Box> boxes_of_meetings(const TriangleBlocks& blocks,
                                   std::span<const ObjectOverlap> meetings);

/// Boxes of blocks are used if every meeting has at most this many overlapping pairs of blocks for
/// each block that overlaps any.
constexpr std::size_t kPairsPerBlock = 32;
/// Oriented boxes of blocks are tried if, in a sample, the boxes of more pairs of triangles overlap
/// than this for each triangle, neighbours apart: slivers that lie askew have such boxes.
constexpr double kOverlapsPerTriangle = 16;
/// If boxes of more pairs of blocks overlap than this for each block of the scene, oriented boxes
/// are not tried.
constexpr std::size_t kMostPairsPerBlock = 1024;

/// How the pairs of a scene are found: by boxes of blocks, or by a tree of the boxes of all
/// triangles.
struct BlockDecision {
  BlockMeetings blocks;               // empty if nothing can meet, or if a tree decides
  Reason tree = Reason::none;         // why a tree decides; none: blocks decide
  std::uint64_t tree_n = 0;           // the number that the reason speaks of
  std::uint64_t pairs = 0, self = 0;  // as ObjectOverlaps has them
};

/// Compares the boxes of the blocks of objects that meet. The number of overlaps decides how pairs
/// are found: by blocks along the axes if few of them overlap, and along the normals of triangles
/// too if these drop most pairs of a sample, as where large triangles lie among small ones; by
/// oriented blocks if few of those overlap in a sample; else by a tree; also by a tree if there are
/// too many meetings to list, or an object is stretched beyond kUneven
/// (core/boxes/triangle_blocks.h). Each way finds every pair at most the clearance apart. threads:
/// 0 for as many as there are cores; changes no answer. ignored: as find_meetings().
BlockDecision decide_by_blocks(const Scene& scene, double clearance, unsigned threads = 0,
                               std::span<const ObjectPair> ignored = {});

/// As above, if the blocks and meetings are known. Null: the decision depends on the pairs of
/// blocks.
std::optional<BlockDecision> decide_by_meetings(const TriangleBlocks& blocks,
                                                const ObjectOverlaps& meetings);
/// As above, if the blocks have their boxes or lanes, and decide_by_meetings() does not decide.
/// regions: where its objects meet.
BlockDecision decide_by_pairs(const Scene& scene, const ObjectOverlaps& meetings,
                              const std::vector<Box>& regions, double clearance, unsigned threads,
                              std::shared_ptr<const TriangleBlocks> blocks);

/// How many pairs of triangles these meetings leave for each triangle in one of their blocks,
/// neighbours apart, by a sample of the pairs of blocks. Reads only vertices of their blocks.
double overlaps_by_sample(const Scene& scene, const BlockMeetings& meetings, double clearance);

/// Triangles in all blocks of some pairs.
std::uint64_t triangles_in(const BlockPairs& pairs, const TriangleBlocks& blocks);

/// All pairs of triangles whose boxes overlap, sorted, for what is drawn afterwards. Null if a tree
/// or oriented boxes would decide, or normals help. ignored, threads: as decide_by_blocks().
/// neighbours: false leaves out pairs of one object that share a vertex index.
std::optional<std::vector<TrianglePair>> pairs_of_boxes(const Scene& scene,
                                                        std::span<const ObjectPair> ignored,
                                                        bool neighbours, unsigned threads);

}  // namespace farcull
