// The commands below `farcull experiment`.
#include "experiments/command/experiment.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/lemma/oracles.h"
#include "experiments/studies/study.h"
#include "experiments/system/output_file.h"

namespace farcull {

CLI::App* ExperimentCommands::add_to(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("experiment", "studies for publication, and their premises");
  command->require_subcommand(0, 1);
  command->footer(
      "Examples:\n  farcull experiment all --quick\n  farcull experiment accuracy --out results\n"
      "  farcull experiment lemma --points 1000000\n  farcull experiment oracles "
      "--pairs 100000\n  farcull experiment family tree-leaves --methods far-pairs,i-collide\n"
      "  farcull experiment savings two-bunnies");

  studies_.add_to(*command);
  lemma_ = command->add_subcommand(
      "lemma", "the reliability lemmas on a canvas, decided in exact arithmetic");
  lemma_->add_option("--points", arguments_.points, "points in all; default 100000")
      ->type_name("N");
  lemma_
      ->add_option("--radius", arguments_.radius,
                   "budget, published, or a factor on the budget;\ndefault budget")
      ->type_name("RADIUS");
  lemma_
      ->add_option("--sweep", arguments_.sweep, "instead: factors FROM:TO:STEP, as in 0.5:1.1:0.01")
      ->type_name("SWEEP");
  lemma_
      ->add_option("--canvas", arguments_.canvas,
                   "gl (a device), or worst (none: as bad as the\nassumptions allow); default gl")
      ->type_name("gl|worst");
  lemma_->add_option("--offset", arguments_.offset, "obb or exact; default obb")
      ->type_name("OFFSET");
  lemma_->add_option("--seed", arguments_.seed, "of the points; default 1")->type_name("N");
  lemma_->add_option("--device", device_, kDeviceHelp)->type_name("DEVICE");
  lemma_->add_option("--json", lemma_outputs_.json, kJsonHelp)->type_name("FILE");
  lemma_
      ->add_option("--csv", lemma_outputs_.csv,
                   "write the sweep as CSV to this file; - for standard\noutput")
      ->type_name("FILE");
  lemma_->footer(
      "Examples:\n"
      "  farcull experiment lemma --points 1000000 --radius budget\n"
      "  farcull experiment lemma --radius published\n"
      "  farcull experiment lemma --canvas worst --sweep 0.5:1.1:0.01 --csv sweep.csv\n\n"
      "Exit status 1: a violation at the budget radius or beyond.");

  oracles_ = command->add_subcommand("oracles", "the two exact oracles against each other");
  oracles_->add_option("--pairs", pairs_, "pairs of each generator; default 100000")
      ->type_name("N");
  oracles_->add_option("--seed", seed_, "of the pairs; default 1")->type_name("N");
  oracles_->add_option("--json", oracle_outputs_.json, kJsonHelp)->type_name("FILE");
  oracles_->footer(
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
  if (*oracles_) return run_oracles();
  if (*family_) return family_command_.run();
  if (*savings_) return savings_command_.run();
  if (studies_.named()) return studies_.run();
  if (!*lemma_) {
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
