// The plan of a run holds all decisions that do not depend on drawn pixels. `farcull plan` prints
// the plan. find() executes the plan.
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
  std::vector<Fattener> fatteners;  // offsets in the order of use; empty: nothing is drawn
  CullSettings settings;            // settings without a fattener
  bool self = false;                // the method tests only triangles of one object (S-CULLIDE)
  Patches patches;                  // patches of objects that far tests against themselves
  /// All pairs of triangles whose boxes overlap; empty if only boxes of objects were compared. If
  /// there are pairs to draw, patches.owner is set.
  std::optional<PairsToDraw> pairs = {};
};

struct Plan {
  RunOptions options;
  std::variant<std::monostate, DrawPlan, BoxesPlan> work;
  std::vector<Stage> trace;                // the stages of planning, which have run
  std::vector<Stage> ahead;                // the stages that follow, in order
  double ms = 0;                           // time of planning
  FrameMemory* memory = nullptr;           // only for the method `boxes`: the scene's last frame
  const BlockDecision* decided = nullptr;  // argument of plan_boxes(); used only while planning

  /// Returns the stages of `trace`, then the stages of `ahead`.
  std::vector<Stage> stages() const;
};

/// Plans the run. Opens no device. The same scene and options give the same plan. threads: CPU
/// threads; 0: as many as there are cores. memory, decided: arguments of plan_boxes(). Throws Error
/// as validate() and require_scene() do.
Plan plan(const Scene& scene, const RunOptions& options, unsigned threads = 0,
          const Progress& progress = {}, FrameMemory* memory = nullptr,
          const BlockDecision* decided = nullptr);

/// Throws Error if an object must be tested against itself and the method cannot do that. Throws
/// Error if no object must be tested against itself and the method tests only such objects.
void require_scene(const Scene& scene, Method method);

}  // namespace farcull
