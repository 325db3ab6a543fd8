// The CULLIDE family of algorithms on a canvas. The same code runs
//   CULLIDE        Govindaraju, Redon, Lin, Manocha, Graphics Hardware 2003: quick = false
//   Quick-CULLIDE  Govindaraju, Lin, Manocha, IEEE VR 2005: quick = true
//   S-CULLIDE      IEEE VR 2005, inside objects: self = true, touching = false, any `quick`
//   FAR            Govindaraju, Lin, Manocha, VRST 2004: Quick-CULLIDE with a fattener, and with
//                  patches as owners inside objects (core/cull/patches.h)
// docs/reliability.md has the proofs ("Passes, views, rounds" and "Quick-CULLIDE").
//
// Each triangle has an owner: its object, itself (with `self`), or the owner given in `owners`.
// Owners have a fixed order. Every triangle has two bits. F: a first pass found the triangle fully
// visible against all earlier owners. L: a second pass found it fully visible against all later
// owners. A triangle with both bits is culled. The papers name four visibility sets. NFV: no bit.
// FFV: only F. SFV: only L. BFV: both bits.
//
// Plain CULLIDE clears the bits before every level of a visit. So a triangle is culled if one view
// finds it fully visible in both passes. Both passes ask and store (struct Pass) every live
// triangle. Quick-CULLIDE keeps the bits across levels, views and rounds. FFV triangles are stored
// only in the first pass and asked only in the second. SFV triangles are asked only in the first
// pass and stored only in the second. Quick-CULLIDE skips a pass if the pass has already run in the
// same view with the same stored set.
//
// Proved (docs/reliability.md) and tested: after every common step of the schedule, the bits of
// Quick-CULLIDE contain the bits of plain CULLIDE, and Quick-CULLIDE has used at most as many
// queries and draws. So when plain CULLIDE reaches its fixed point, Quick-CULLIDE keeps no
// additional triangles. Quick-CULLIDE may then continue, because it combines bits of different
// views. More rounds may cull more triangles, and the total work may exceed that of plain CULLIDE
// (tests/core/cull/cull_quick_test.cpp, docs/model.md).
//
// With a fattener that has the guarantee, F(t) means that triangle t meets no triangle of an
// earlier owner, and L(t) that t meets no triangle of a later owner (theorem 2). This holds for any
// view and resolution. So a run may start from the bits of another run with the same scene, plan
// and owners. With raw triangles, bits may be wrong.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/stage.h"
#include "core/canvas/canvas.h"
#include "core/canvas/fatten.h"
#include "core/cull/clusters.h"
#include "core/cull/pass.h"
#include "core/scene/scene.h"
#include "core/view/budget.h"
#include "core/view/regions.h"
#include "core/view/view.h"

