// Regions in which the objects of a scene can meet, by boxes alone: of objects, and of blocks of
// their triangles.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/join.h"
#include "core/scene/scene.h"
#include "core/view/regions.h"

namespace farcull {

/// The regions in which the objects of a scene can meet.
struct PairRegions {
  std::vector<Box>
      objects;  // per object: contains all its points that can belong to a pair; empty: none
  Box reach = Box::empty();  // of all their triangles, grown by half the clearance
  std::uint64_t pairs = 0;   // of objects whose boxes, grown by half the clearance, overlap, and
                             // that are not ignored
  std::uint64_t self = 0;    // objects that collide with themselves
  bool crowded = false;      // more pairs of objects than 8 for each run have boxes that overlap;
                             // they were not listed, and `pairs` is 0
  std::vector<std::uint32_t> triangles;  // ascending: contains those that can meet anything
};
/// full: every object can meet anything, anywhere. threads: 0 for as many as there are cores.
/// ignored: objects that are not tested against each other, as in_order() gives them. Two objects
/// of a pair have no region where they meet, but each can be in the region of a third one.
PairRegions pair_regions(const Scene& scene, double clearance, bool full = false,
                         unsigned threads = 0, std::span<const ObjectPair> ignored = {});

/// Pairs of blocks for the meetings that are cheapest so, and the regions of all others. Their
/// `pairs` and `self` count all meetings of the scene.
struct PairParts {
  BlockMeetings blocks;
  PairRegions rest;
  /// Set if neither blocks nor views decide, but a tree of all boxes, with the number that it
  /// speaks of: join_uneven, or join_many_blocks. `rest` has all triangles then.
  Reason join = Reason::none;
  std::uint64_t join_n = 0;
  std::vector<TrianglePair> sample = {};  // some pairs of the others whose boxes overlap
};
/// Decides for each meeting (two objects whose boxes overlap, or an object that is tested against
/// itself) whether boxes of blocks find its candidates, or views. Blocks do where few of their
/// boxes overlap, since no view is as cheap then: see kPairsPerBlock and kOverlapsPerTriangle
/// below. all: nothing is left to views, unless the scene is `crowded`. threads: 0 for as many as
/// there are cores. ignored: as pair_regions(); the blocks of two such objects are never a pair.
PairParts split_meetings(const Scene& scene, double clearance, unsigned threads = 0,
                         bool all = false, std::span<const ObjectPair> ignored = {});

/// The memory of FAR pairs about a scene for its next frame, so that triangles that did not move
/// cost little: kept between plan_pairs() and find_pairs() of one frame and those of the next. A
/// frame that does not come to its end leaves nothing behind for the next one.
///
/// Whether the boxes of two triangles overlap depends on their corners alone, and whether those of
/// two blocks do depends on the corners of their triangles. So the pairs of two blocks in which no
/// corner moved are those of the last frame, and only blocks in which one moved are looked at. The
/// order of triangles is kept too: any order is right, and one that was good remains so for a
/// while.
struct PairMemory {
  MovedCorners moved;
  std::optional<std::uint64_t> frame;  // that was planned and found, and blocks decided all of it
  double clearance = 0;
  bool neighbours = true;
  std::vector<ObjectPair> ignored;
  std::vector<TrianglePair> pairs;  // that the blocks of the last frame gave
  bool oriented = false;  // by oriented boxes, so they are of use only while nothing moves
  /// Counts of that frame: of BlockMeetings and PairRegions.
  std::uint64_t overlaps = 0, meetings = 0, triangles = 0, object_pairs = 0, self = 0;

  /// Blocks of the last frame, with all triangles of scattered objects in order; null: not made
  /// yet, and what follows is empty. Its plan has it too, until it is destroyed.
  std::shared_ptr<TriangleBlocks> blocks;
  std::optional<BlockTrees> trees;      // of all objects
  std::vector<std::uint32_t> block_of;  // per triangle
  BlockPairs overlapping;               // all of the last frame
  std::size_t usual = 0;                // their number when the blocks were made
};

/// split_meetings() for the frame that comes after the one in `memory`. Preconditions: memory.moved
/// says what moved since memory.frame; its clearance, neighbours and ignored objects are those of
/// now; and if anything moved, it was not decided by oriented boxes.
PairParts split_next_frame(const Scene& scene, unsigned threads, bool all, PairMemory& memory);
/// Boxes of blocks decide a meeting if at most so many pairs of them overlap for each block that
/// overlaps any.
constexpr std::size_t kPairsPerBlock = 32;
/// But views decide the whole scene if, in a sample, the boxes of more pairs of triangles overlap
/// than this for each triangle, neighbours apart: a view then removes many of these pairs.
constexpr std::size_t kOverlapsPerTriangle = 16;
/// If boxes of more pairs of blocks overlap than this for each block, or an object is stretched
/// (core/boxes/triangle_blocks.h), neither blocks nor views decide: PairParts::join.
constexpr std::size_t kMostPairsPerBlock = 1024;

// Boxes before pixels: with a broad phase of triangles FAR draws no triangle whose box meets no box
// of a triangle that it can collide with (docs/reliability.md, "Boxes before pixels").

/// All pairs a < b of triangles whose boxes overlap: of different objects that are not ignored, and
/// of one object that is tested against itself. Sorted, each once. Empty where boxes of blocks do
/// not decide the whole scene, because too many of them overlap or triangles lie too unevenly.
/// neighbours: false leaves out pairs of one object that share a vertex index. threads: 0 for as
/// many as there are cores.
std::optional<std::vector<TrianglePair>> pairs_of_boxes(const Scene& scene,
                                                        std::span<const ObjectPair> ignored,
                                                        bool neighbours, unsigned threads);

/// The regions that drawing needs to decide about these pairs: their triangles, and the places in
/// which boxes of two overlap, one for each object that is the first one of a pair. Every common
/// point of a pair is in one of the places.
Regions regions_of(const Scene& scene, std::span<const TrianglePair> pairs);

}  // namespace farcull
