// The commands below `farcull experiment`. oracles, which is no study of a grid, is defined here.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/command/command.h"
#include "experiments/lemma/lemma.h"
#include "experiments/studies/study.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

class OraclesCommand {
 public:
  CLI::App* add_to(CLI::App& experiment);
  // Returns the exit status; 1: the oracles disagree about a pair.
  int run();

 private:
  Outputs outputs_;
  std::uint64_t pairs_ = 100000;
  std::uint64_t seed_ = 1;
};

CLI::App* OraclesCommand::add_to(CLI::App& experiment) {
  return add_command(
      experiment, "oracles", "the two exact oracles against each other",
      {{"--pairs", &pairs_, "N", "pairs of each generator; default 100000"},
       {"--seed", &seed_, "N", "of the pairs; default 1"},
       {"--json", &outputs_.json, "FILE", kJsonHelp}},
      "Examples:\n  farcull experiment oracles --pairs 1000000 --json oracles.json\n\n"
      "Exit status 1: they disagree about a pair.");
}

int OraclesCommand::run() {
  if (pairs_ < 1 || pairs_ > 1'000'000'000) {
    throw Error("--pairs", std::to_string(pairs_) + " is no number of pairs", "give 1 to 1e9");
  }
  const Outputs outputs = checked(outputs_, {});
  TerminalProgress terminal;
  const std::vector<OracleRow> rows = compare_oracles(pairs_, seed_, terminal.callback());
  terminal.clear();
  if (outputs.json) write_json(oracles_json(rows, pairs_, seed_), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", oracles_table(rows));
  return std::ranges::any_of(rows, [](const OracleRow& row) { return row.disagreements > 0; });
}

class ExperimentCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    CLI::App* command = add_command(
        app, "experiment", "studies for publication, and their premises", {},
        "Examples:\n  farcull experiment all --quick\n  farcull experiment accuracy --out results\n"
        "  farcull experiment lemma --points 1000000\n  farcull experiment oracles "
        "--pairs 100000");
    allow_one_command(*command);
    commands_ = add_studies(*command);
    commands_.insert(commands_.end(), {add_lemma(*command), declare<OraclesCommand>(*command)});
    return command;
  }
  int run() const {
    for (const Command& command : commands_) {
      if (given(*command.app)) return command.run();
    }
    std::string known = "all";
    for (const Study& study : studies()) known += ", " + study.name;
    throw Error("experiment", "no study is named", "name one: " + known + ", lemma, oracles");
  }

 private:
  std::vector<Command> commands_;
};

}  // namespace

Command add_experiment(CLI::App& app) { return declare<ExperimentCommand>(app); }

}  // namespace farcull
