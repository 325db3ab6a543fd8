// The method `exact`: see Traits::plan and Traits::find (method.h).
#pragma once

#include "experiments/method/candidates.h"
#include "experiments/method/plan.h"
#include "experiments/method/session.h"

namespace farcull {

void plan_exact(const Scene& scene, unsigned threads, const Progress& progress, Plan& plan);
Candidates find_exact(const Scene& scene, const Plan& plan, Session& session,
                      const Progress& progress);

}  // namespace farcull
