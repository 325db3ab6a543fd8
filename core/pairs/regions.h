// Where the objects of a scene can meet, by boxes alone: of objects, and of runs of their
// triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/stage.h"
#include "core/pairs/memory.h"
#include "core/pairs/run_triangles.h"
#include "core/pairs/runs.h"
#include "core/scene/scene.h"

namespace farcull {

/// Where the objects of a scene can meet.
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

/// What boxes say about a scene: pairs of runs for the meetings that are cheapest so, and the
/// regions of all others. Their `pairs` and `self` count all meetings of the scene.
struct PairParts {
  RunMeetings runs;
  PairRegions rest;
  /// Set where neither runs nor views decide, but a tree of all boxes, with the number that it
  /// speaks of: join_uneven, or join_many_runs. `rest` has all triangles then.
  Reason join = Reason::none;
  std::uint64_t join_n = 0;
  std::vector<TrianglePair> sample = {};  // of the others: some pairs whose boxes overlap
};
/// Decides for each meeting (two objects whose boxes overlap, or an object that is tested against
/// itself) whether boxes of runs find its candidates, or views. Runs do where few of their boxes
/// overlap, since no view is as cheap then: see kPairsPerRun and kOverlapsPerTriangle below.
/// all: nothing is left to views, unless the scene is `crowded`. threads: 0 for as many as there
/// are cores. ignored: as pair_regions(); the runs of two such objects are never a pair.
PairParts split_meetings(const Scene& scene, double clearance, unsigned threads = 0,
                         bool all = false, std::span<const ObjectPair> ignored = {});
/// The same for the frame that comes after the one in `memory`. Preconditions: memory.moved says
/// what moved since that frame; it was complete; its clearance, neighbours and ignored objects are
/// those of now.
PairParts split_next_frame(const Scene& scene, unsigned threads, bool all, PairMemory& memory);
/// Boxes of runs decide a meeting if at most so many pairs of them overlap for each run that
/// overlaps any.
constexpr std::size_t kPairsPerRun = 32;
/// But views decide the whole scene if, in a sample, the boxes of more pairs of triangles overlap
/// than this for each triangle, neighbours apart: a view then removes many of these pairs.
constexpr std::size_t kOverlapsPerTriangle = 16;
/// Where boxes of more pairs of runs overlap than this for each run, or an object is stretched
/// (core/pairs/runs.h), neither runs nor views decide: PairParts::join.
constexpr std::size_t kMostPairsPerRun = 1024;

}  // namespace farcull
