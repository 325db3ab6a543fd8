// FAR pairs: every pair of triangles whose boxes overlap, where boxes of runs decide; elsewhere
// every pair whose boxes overlap and whose depth intervals overlap in a pixel of every view that
// was looked along. A pair that intersects is among them (docs/reliability.md, "Interval pairs" and
// "Boxes of runs"): between objects, and inside those that collide with themselves. The method
// decides nothing exactly; that is verify's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/stage.h"
#include "core/pairs/backend.h"
#include "core/pairs/plan.h"
#include "core/scene/scene.h"

namespace farcull {

/// One view, looked at or not.
struct PairView {
  std::string name;
  bool looked = false;      // false: unresolvable, see the stages
  std::string reason = {};  // why this direction and this resolution
  int width = 0;            // px
  int height = 0;           // px
  double pixel_size = 0;    // world units
  double widening_px = 0;   // of footprints and intervals beyond their own float error
  PairCounts counts = {};
};

struct PairResult {
  std::vector<TrianglePair> candidates;  // sorted, each once; the closed boxes, grown by half
                                         // the clearance, overlap
  std::vector<PairView> views;
  std::vector<Stage> stages;
};

/// Buffers that calls use again, and, where plan_pairs() was given it too, what one frame of a
/// scene tells about the next one.
struct PairWorkspace {
  PairScene seen;
  PairMemory memory;
};

/// Finds the candidate pairs of the scene that was planned: of different objects, and of one object
/// where it is marked `self`. The result does not depend on threads, memory limits or earlier
/// calls; a backend keeps its buffers between calls, and so does `workspace`, whose contents are
/// replaced. A plan that was made with workspace.memory must be found with it, and before the next
/// one is made. Throws Error where the backend cannot vouch for its answer.
PairResult find_pairs(const Scene& scene, const PairPlan& plan, PairBackend& backend,
                      PairWorkspace& workspace, const Progress& progress = {});

/// Both in one call, with a workspace of its own; the stages are those of planning and finding.
PairResult find_pairs(const Scene& scene, const PairSettings& settings, PairBackend& backend);

}  // namespace farcull
