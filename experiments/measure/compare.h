// Compares methods and resolutions on one scene, in one process (`farcull compare`).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/method/run.h"

namespace farcull {

struct CompareArguments {
  /// Names with commas. Empty: far, cullide, boxes and exact, without those that do not support
  /// the clearance, or objects tested against themselves if the scene has such objects.
  std::optional<std::string> methods;
  /// px, with commas, for methods that draw.
  std::optional<std::string> resolutions;
  std::string offsets = "obb";  // for far
  bool self = false;            // every object was made to be tested against itself
  std::string repeat = "1";
  /// Views, device, clearance and seed are for all methods; rounds, clear, level and conservative
  /// for the methods that take them.
  RunOptions options;
};

struct Comparison {
  std::vector<std::vector<Record>> runs;  // per method and resolution: its repeats, in order

  /// The run with the median of cull + exact time, for each group of repeats.
  std::vector<Record> median_records() const;
};

/// Throws Error naming the option for bad arguments, before a scene is read.
void validate(const CompareArguments& arguments);

/// Runs every method that draws at every resolution (far with every offset), and the others once,
/// each `repeat` times. Throws Error for bad arguments, and before the first run for a resolution
/// beyond the device.
Comparison compare(const Scene& scene, const CompareArguments& arguments,
                   const Progress& progress = {});

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison);

}  // namespace farcull