namespace farcull {

/// The radius of the ball that fattens triangles: the radius of the FAR paper (published), or
/// `factor` times the radius of each view's error budget. factor >= 1 gives the guarantee.
struct RadiusRule {
  bool published = false;
  double factor = 1;
};

/// The state of a run after a pass that ran, or was skipped because its stored set is unchanged.
struct CullStep {
  std::uint32_t level;  // as in Stage
  std::string view;
  int round;
  bool first_pass;
  const std::vector<std::uint8_t>& bits;  // per triangle of the scene
  std::uint64_t draws = 0, queries = 0;   // totals since the run began
  std::uint64_t draws_saved = 0, queries_saved = 0;
};

/// How many views must find a triangle fully visible to cull it. any: one view (CULLIDE). all:
/// every view of a round; each view starts with the triangles that were live before the round. With
/// `all`, a round culls nothing if there is no view or if some view cannot be drawn.
enum class ClearRule { any, all };

struct CullSettings {
  std::vector<View> views;
  int resolution = 0;  // px along the larger side of each view's window
  Fattener fattener;
  RadiusRule radius;
  bool quick = true;  // Quick-CULLIDE; false: plain CULLIDE
  /// True: every triangle of an object with Object::self is its own owner. The regions must then
  /// come from find_regions(scene, {.self = true}).
  bool self = false;
  /// The owner of each triangle of the scene, for example its patch (core/cull/patches.h). If
  /// empty, `self` determines the owners. All triangles of an owner must belong to one object. If
  /// not empty, there is no object level.
  std::vector<std::uint32_t> owners = {};
  bool touching = true;  // the value of Pass::touching
  Clusters clusters = {};
  ClearRule clear = ClearRule::any;
  int rounds = 0;  // at most this many rounds; 0: until a round changes nothing
  /// True: every round runs only the object level. Precondition: the owners are objects.
  bool objects_alone = false;
  bool full = false;         // true: no step is skipped
  std::uint32_t enough = 0;  // stop after a view that leaves at most this many triangles; 0: never
  bool object_level = true;  // false: no object level, unless `objects_alone` is set
  /// If w = worth_a_view is above 0, stops after a view (with ClearRule::all, after a round) that
  /// culled less than 1/w of the live triangles.
  std::uint32_t worth_a_view = 0;
  /// The bits at the start, in the form of CullResult::bits. Empty: no bit is set. Plain CULLIDE
  /// only uses them to remove triangles that are already culled.
  std::vector<std::uint8_t> bits = {};
  std::function<void(const CullStep&)> watch = {};
};

/// Describes a view after a run.
struct ViewReport {
  std::string name;
  bool drawn = false;     // false: the view was skipped; CullResult::stages gives the reason
  int width = 0;          // px
  int height = 0;         // px
  double pixel_size = 0;  // world units
  Budget budget;
  double radius_px = 0;  // radius of the ball that fattens triangles; 0 for raw triangles
  double depth_step_px = 0;
};

struct CullResult {
  std::vector<std::uint32_t> live;  // the triangles that may collide, ascending
  /// Per triangle of the scene. 0: no bit; 1: F; 2: L; 3: culled, or not in regions.triangles.
  std::vector<std::uint8_t> bits;
  std::vector<ViewReport> views;
  std::vector<Stage> stages;
};

/// Culls the triangles of regions.triangles. A round visits every view. A visit runs the object
/// level (round 1 only, if objects are owners), the cluster levels (round 1 only) and the triangle
/// level. With `objects_alone`, every visit runs only the object level. A level runs the first pass
/// and then the second pass. The run ends after `rounds` rounds, or after a round that sets no bit
/// (quick) or culls nothing (plain). With ClearRule::all, a bit is set if each visit of the round
/// set the bit. Unless `full` is set, these steps are skipped and listed as stages with a reason:
/// - passes and visits whose stored set is unchanged (quick)
/// - levels and visits if no triangle is left
/// - all steps after a view that leaves at most `enough` triangles
/// - all steps after a view that culled too few triangles (`worth_a_view`)
/// Throws Error if the resolution is beyond the canvas's limit, or if a pass may not have run on
/// the device. Throws std::logic_error if the length of settings.bits or settings.owners differs
/// from the number of triangles, or if `objects_alone` is set and objects are not the owners.
CullResult cull(const Scene& scene, const Regions& regions, const CullSettings& settings,
                Canvas& canvas, const Progress& progress = {});

/// Like cull(), but with the given rule. Tests pass wrong rules to check that errors are detected.
CullResult cull_by(const PassRule& rule, const Scene& scene, const Regions& regions,
                   const CullSettings& settings, Canvas& canvas, const Progress& progress = {});

/// Returns the stages that cull() will run, in order. Draws nothing. If pixels decide whether a
/// stage runs, sets Stage::depends, and the reason names the rule. One stage represents all rounds
/// after the first. Ignores settings.bits.
std::vector<Stage> planned_stages(const Scene& scene, const Regions& regions,
                                  const CullSettings& settings);

}  // namespace farcull
