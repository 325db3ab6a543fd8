// Methods and resolutions side by side on one scene, in one process.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/method/run.h"

namespace farcull {

struct CompareArguments {
  std::vector<std::string> scene;
  /// By commas; where none is given all, or those that can where an object is tested against
  /// itself or there is a clearance.
  std::optional<std::string> methods;
  /// px, by commas; `auto` for far-pairs alone, which takes nothing else where none is given.
  std::optional<std::string> resolutions;
  std::string offsets = "obb";  // for far
  bool self = false;            // every object was made to be tested against itself
  std::string repeat = "1";
  /// Views, device, clearance and seed for all; rounds, clear, level and conservative for those
  /// that take them.
  RunOptions options;
};

struct Comparison {
  std::vector<std::vector<Record>> runs;  // per method and resolution: its repeats, in order

  /// The run with the median of cull + exact time, for each group of repeats.
  std::vector<Record> median_records() const;
};

/// Throws Error naming the option for bad arguments, before a scene is read.
void validate(const CompareArguments& arguments);

/// Runs every method at every resolution (`exact` once; far with every offset), each `repeat`
/// times. `auto` is passed over by far and cullide where they have another resolution. Throws Error
/// for bad arguments, and before the first run for a resolution beyond the device.
Comparison compare(const Scene& scene, const CompareArguments& arguments,
                   const Progress& progress = {});

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison);

}  // namespace farcull
