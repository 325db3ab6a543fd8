// `farcull experiment savings`: the time of runs that leave out what they need not do over the time
// of runs that do everything (--full), side by side in one process.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/method/run.h"

namespace farcull {

struct SavingsArguments {
  std::vector<std::string> scenes;    // of farcull scenes, one by one; empty: all but costly ones
  std::string methods = "far-pairs";  // by commas
  int repeat = 15;
  RunOptions options;  // resolution, device and so on, of all
};

struct SavingsRow {
  std::string scene;
  Method method{};
  std::vector<double> planned_ms,
      full_ms;             // of each repeat, cull + exact, in the order of the runs
  bool same_pairs = true;  // with and without, in every repeat

  double planned() const;  // medians
  double full() const;
  /// At most 5 % + 2 ms slower than --full.
  bool pays() const;
};

/// Runs every scene by every method that applies, alternating between the two, after a run of each
/// that is not counted. Throws Error as run() does.
std::vector<SavingsRow> run_savings(const SavingsArguments& arguments,
                                    const Progress& progress = {});

/// Whether two runs found the same pairs, neighbours among them.
bool same_pairs(const Record& a, const Record& b);
/// The first method that promises, by these options, and whose pairs differ; empty: none. A device
/// whose verdict was revoked hides nothing.
std::string broken(const std::vector<SavingsRow>& rows, RunOptions options);

std::string savings_table(const std::vector<SavingsRow>& rows);
nlohmann::ordered_json savings_json(const std::vector<SavingsRow>& rows,
                                    const SavingsArguments& arguments);

}  // namespace farcull
