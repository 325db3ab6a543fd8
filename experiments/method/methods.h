// The functions in the table of methods: Traits::plan and Traits::find (method.h) of each method.
#pragma once

#include "experiments/method/plan.h"
#include "experiments/method/record.h"
#include "experiments/method/session.h"

namespace farcull {

PlanFunction plan_drawing, plan_sweep, plan_by_boxes, plan_exact;
FindFunction find_by_drawing, find_by_sweep, find_by_boxes, find_exact;
// The functions of a new method go here.

}  // namespace farcull
