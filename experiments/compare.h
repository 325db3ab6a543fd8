// Methods and resolutions side by side on one scene, in one process.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace farcull {

struct CompareArguments {
  std::vector<std::string> scene;
  std::string methods = "far,cullide,exact";
  std::string resolutions = "128,256,512,1024,2048";
  std::string offsets = "obb";  // for far
  std::string repeat = "1";
  RunOptions options;  // views, device and seed for all
};

struct Comparison {
  std::vector<std::vector<RunRecord>> runs;  // per method and resolution: its repeats, in order

  /// Of each group of repeats, the run with the median of cull + exact time.
  std::vector<RunRecord> median_records() const;
};

/// Throws Error naming the option for bad arguments, before a scene is read.
void validate(const CompareArguments& arguments);

/// Runs every method at every resolution (`exact` once; far with every offset), each `repeat`
/// times. Throws Error for bad arguments, and before the first run for a resolution beyond the
/// device.
Comparison compare(const Scene& scene, const CompareArguments& arguments,
                   const Progress& progress = {});

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison);

}  // namespace farcull
