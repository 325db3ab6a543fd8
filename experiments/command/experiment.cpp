// The commands below `farcull experiment`.
#include "experiments/command/experiment.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/lemma/oracles.h"
#include "experiments/studies/study.h"
#include "experiments/system/output_file.h"

namespace farcull {

CLI::App* ExperimentCommands::add_to(CLI::App& app) {
  CLI::App* command = add_command(app, "experiment", "studies for publication, and their premises");
  allow_one_command(*command);
  add_footer(
      *command,
      "Examples:\n  farcull experiment all --quick\n  farcull experiment accuracy --out results\n"
      "  farcull experiment lemma --points 1000000\n  farcull experiment oracles "
      "--pairs 100000\n  farcull experiment family tree-leaves --methods far-pairs,i-collide\n"
      "  farcull experiment savings two-bunnies");

  studies_.add_to(*command);
  lemma_ = add_command(*command, "lemma",
                       "the reliability lemmas on a canvas, decided in exact arithmetic");
  add_option(*lemma_, "--points", arguments_.points, "N", "points in all; default 100000");
  add_option(*lemma_, "--radius", arguments_.radius, "RADIUS",
             "budget, published, or a factor on the budget;\ndefault budget");
  add_option(*lemma_, "--sweep", arguments_.sweep, "SWEEP",
             "instead: factors FROM:TO:STEP, as in 0.5:1.1:0.01");
  add_option(*lemma_, "--canvas", arguments_.canvas, "native|gl|worst",
             "native (the cores of the CPU), gl (a device), or worst\n(as bad as the assumptions "
             "allow); default gl where\n--device is given or hardware answers, else native");
  add_option(*lemma_, "--offset", arguments_.offset, "OFFSET", "obb or exact; default obb");
  add_option(*lemma_, "--seed", arguments_.seed, "N", "of the points; default 1");
  add_option(*lemma_, "--device", device_, "DEVICE", kDeviceHelp);
  add_option(*lemma_, "--json", lemma_outputs_.json, "FILE", kJsonHelp);
  add_option(*lemma_, "--csv", lemma_outputs_.csv, "FILE",
             "write the sweep as CSV to this file; - for standard\noutput");
  add_footer(*lemma_,
             "Examples:\n"
             "  farcull experiment lemma --points 1000000 --radius budget\n"
             "  farcull experiment lemma --radius published\n"
             "  farcull experiment lemma --canvas worst --sweep 0.5:1.1:0.01 --csv sweep.csv\n\n"
             "Exit status 1: a violation at the budget radius or beyond.");

  oracles_ = add_command(*command, "oracles", "the two exact oracles against each other");
  add_option(*oracles_, "--pairs", pairs_, "N", "pairs of each generator; default 100000");
  add_option(*oracles_, "--seed", seed_, "N", "of the pairs; default 1");
  add_option(*oracles_, "--json", oracle_outputs_.json, "FILE", kJsonHelp);
  add_footer(*oracles_,
             "Examples:\n  farcull experiment oracles --pairs 1000000 --json oracles.json\n\n"
             "Exit status 1: they disagree about a pair.");

  family_ = family_command_.add_to(*command);
  savings_ = savings_command_.add_to(*command);
  return command;
}

int ExperimentCommands::run_oracles() {
  if (pairs_ < 1 || pairs_ > 1'000'000'000) {
    throw Error("--pairs", std::to_string(pairs_) + " is no number of pairs", "give 1 to 1e9");
  }
  const Outputs outputs = checked(oracle_outputs_, {});
  TerminalProgress terminal;
  const std::vector<OracleRow> rows = compare_oracles(pairs_, seed_, terminal.callback());
  terminal.clear();
  if (outputs.json) write_json(oracles_json(rows, pairs_, seed_), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", oracles_table(rows));
  for (const OracleRow& row : rows) {
    if (row.disagreements > 0) return 1;
  }
  return 0;
}

int ExperimentCommands::run() {
  if (given(*oracles_)) return run_oracles();
  if (given(*family_)) return family_command_.run();
  if (given(*savings_)) return savings_command_.run();
  if (studies_.named()) return studies_.run();
  if (!given(*lemma_)) {
    std::string known = "all";
    for (const Study& study : studies()) known += ", " + study.name;
    throw Error("experiment", "no study is named",
                "name one: " + known + ", lemma, oracles, family, savings");
  }
  const Outputs outputs = checked(lemma_outputs_, {});
  arguments_.device = device_of(device_);
  arguments_.json = outputs.json.value_or("");
  arguments_.csv = outputs.csv.value_or("");
  TerminalProgress terminal;
  return lemma_command(arguments_, terminal.callback(), [&terminal] { terminal.clear(); });
}

}  // namespace farcull
