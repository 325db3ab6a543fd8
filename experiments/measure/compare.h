// Compares methods and resolutions on one scene, in one process (`farcull compare`).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/method/run.h"
#include "experiments/record/tables.h"

namespace farcull {

struct CompareArguments {
  std::optional<std::string> methods;  // names with commas; empty: usual_methods()
  /// px, with commas, for methods that draw.
  std::optional<std::string> resolutions;
  std::string offsets = "obb";   // for far
  std::string radii = "budget";  // for far, with commas, as parse_radius() takes each
  bool self = false;             // every object was made to be tested against itself
  /// Runs of each; empty: three, but only one if that takes longer than ten seconds.
  std::optional<std::string> repeat;
  bool risk = true;  // count the pairs at risk of far
  /// Views, device, clearance and seed are for all methods; rounds, clear, level and conservative
  /// for the methods that take them.
  RunOptions options;
};

struct Comparison {
  std::vector<std::vector<Record>> runs;  // per method and resolution: its repeats, in order

  /// For each group of repeats the run with the median of cull + exact time, and the spread.
  std::vector<Compared> rows() const;
};

/// The methods that are compared if none are named: those of far, cullide, boxes and exact that
/// support the clearance if there is one, and tests of objects against themselves if `self` is set.
std::string usual_methods(bool clearance, bool self);

/// Throws Error naming the option for bad arguments, before a scene is read.
void validate(const CompareArguments& arguments);

/// Runs every method that draws at every resolution (far with every offset and radius), and the
/// others once, each `repeat` times. If radii of far with and without a guarantee are compared, all
/// of them draw the same stages (RunOptions::no_shortcuts). Throws Error for bad arguments, and
/// before the first run for a resolution beyond the device.
Comparison compare(const Scene& scene, const CompareArguments& arguments,
                   const Progress& progress = {});

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison);
/// The table as CSV, with the objects and triangles that culling left, and the parts of the time.
std::string comparison_csv(const Scene& scene, const std::vector<Compared>& rows);

}  // namespace farcull
