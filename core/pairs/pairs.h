// FAR pairs: every pair of triangles whose boxes overlap, if boxes of blocks decide about its
// objects; else every pair whose boxes overlap and whose depth intervals overlap in a pixel of
// every view that was looked along. A pair that intersects is among them (docs/reliability.md,
// "Interval pairs" and "Boxes of runs"): between objects, and inside those that collide with
// themselves. The method decides nothing exactly; verify/ does.
//
// A plan says what boxes of blocks decide, and which views decide the rest. The rules by which
// directions and resolutions are chosen are fixed: the same scene and settings give the same plan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/stage.h"
#include "core/pairs/backend.h"
#include "core/pairs/regions.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

/// A direction and a resolution, and why.
struct PairChoice {
  View view;
  int resolution = 0;  // px
  std::string reason;
};
/// Directions of the scene (the axes, and the principal directions of its edges), the best first.
/// `resolution`: 0 to choose it. Preconditions: regions.triangles is not empty.
std::vector<PairChoice> choose_pair_views(const Scene& scene, const PairRegions& regions,
                                          int resolution);
/// The resolution that the scene's triangles ask for in a given view.
int choose_pair_resolution(const Scene& scene, const PairRegions& regions, const View& view);

/// A window of pixel space, and by how much the triangles grow in it.
struct PairWindow {
  Window window;
  std::array<float, 3> widening;  // px per axis: half the clearance and the error of the map
};
/// The window of a view; empty if pixel space cannot resolve the regions or the clearance in it.
std::optional<PairWindow> pair_window(const PairRegions& regions, const View& view, int resolution,
                                      double clearance);

/// The scene in one view. `task` points into this object, so it must not be copied or moved while
/// the task is used.
struct PairScene {
  Window window;
  std::vector<PixelVertex> vertices;
  std::vector<std::uint32_t> owners;
  std::vector<std::uint8_t> self;
  std::vector<PixelBox> limits;
  std::vector<std::uint32_t> active;
  std::vector<std::uint32_t> undrawable;  // ascending: triangles that this view cannot show
  PairTask task;
};
/// Fills `out` (whose buffers are used again) with `triangles` as the window shows them.
void look(const Scene& scene, const PairRegions& regions, std::span<const std::uint32_t> triangles,
          const PairWindow& window, unsigned threads, PairScene& out);

/// A view is given up if it takes more work than kTestsPerTriangle for each triangle that takes
/// part, and kTestsPerPair for each pair of boxes that overlap, by an estimate: about what these
/// cost the method `exact` (docs/reliability.md, "Bounded work"). Views that the caller asks for
/// may take kOfAskedViews times as much.
constexpr double kTestsPerTriangle = 64, kTestsPerPair = 4, kOfAskedViews = 16;
/// A further view is looked at if there are more candidates than this for each triangle that
/// takes part: fewer are mostly neighbours and contacts, which no view takes away.
constexpr std::size_t kFurtherViewFrom = 16;
constexpr std::size_t kMostPairViews = 3;  // chosen by the scene

struct PairSettings {
  std::vector<View> views = {};  // empty: chosen by the scene, by fixed rules
  int resolution = 0;    // px along the larger side of each view's window; 0: chosen by the scene
  double clearance = 0;  // world units, finite, >= 0: pairs at this distance or less count too
  bool full = false;     // leave nothing out: every triangle takes part, three views are looked at
  bool blocks = true;    // false: views decide everything
  bool neighbours = true;  // false: pairs of one object that share a vertex index are left out
  bool lists = false;      // pairs of blocks are listed even where find_pairs() has a `take`
  /// Objects that are not tested against each other, as in_order() gives them. Culling spends no
  /// work on them; the candidates may still have such pairs.
  std::vector<ObjectPair> ignored = {};
};

