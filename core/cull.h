// CULLIDE's two passes on a canvas, at object and at triangle level (Govindaraju, Redon, Lin,
// Manocha 2003); with fattened primitives it is FAR (Govindaraju, Lin, Manocha 2004), with
// `economy` it stores only what is not yet cleared (Quick-CULLIDE, 2005). docs/reliability.md holds
// the argument.
//
// Every triangle has two bits. F: cleared against all earlier objects, in the order of the scene;
// L: against all later ones. A triangle with both is culled. Bits survive views and rounds: the two
// sides may be cleared by different views.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/budget.h"
#include "core/canvas.h"
#include "core/fatten.h"
#include "core/plan.h"
#include "core/scene.h"
#include "core/view.h"

namespace farcull {

/// The radius of the ball, as the budget of each view times a factor (1 or more keeps the promise),
/// or as published.
struct RadiusRule {
  bool published = false;
  double factor = 1;
};

struct CullSettings {
  std::vector<View> views;
  int resolution = 0;  // px along the larger side of each view's window
  Fattener fattener;
  RadiusRule radius;
  bool economy = true;  // store only items whose own bit is open; false: store every live item
};

/// What was drawn in one view.
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
  std::vector<ViewReport> views;
  std::vector<Stage> stages;
};

/// Called before each stage with its name; may be empty.
using Progress = std::function<void(const std::string&)>;

/// Culls the triangles of plan.triangles in every view, round after round, until a round clears
/// nothing. Throws Error where the resolution is beyond the canvas's limit or the canvas cannot
/// vouch for a pass.
CullResult cull(const Scene& scene, const Plan& plan, const CullSettings& settings, Canvas& canvas,
                const Progress& progress = {});

}  // namespace farcull
