// What a run would do on a scene, and what it would leave out, before anything is drawn or tested:
// `farcull plan`. The rules are those of the run itself (core/plan.h, core/cull.h, core/pairs.h);
// the boxes are computed, no device is opened.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/run_options.h"

namespace farcull {

/// depends: decided on the way, by the rule in the reason.
enum class Decision { runs, left_out, depends };

struct PlannedStep {
  std::string name;
  Decision decision = Decision::runs;
  std::string reason;
};

/// The steps of run_scene(scene, options), in order. Throws Error as it does for bad options and
/// for scenes that the method has no use for.
std::vector<PlannedStep> planned(const Scene& scene, const RunOptions& options);

/// For people, and for programs.
std::string plan_table(const Scene& scene, const RunOptions& options,
                       const std::vector<PlannedStep>& steps);
nlohmann::ordered_json plan_json(const Scene& scene, const RunOptions& options,
                                 const std::vector<PlannedStep>& steps);

}  // namespace farcull
