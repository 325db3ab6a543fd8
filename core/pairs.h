// FAR pairs: every pair of triangles whose depth intervals overlap in a pixel, per view. A pair
// that intersects is among them (docs/reliability.md, "Interval pairs"): between objects, and
// inside those that collide with themselves. The method decides nothing exactly; that is verify's.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/pair_backend.h"
#include "core/plan.h"
#include "core/scene.h"
#include "core/view.h"

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

/// What was looked at in one view.
struct PairView {
  std::string name;
  bool looked = false;      // false: left out or unresolvable, see the stages
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

/// Finds the candidate pairs of the scene: of different objects, and of one object where it is
/// marked `self`. The result does not depend on threads, memory limits or earlier calls; a backend
/// keeps its buffers between calls. Throws Error where the backend cannot vouch for its answer.
PairResult find_pairs(const Scene& scene, const PairSettings& settings, PairBackend& backend,
                      const std::function<void(const std::string&)>& progress = {});

}  // namespace farcull
