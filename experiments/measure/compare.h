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
  /// Resolutions in px, with commas, for methods that draw.
  std::optional<std::string> resolutions;
  std::string offsets = "obb";   // for the method far; names with commas
  std::string radii = "budget";  // for the method far; values of parse_radius() with commas
  bool self = false;             // every object is tested against itself
  /// The number of runs of each method and resolution. If empty, three runs, but only one if the
  /// first run takes longer than ten seconds.
  std::optional<std::string> repeat;
  bool risk = true;    // count the pairs at risk (PairsAtRisk)
  RunOptions options;  // for all methods; a method uses the options that it has
};

struct Comparison {
  std::vector<std::vector<Record>> runs;  // for each method and resolution, the repeated runs

  /// Returns one row for each method and resolution: the run with the median time, and the spread
  /// of the times.
  std::vector<Compared> rows() const;
};

/// Returns the methods that are compared if the user names none. clearance: only methods that take
/// a clearance. self: only methods that can test an object against itself.
std::string usual_methods(bool clearance, bool self);

/// Throws Error if an argument is bad. The error names the option. Needs no scene.
void validate(const CompareArguments& arguments);

/// Runs all methods, each `repeat` times. A method that draws runs at every resolution, and far
/// also with every offset and radius. If a radius of far has no guarantee, all radii run the same
/// stages (RunOptions::no_shortcuts). Throws Error for bad arguments. Throws Error before the first
/// run if a resolution is too large for the device.
Comparison compare(const Scene& scene, const CompareArguments& arguments,
                   const Progress& progress = {});

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison);
/// Returns the table as CSV. It includes the objects and triangles that culling left, and the times
/// of culling and of the exact tests.
std::string comparison_csv(const Scene& scene, const std::vector<Compared>& rows);

}  // namespace farcull
