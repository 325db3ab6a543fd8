// FAR pairs: every pair of triangles whose depth intervals overlap in a pixel, per view. A pair
// that intersects is among them (docs/reliability.md, "Interval pairs"): between objects, and
// inside those that collide with themselves. The method decides nothing exactly; that is verify's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/stage.h"
#include "core/pairs/backend.h"
#include "core/pairs/view.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

/// A further view is looked at where there are more candidates than this for each triangle that
/// takes part: fewer are mostly neighbours and contacts, which no view takes away.
constexpr std::size_t kFurtherViewFrom = 16;
constexpr std::size_t kMostPairViews = 3;  // chosen by the scene

struct PairSettings {
  std::vector<View> views = {};  // empty: chosen by the scene, by fixed rules
  int resolution = 0;    // px along the larger side of each view's window; 0: chosen by the scene
  double clearance = 0;  // world units, finite, >= 0: pairs at this distance or less count too
  bool full = false;     // leave nothing out: every triangle takes part, three views are looked at
  bool neighbours = true;  // false: nobody asks for pairs of one object that share a vertex
                           // index; views leave them out
};

/// Everything about a scene that needs no pixels: who takes part, and which views are looked at.
struct PairPlan {
  PairSettings settings;
  PairRegions regions;
  std::vector<PairChoice> choices;  // in the order in which they are looked at; empty: boxes decide
  /// Of the first choices, those that are looked at whatever the candidates; empty: unresolvable.
  std::vector<std::optional<PairWindow>> windows;
  std::vector<Stage> trace;  // of the planning itself
};

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
  std::vector<TrianglePair> candidates;  // sorted, each once; the closed boxes overlap (grown by
                                         // the clearance)
  std::vector<PairView> views;
  std::vector<Stage> stages;
};

/// Finds the triangles that take part and chooses the views. threads: of the CPU; 0: as many as
/// there are cores. Throws Error for a scene that is too large, std::logic_error for a clearance
/// that is negative or not finite.
PairPlan plan_pairs(const Scene& scene, const PairSettings& settings, unsigned threads = 0);

/// The stages that find_pairs() will go through, in order. Those that candidates decide about are
/// marked so, with the rule.
std::vector<Stage> planned_stages(const PairPlan& plan);

/// Finds the candidate pairs of the scene that was planned: of different objects, and of one object
/// where it is marked `self`. The result does not depend on threads, memory limits or earlier
/// calls; a backend keeps its buffers between calls, and so does `workspace`, whose contents are
/// replaced. Throws Error where the backend cannot vouch for its answer.
PairResult find_pairs(const Scene& scene, const PairPlan& plan, PairBackend& backend,
                      PairScene& workspace, const Progress& progress = {});

/// Both in one call, with a workspace of its own; the stages are those of planning and finding.
PairResult find_pairs(const Scene& scene, const PairSettings& settings, PairBackend& backend);

}  // namespace farcull