/// Everything about a scene that needs no pixels: which triangles take part, and which views.
struct PairPlan {
  PairSettings settings;
  BlockMeetings blocks;             // decided without a view
  PairRegions regions;              // of all others
  std::vector<PairChoice> choices;  // in the order in which they are looked at; empty: boxes decide
  /// If boxes of all triangles decide from the beginning: why (PairParts::join), and the number
  /// that the reason speaks of; else Reason::none.
  Reason join = Reason::none;
  std::uint64_t join_n = 0;
  std::uint64_t most_tests = UINT64_MAX;  // of a view: PairTask::most_tests
  /// Windows of the first choices, which are looked at whatever the candidates; empty:
  /// unresolvable.
  std::vector<std::optional<PairWindow>> windows;
  std::vector<Stage> trace;  // of the planning itself
  unsigned threads = 0;      // of the CPU, as given
  bool remembers = false;    // find_pairs() keeps what it finds in its workspace's memory
  bool nothing_can_meet() const { return blocks.empty() && regions.triangles.empty(); }
};

/// Finds the triangles that take part and chooses the views. threads: of the CPU; 0: as many as
/// there are cores. memory: keeps the scene's last frame, if that was planned and found with the
/// same object; null: nothing is kept. Precondition: memory->moved.update(scene) began this frame.
/// The memory may change which triangles are left to views, but loses no colliding pair. Throws
/// Error for a scene that is too large, std::logic_error for a clearance that is negative or not
/// finite.
PairPlan plan_pairs(const Scene& scene, const PairSettings& settings, unsigned threads = 0,
                    PairMemory* memory = nullptr);

/// The stages that find_pairs() will go through, in order. Stages that depend on the candidates are
/// marked so, with the rule.
std::vector<Stage> planned_stages(const PairPlan& plan);

/// Whether a triangle of the pair is in the list.
bool has_any(std::span<const std::uint32_t> ascending, const TrianglePair& pair);
/// The fraction of pairs that a view would keep, from an even sample of `from`. For choices alone:
/// no pair is lost either way. Precondition: there is a pair.
double kept_by(const Scene& scene, const PairRegions& regions, const PairChoice& choice,
               double clearance, const std::vector<TrianglePair>& from);
/// The window of a choice; empty if pixel space cannot resolve it.
std::optional<PairWindow> window_of(const PairPlan& plan, const PairChoice& choice);
/// The stage of the boxes of all triangles, for a reason.
Stage stage_of_join(Reason reason, std::uint64_t n = 0, const std::string& detail = "");
/// The stage of the boxes of blocks, before it ran. Precondition: plan.blocks is not empty.
Stage stage_of_blocks(const PairPlan& plan);
/// The number of views that are looked at whatever the candidates, if they can be resolved.
std::size_t certain_views(const PairPlan& plan);

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
  bool given = false;                    // all candidates went to `take` instead, as found
  std::uint64_t count = 0;               // of candidates
  std::vector<PairView> views;
  std::vector<Stage> stages;
};

/// Buffers that calls use again; and the memory of one frame of a scene for the next one, if
/// plan_pairs() is given that memory.
struct PairWorkspace {
  PairScene seen;
  PairMemory memory;
};

/// Finds the candidate pairs of the scene that was planned: of different objects, and of one object
/// if it is marked `self`. The result does not depend on threads, memory limits or earlier
/// calls; a backend keeps its buffers between calls, and so does `workspace`, whose contents are
/// replaced. A plan that was made with workspace.memory must be given here with that workspace,
/// before the next plan is made. take: receives the candidates as they are found, so that they are
/// never listed, if a tree of all boxes decides, or if blocks decide the whole scene and neither
/// settings.lists nor plan.remembers; empty: they are listed. Throws Error if the backend cannot
/// vouch for its answer.
PairResult find_pairs(const Scene& scene, const PairPlan& plan, PairBackend& backend,
                      PairWorkspace& workspace, const Progress& progress = {},
                      const TakePairs& take = {});

/// plan_pairs() and find_pairs() in one call, with a new workspace; the stages are those of both.
PairResult find_pairs(const Scene& scene, const PairSettings& settings, PairBackend& backend);

}  // namespace farcull
