// What FAR pairs will do with a scene: what boxes of runs decide, and which views decide the rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/stage.h"
#include "core/pairs/regions.h"
#include "core/pairs/view.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

/// A view is given up where it takes more work than kTestsPerTriangle for each triangle that takes
/// part, and kTestsPerPair for each pair of boxes that overlap, by an estimate. (Views that are
/// worth while take less than a quarter of that: docs/reliability.md, "Bounded work".)
constexpr double kTestsPerTriangle = 1024, kTestsPerPair = 64;
/// A further view is looked at where there are more candidates than this for each triangle that
/// takes part: fewer are mostly neighbours and contacts, which no view takes away.
constexpr std::size_t kFurtherViewFrom = 16;
constexpr std::size_t kMostPairViews = 3;  // chosen by the scene

struct PairSettings {
  std::vector<View> views = {};  // empty: chosen by the scene, by fixed rules
  int resolution = 0;    // px along the larger side of each view's window; 0: chosen by the scene
  double clearance = 0;  // world units, finite, >= 0: pairs at this distance or less count too
  bool full = false;     // leave nothing out: every triangle takes part, three views are looked at
  bool runs = true;      // false: views decide everything
  bool neighbours = true;  // false: pairs of one object that share a vertex index are left out
  /// Objects that are not tested against each other, as in_order() gives them. What culling would
  /// spend on them is saved; the candidates may still have such pairs.
  std::vector<ObjectPair> ignored = {};
};

/// Everything about a scene that needs no pixels: who takes part, and which views are looked at.
struct PairPlan {
  PairSettings settings;
  RunMeetings runs;                 // decided without a view
  PairRegions regions;              // of all others
  std::vector<PairChoice> choices;  // in the order in which they are looked at; empty: boxes decide
  /// Of boxes of all triangles, where they decide from the beginning: why (PairParts::join), and
  /// the number that it speaks of. Else none.
  Reason join = Reason::none;
  std::uint64_t join_n = 0;
  std::uint64_t most_tests = UINT64_MAX;  // of a view: PairTask::most_tests
  /// Of the first choices, those that are looked at whatever the candidates; empty: unresolvable.
  std::vector<std::optional<PairWindow>> windows;
  std::vector<Stage> trace;  // of the planning itself
  unsigned threads = 0;      // of the CPU, as given
  bool remembers = false;    // find_pairs() keeps what it finds in its workspace's memory
  bool nothing_can_meet() const { return runs.empty() && regions.triangles.empty(); }
};

/// Finds the triangles that take part and chooses the views. threads: of the CPU; 0: as many as
/// there are cores. memory: of the scene's last frame, planned and found with the same one; null:
/// nothing is kept. Which triangles views decide about may depend on it, and no colliding pair
/// does. Throws Error for a scene that is too large, std::logic_error for a clearance that is
/// negative or not finite.
PairPlan plan_pairs(const Scene& scene, const PairSettings& settings, unsigned threads = 0,
                    PairMemory* memory = nullptr);

/// The stages that find_pairs() will go through, in order. Those that candidates decide about are
/// marked so, with the rule.
std::vector<Stage> planned_stages(const PairPlan& plan);

/// Whether one of the two is in the list.
bool has_any(const std::vector<std::uint32_t>& ascending, const TrianglePair& pair);
/// Which part of some pairs, evenly chosen of `from`, a view would keep. For choices alone: no pair
/// is lost either way. Precondition: there is a pair.
double kept_by(const Scene& scene, const PairRegions& regions, const PairChoice& choice,
               double clearance, const std::vector<TrianglePair>& from);
/// The window of a choice; empty where pixel space cannot resolve it.
std::optional<PairWindow> window_of(const PairPlan& plan, const PairChoice& choice);
/// The stage of the boxes of all triangles, for a reason.
Stage stage_of_join(Reason reason, std::uint64_t n = 0, const std::string& detail = "");
/// The stage of the boxes of runs, before it ran. Precondition: plan.runs is not empty.
Stage stage_of_runs(const PairPlan& plan);
/// The number of views that are looked at whatever the candidates, where they can be resolved.
std::size_t certain_views(const PairPlan& plan);

}  // namespace farcull
