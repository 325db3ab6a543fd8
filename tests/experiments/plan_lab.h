// What a plan says against what a run did.
#pragma once

#include <algorithm>
#include <string>

#include "experiments/planner.h"
#include "experiments/run.h"

namespace farcull::lab {

/// The first step of the plan that the run did not follow; "" where it followed all.
inline std::string not_followed(const std::vector<PlannedStep>& steps, const RunRecord& record) {
  const auto ran = [&](const std::string& part) {
    return std::any_of(record.stages.begin(), record.stages.end(), [&](const Stage& s) {
      return s.ran && s.name.find(part) != std::string::npos;
    });
  };
  const auto drawn = [&](const std::string& view) {
    for (const ViewReport& v : record.views) {
      if ("view " + v.name == view) return v.drawn && ran(v.name + ", round 1");
    }
    for (const PairView& v : record.pair_views) {
      if ("view " + v.name == view) return v.looked;
    }
    return false;
  };
  for (const PlannedStep& step : steps) {
    if (step.decision == Decision::depends) continue;
    bool did = true;
    if (step.name == "device") {
      did = record.device.has_value() || record.on_cpu;
    } else if (step.name.starts_with("view ")) {
      did = drawn(step.name);
    } else if (step.name == "sub-object level") {
      did = ran(step.name);
    } else if (step.name == "objects") {
      did = ran("cull objects") || ran("sweep");
    } else if (step.name == "exact tests") {
      did = ran("exact");
    } else if (step.name == "accounting") {
      did = record.verification.has_value();
    } else {
      continue;
    }
    if (did != (step.decision == Decision::runs)) return step.name;
  }
  return "";
}

}  // namespace farcull::lab
