// The CULLIDE family on a canvas. One schedule of views, levels and passes serves
//   CULLIDE        Govindaraju, Redon, Lin, Manocha, Graphics Hardware 2003: quick = false
//   Quick-CULLIDE  Govindaraju, Lin, Manocha, IEEE VR 2005: quick = true
//   S-CULLIDE      the same paper, inside objects: self = true, touching = false, with either
//   FAR            Govindaraju, Lin, Manocha, VRST 2004: Quick-CULLIDE with a fattener; inside
//                  objects with patches as owners (core/cull/patches.h)
// docs/reliability.md holds the argument ("Passes, views, rounds" and "Quick-CULLIDE").
//
// Owners (objects; with `self`, single triangles; or `owners`) have a fixed order. Every
// triangle has two bits. F: cleared against all earlier owners; L: against all later ones. A
// triangle with both is culled. The four values of the bits are the four visibility sets:
//   NFV neither; FFV F only (fully visible in the first pass); SFV L only (in the second); BFV
//   both.
//
// Plain CULLIDE begins every level of a visit without bits: a triangle is culled if one view finds
// it fully visible in both passes. It asks and stores every live triangle in both passes.
// Quick-CULLIDE keeps the bits across levels, views and rounds. It asks FFV only in the second pass
// and stores FFV only in the first; SFV the other way round. It leaves out a pass whose stored set
// has not changed since the pass last ran in that view.
//
// Proved (docs/reliability.md) and tested: after every step of the schedule that both share,
// Quick-CULLIDE's bits contain plain CULLIDE's, and it has drawn and asked no more. So when plain
// CULLIDE has reached its fixed point, Quick-CULLIDE keeps no more triangles and has used no more
// queries and draws. It may go on from there, because bits of different views join. Then it may
// cull more, and its total may exceed plain CULLIDE's (tests/core/cull/cull_quick_test.cpp has such
// a scene; docs/model.md has the smallest one, in which it goes on and culls no more).
//
// Bits are facts about the triangles. With a fattener that guarantees this, F(t) means that t meets
// no triangle of an earlier owner, L(t) none of a later one (theorem 2), whatever view, resolution
// or fattener found it. So a run may start from the bits of another with the same scene, plan and
// owners. With raw triangles, bits are only as good as the run that set them.
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

/// The radius of the ball: the budget radius of each view times a factor (at least 1: guaranteed),
/// or the published radius.
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
  std::uint64_t draws = 0, queries = 0;   // since the run began
  std::uint64_t draws_saved = 0, queries_saved = 0;
};

/// How many views must find a triangle fully visible before it is culled. any: one (CULLIDE). all:
/// every view, each with the triangles that were left when the round began. A view that cannot be
/// drawn clears nothing, so nothing is culled then; nor is anything culled without views.
enum class ClearRule { any, all };

struct CullSettings {
  std::vector<View> views;
  int resolution = 0;  // px along the larger side of each view's window
  Fattener fattener;
  RadiusRule radius;
  bool quick = true;  // Quick-CULLIDE; false: plain CULLIDE
  /// Every triangle of an object with Object::self is an owner. Use it with regions of
  /// find_regions(scene, {.self = true}).
  bool self = false;
  /// The owner of each triangle of the scene, if owners are neither objects nor single triangles
  /// (core/cull/patches.h). All triangles of an owner are of one object. There is no object level
  /// then. Empty: `self` says what the owners are.
  std::vector<std::uint32_t> owners = {};
  bool touching = true;  // false: what only touches is not seen, see Pass::touching
  Clusters clusters = {};
  ClearRule clear = ClearRule::any;
  int rounds = 0;  // the most rounds; 0: until a round changes nothing
  /// Objects are asked as a whole in every round, and their triangles are never asked. The owners
  /// must be objects then.
  bool objects_alone = false;
  bool full = false;         // nothing is left out
  std::uint32_t enough = 0;  // no further view if at most this many triangles are live; 0: no limit
  /// Objects are asked as a whole only if at least this many take part; 0: always.
  std::uint32_t least_objects = 0;
  /// A further round follows only if the last round culled at least one live triangle in this many;
  /// 0: if the last round changed anything.
  std::uint32_t worth_a_round = 0;
  /// Bits at the start, per triangle of the scene, as CullResult::bits; empty: none. Plain CULLIDE
  /// uses them only to tell which triangles are culled.
  std::vector<std::uint8_t> bits = {};
  std::function<void(const CullStep&)> watch = {};
};

/// A view that was drawn, or could not be.
struct ViewReport {
  std::string name;
  bool drawn = false;     // false: left out or unresolvable, see the stages
  int width = 0;          // px
  int height = 0;         // px
  double pixel_size = 0;  // world units
  Budget budget;
  double radius_px = 0;  // of the ball that fattened the primitives; 0 for raw triangles
  double depth_step_px = 0;
};

struct CullResult {
  std::vector<std::uint32_t> live;  // ascending; the potentially colliding set at triangle level
  /// Per triangle of the scene. 1: has F; 2: has L; 3: is culled or not in the regions.
  std::vector<std::uint8_t> bits;
  std::vector<ViewReport> views;
  std::vector<Stage> stages;
};

/// Culls the triangles of regions.triangles. A round visits every view. A visit runs the object
/// level (round 1 only, if objects are owners), the cluster levels (round 1 only) and the triangle
/// level; with `objects_alone` only the object level. A level runs the first pass, then the second.
/// Rounds follow until one changes nothing: sets no bit (quick), or culls nothing (plain); or until
/// `rounds` have run. With ClearRule::all, a bit is set if each visit of the round set it. Left
/// out, unless `full`, each as a stage with its reason: passes and visits that are not due (quick),
/// levels and visits if no triangle is left, everything after a view that leaves at most `enough`
/// triangles, the object level of few objects (`least_objects`), and rounds after one that culled
/// little (`worth_a_round`). The last two change which bits are set, but no bit becomes wrong.
/// Throws Error if the resolution is beyond the canvas's limit or the canvas cannot vouch for a
/// pass. Throws std::logic_error if settings.bits or settings.owners has another length than the
/// scene, or for `objects_alone` if objects are not the owners.
CullResult cull(const Scene& scene, const Regions& regions, const CullSettings& settings,
                Canvas& canvas, const Progress& progress = {});

/// cull() with a rule of the caller. Tests give it broken rules, and must notice.
CullResult cull_by(const PassRule& rule, const Scene& scene, const Regions& regions,
                   const CullSettings& settings, Canvas& canvas, const Progress& progress = {});

/// The stages that cull() will go through, in order, before anything is drawn. A stage that depends
/// on pixels is marked so, with the rule that will decide. Rounds after the first are one stage.
/// settings.bits are ignored.
std::vector<Stage> planned_stages(const Scene& scene, const Regions& regions,
                                  const CullSettings& settings);

}  // namespace farcull
