// The plan of a run holds all decisions that do not depend on drawn pixels. `farcull plan` prints
// the plan, and find() executes the plan.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/search.h"
#include "core/cull/cull.h"
#include "core/cull/patches.h"
#include "core/view/regions.h"
#include "experiments/method/options.h"

namespace farcull {

/// The plan of a method that draws.
struct DrawPlan {
  Regions regions;
  std::vector<Fattener> fatteners;  // in the order of use; empty: nothing is drawn
  CullSettings settings;            // without a fattener; cull_by_offsets() sets each one
  bool self = false;                // true: tests triangles of one object only (S-CULLIDE)
  Patches patches;                  // far divides objects into patches to test self-collision
  /// All pairs of triangles whose boxes overlap. Empty if only boxes of objects were compared. If
  /// there are pairs to draw, patches.owner has the patch or object of each triangle.
  std::optional<PairsToDraw> pairs = {};
};

struct Plan {
  RunOptions options;
  std::variant<std::monostate, DrawPlan, BoxesPlan> work;
  std::vector<Stage> trace;                // stages of planning, which have run
  std::vector<Stage> ahead;                // stages that follow, in order
  double ms = 0;                           // time of planning
  FrameMemory* memory = nullptr;           // results of the last frame; only for the method `boxes`
  const BlockDecision* decided = nullptr;  // argument of plan_boxes(); used only in planning

  /// Returns the stages of `trace`, then the stages of `ahead`.
  std::vector<Stage> stages() const;
};

/// Plans the run. Opens no device. The same scene and options give the same plan. threads: CPU
/// threads; 0: as many as there are cores. memory, decided: arguments of plan_boxes(). Throws Error
/// as validate() and require_scene() do.
Plan plan(const Scene& scene, const RunOptions& options, unsigned threads = 0,
          const Progress& progress = {}, FrameMemory* memory = nullptr,
          const BlockDecision* decided = nullptr);

/// Throws Error if an object must be tested against itself and the method cannot do this. Throws
/// Error if no object must be tested against itself and the method tests only single objects.
void require_scene(const Scene& scene, Method method);

}  // namespace farcull
