// Compares runs in one process: methods and resolutions on one scene (`farcull compare`), and runs
// that skip unneeded work with runs that do everything, --full (`farcull experiment savings`).
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

struct SavingsArguments {
  std::vector<std::string> scenes;  // listed by `farcull scenes`; empty: all but costly ones
  std::string methods = "boxes";    // with commas
  int repeat = 15;
  RunOptions options;  // resolution, device and so on, of all
};

struct SavingsRow {
  std::string scene;
  Method method{};
  std::vector<double> planned_ms,
      full_ms;             // of each repeat, cull + exact, in the order of the runs
  bool same_pairs = true;  // with and without --full, in every repeat

  double planned() const;  // medians
  double full() const;
  /// At most 5 % + 2 ms slower than --full.
  bool pays() const;
};

/// Runs every scene by every method that applies, in turn as planned and with --full. The first run
/// of each is not counted. Throws Error as run() does.
std::vector<SavingsRow> run_savings(const SavingsArguments& arguments,
                                    const Progress& progress = {});

/// Whether two runs found the same pairs, neighbours among them.
bool same_pairs(const Record& a, const Record& b);
/// Names the first row whose method promises to miss nothing, by these options, but whose pairs
/// differ; empty if there is none. Ignores the verdict about the device.
std::string broken(const std::vector<SavingsRow>& rows, RunOptions options);

std::string savings_table(const std::vector<SavingsRow>& rows);
nlohmann::ordered_json savings_json(const std::vector<SavingsRow>& rows,
                                    const SavingsArguments& arguments);

}  // namespace farcull
