// The panel of --view-depth: the depth that a method stores in one of its views.
#pragma once

#include "experiments/measure/lab.h"
#include "experiments/picture/arguments.h"
#include "experiments/picture/panel.h"

namespace farcull {

/// The panel of arguments.depth_view: run, depths and picture. Throws Error where the method draws
/// no depth, or nothing is drawn in the view.
DrawnPanel depth_panel(const RunOptions& options, const PictureArguments& arguments,
                       const Scene& scene, const Truth& truth, Session& session,
                       const GlContext& context);

}  // namespace farcull
