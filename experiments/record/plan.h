// `farcull plan`: a plan as a table and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/method/plan.h"

namespace farcull {

/// One line a stage: whether it runs, is left out or depends on pixels, and why.
std::string plan_table(const Scene& scene, const Plan& plan);
/// docs/record.md, "Plans".
nlohmann::ordered_json plan_json(const Scene& scene, const Plan& plan);

/// "runs", "left out" or "depends": of a planned stage.
std::string decision_of(const Stage& stage);

}  // namespace farcull
