// What FAR pairs keep of a scene for its next frame, so that what did not move costs little.
//
// Whether the boxes of two triangles overlap depends on their corners alone. So of two runs in
// which no corner moved the pairs of the last frame are those of this one, and only pairs of runs
// of which one moved are compared. The order of scattered triangles is kept too: any order is
// right, and one that was good remains so for a while.
#pragma once

#include <memory>
#include <vector>

#include "core/pairs/runs.h"
#include "core/scene/moved.h"
#include "core/scene/scene.h"

namespace farcull {

/// Between plan_pairs() and find_pairs() of one frame and those of the next. A frame that does not
/// come to its end leaves nothing behind for the next one.
struct PairMemory {
  MovedCorners moved;
  Patience patience;
  double clearance = 0;
  bool neighbours = true;
  std::vector<ObjectPair> ignored;
  bool complete = false;  // the frame was planned and found, and runs decided all of it
  /// Of the last frame, with all triangles of scattered objects in order; null: not made yet. Its
  /// plan has it too, until it is destroyed.
  std::shared_ptr<Runs> runs;
  std::vector<TrianglePair> pairs;  // that the runs of the last frame gave
  /// Counts of that frame: of RunMeetings and PairRegions.
  std::uint64_t overlaps = 0, meetings = 0, triangles = 0, object_pairs = 0, self = 0;
};

}  // namespace farcull
