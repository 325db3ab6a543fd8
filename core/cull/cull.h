// The CULLIDE family on a canvas. One schedule of views, levels and passes serves
//   CULLIDE        Govindaraju, Redon, Lin, Manocha, Graphics Hardware 2003: quick = false
//   Quick-CULLIDE  Govindaraju, Lin, Manocha, IEEE VR 2005: quick = true
//   S-CULLIDE      the same paper, inside objects: self = true, touching = false, any `quick`
//   FAR            Govindaraju, Lin, Manocha, VRST 2004: Quick-CULLIDE with a fattener. Patches are
//                  owners inside objects (core/cull/patches.h)
// docs/reliability.md holds the argument ("Passes, views, rounds" and "Quick-CULLIDE").
//
// Each triangle has an owner: its object, itself (with `self`), or the one in `owners`. Owners have
// a fixed order. Every triangle has two bits. F: it is cleared against all earlier owners. L: it is
// cleared against all later owners. A triangle with both bits is culled. The values of the bits are
// the four visibility sets: NFV no bit; FFV F only (fully visible in the first pass); SFV L only
// (fully visible in the second pass); BFV both bits.
//
// Plain CULLIDE begins every level of a visit without bits: a triangle is culled if one view finds
// it fully visible in both passes. Both passes ask and store (struct Pass) every live triangle.
// Quick-CULLIDE keeps the bits across levels, views and rounds. It stores FFV triangles only in the
// first pass and asks them only in the second. It asks SFV triangles only in the first pass and
// stores them only in the second. It leaves out a pass whose stored set has not changed since the
// pass last ran in that view.
//
// Proved (docs/reliability.md) and tested: after every common step of the schedule, the bits of
// Quick-CULLIDE contain those of plain CULLIDE, and Quick-CULLIDE has drawn and asked no more. So
// when plain CULLIDE reaches its fixed point, Quick-CULLIDE keeps no more triangles and has used no
// more queries and draws. Quick-CULLIDE may then continue, because it joins bits of different
// views. In that case it may cull more, and its total work may exceed that of plain CULLIDE
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

/// The radius of the ball that fattens triangles: the published radius, or each view's budget
/// radius times a factor. A factor of at least 1 gives the guarantee.
struct RadiusRule {
  bool published = false;
  double factor = 1;
};

/// The state of a run after a pass that had at least one triangle to decide.
struct CullStep {
  std::uint32_t level;  // as in Stage
  std::string view;
  int round;
  bool first_pass;
  const std::vector<std::uint8_t>& bits;  // per triangle of the scene
  std::uint64_t draws = 0, queries = 0;   // totals since the run began
  std::uint64_t draws_saved = 0, queries_saved = 0;
};

/// How many views must find a triangle fully visible before it is culled. any: one view (CULLIDE).
/// all: every view of a round; each view begins with the triangles that were live before the round.
/// With `all`, nothing is culled if a view cannot be drawn or if there are no views.
enum class ClearRule { any, all };

struct CullSettings {
  std::vector<View> views;
  int resolution = 0;  // px along the larger side of each view's window
  Fattener fattener;
  RadiusRule radius;
  bool quick = true;  // Quick-CULLIDE; false: plain CULLIDE
  /// Every triangle of an object with Object::self is its own owner. Requires regions of
  /// find_regions(scene, {.self = true}).
  bool self = false;
  /// The owner of each triangle of the scene, for example its patch (core/cull/patches.h). If
  /// empty, `self` determines the owners. All triangles of an owner are of one object. With owners
  /// given here, there is no object level.
  std::vector<std::uint32_t> owners = {};
  bool touching = true;  // Pass::touching; false: triangles that only touch are not seen
  Clusters clusters = {};
  ClearRule clear = ClearRule::any;
  int rounds = 0;  // at most this many rounds; 0: until a round changes nothing
  /// Every round runs only the object level. Precondition: the owners are objects.
  bool objects_alone = false;
  bool full = false;         // nothing is left out
  std::uint32_t enough = 0;  // no further view if at most this many triangles are live; 0: no limit
  bool object_level = true;  // false: no object level, unless `objects_alone` is set
  /// For a value w > 0, a view follows only if the last view (with ClearRule::all, a round only if
  /// the last round) culled at least 1/w of the live triangles. 0: no such rule.
  std::uint32_t worth_a_view = 0;
  /// Bits at the start, per triangle of the scene, as CullResult::bits; empty: no bits. Plain
  /// CULLIDE uses them only to know which triangles are culled.
  std::vector<std::uint8_t> bits = {};
  std::function<void(const CullStep&)> watch = {};
};

/// What is known about a view after a run.
struct ViewReport {
  std::string name;
  bool drawn = false;     // false: left out or unresolvable; see CullResult::stages
  int width = 0;          // px
  int height = 0;         // px
  double pixel_size = 0;  // world units
  Budget budget;
  double radius_px = 0;  // radius of the ball that fattens triangles; 0 for raw triangles
  double depth_step_px = 0;
};

struct CullResult {
  std::vector<std::uint32_t> live;  // ascending; the triangles that may collide
  /// Per triangle of the scene. 0: no bit; 1: F; 2: L; 3: culled, or not in the regions.
  std::vector<std::uint8_t> bits;
  std::vector<ViewReport> views;
  std::vector<Stage> stages;
};

/// Culls the triangles of regions.triangles. A round visits every view. A visit runs the object
/// level (round 1 only, if objects are owners), the cluster levels (round 1 only) and the triangle
/// level; with `objects_alone` only the object level. A level runs the first pass, then the second.
/// Rounds follow until a round sets no bit (quick) or culls nothing (plain), or until `rounds` have
/// run. With ClearRule::all, a bit is set if each visit of the round set it. Unless `full` is set,
/// some steps are left out, each as a stage with its reason:
/// - passes and visits whose stored set is unchanged (quick)
/// - levels and visits if no triangle is left
/// - all steps after a view that leaves at most `enough` triangles
/// - all steps after a view that culled little (`worth_a_view`). This and leaving out the object
///   level (`object_level`) change which bits are set, but no bit becomes wrong
/// Throws Error if the resolution is beyond the canvas's limit, or if a pass is not known to have
/// run. Throws std::logic_error if the length of settings.bits or settings.owners does not fit the
/// scene, or if `objects_alone` is set and objects are not the owners.
CullResult cull(const Scene& scene, const Regions& regions, const CullSettings& settings,
                Canvas& canvas, const Progress& progress = {});

/// As cull(), with the caller's rule. Tests pass broken rules and check that errors are noticed.
CullResult cull_by(const PassRule& rule, const Scene& scene, const Regions& regions,
                   const CullSettings& settings, Canvas& canvas, const Progress& progress = {});

/// Returns the stages that cull() will go through, in order. Draws nothing. A stage that depends on
/// pixels is marked as such, with the rule that will decide. One stage stands for all rounds after
/// the first. Ignores settings.bits.
std::vector<Stage> planned_stages(const Scene& scene, const Regions& regions,
                                  const CullSettings& settings);

}  // namespace farcull
