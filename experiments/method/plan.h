// The plan of a run: all decisions that need no pixels. `farcull plan` prints a plan, find()
// executes it.
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
  std::vector<Fattener> fatteners;  // in the order in which they are tried; empty: nothing is drawn
  CullSettings settings;            // without the fattener
  bool self = false;                // each triangle of a marked object is its own owner
  Patches patches;                  // for far, if an object is tested against itself; else empty
  /// All pairs of triangles whose boxes overlap; if any of them is drawn, patches.owner is set.
  /// Empty: only boxes of objects are compared before drawing.
  std::optional<PairsToDraw> pairs = {};
};

struct Plan {
  RunOptions options;
  std::variant<std::monostate, DrawPlan, BoxesPlan> work;
  std::vector<Stage> trace;  // the stages of planning itself: they have run
  std::vector<Stage> ahead;  // the stages to come, in order; those that pixels decide are marked
  double ms = 0;             // time of planning
  FrameMemory* memory = nullptr;           // of the scene's last frame, for boxes
  const BlockDecision* decided = nullptr;  // as plan_boxes(); used only while planning

  /// The stages of `trace`, then those of `ahead`.
  std::vector<Stage> stages() const;
};

/// Plans the run. The same scene and options give the same plan. No device is opened. threads: of
/// the CPU; 0: as many as there are cores. memory, decided: as plan_boxes(). Throws Error for
/// options that are out of range or contradict each other, and for a scene that the method cannot
/// use.
Plan plan(const Scene& scene, const RunOptions& options, unsigned threads = 0,
          const Progress& progress = {}, FrameMemory* memory = nullptr,
          const BlockDecision* decided = nullptr);

/// Throws Error if an object is tested against itself and the method cannot do that, or if no
/// object is and the method does only that.
void require_scene(const Scene& scene, Method method);

}  // namespace farcull
