// The commands below `farcull experiment`; oracles, family and savings, which are no studies of a
// grid, are defined here.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/command/command.h"
#include "experiments/lemma/lemma.h"
#include "experiments/measure/compare.h"
#include "experiments/measure/family.h"
#include "experiments/scenes/frames.h"
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

constexpr const char* kMovingHelp = "built-in scenes that move; default all of them";

int resolution_option(const Text& text) { return text ? parse_resolution(*text) : 0; }

class FamilyCommand {
 public:
  CLI::App* add_to(CLI::App& experiments);
  int run();

 private:
  FamilyArguments arguments_;
  Text frames_, resolution_, views_, query_, device_;
  Outputs outputs_;
  bool no_verify_ = false;
};

CLI::App* FamilyCommand::add_to(CLI::App& experiments) {
  return add_command(
      experiments, "family", "moving scenes by every method, beside the rates of the papers",
      {{"SCENE", &arguments_.scenes, "", kMovingHelp},
       {"--methods", &arguments_.methods, "LIST", "by commas; default all that apply"},
       {"--frames", &frames_, "N|A:B", "of each scene; default 30"},
       {"--resolution", &resolution_, "N", "px, of the methods that draw; default 512"},
       {"--views", &views_, "VIEWS", "of the methods that draw; default x,y,z"},
       {"--query", &query_, "flags|occlusion", "how visibility is asked; default flags"},
       {"--device", &device_, "DEVICE", kDeviceHelp},
       {"--self", &arguments_.self, "", help_of_option("self")},
       {"--no-verify", &no_verify_, "", "leave out the accounting of all pairs"},
       {"--csv", &outputs_.csv, "FILE",
        "a row a frame, with the factor by which i-collide keeps\nmore, to this file; - for "
        "standard "
        "output"},
       {"--json", &outputs_.json, "FILE", kJsonHelp}},
      "Examples:\n"
      "  farcull experiment family tree-leaves --methods boxes,i-collide --frames 100\n"
      "  farcull experiment family breaking-dragon --methods far,i-collide --csv efficiency.csv\n"
      "  farcull experiment family --json family.json\n\n"
      "Exit status 1: a method that promises missed a pair.");
}

int FamilyCommand::run() {
  if (frames_) arguments_.range = parse_frames(*frames_);
  RunOptions& options = arguments_.options;
  options.resolution = resolution_option(resolution_);
  options.device = farcull::device_of(device_);
  options.verify = !no_verify_;
  options.method = Method::far;  // for all methods that draw: the scene does not choose the views
  take_given("views", views_, options);
  take_given("query", query_, options);
  const Outputs outputs = checked(outputs_, scene_files(arguments_.scenes, arguments_.range));
  TerminalProgress terminal;
  const std::vector<FamilyCell> cells = run_family(arguments_, terminal.callback());
  terminal.clear();
  if (outputs.csv) write_output(*outputs.csv, family_csv(cells));
  if (outputs.json) write_json(family_json(cells, arguments_), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", family_table(cells));
  const std::string promise = broken(cells);
  if (promise.empty()) return kExitDone;
  complain(promise);
  return kExitBroken;
}

class SavingsCommand {
 public:
  CLI::App* add_to(CLI::App& experiments);
  int run();

 private:
  SavingsArguments arguments_;
  Text repeat_, resolution_, device_;
  Outputs outputs_;
};

CLI::App* SavingsCommand::add_to(CLI::App& experiments) {
  return add_command(
      experiments, "savings", "what leaving out saves: times as planned over times with --full",
      {{"SCENE", &arguments_.scenes, "",
        "built-in scenes or scene files; default all built-in\nones but the costly"},
       {"--methods", &arguments_.methods, "LIST", "by commas; default boxes"},
       {"--repeat", &repeat_, "N", "runs of each; default 15"},
       {"--resolution", &resolution_, "N", "px, of the methods that draw; default 512"},
       {"--device", &device_, "DEVICE", kDeviceHelp},
       {"--json", &outputs_.json, "FILE", kJsonHelp}},
      "Examples:\n"
      "  farcull experiment savings\n"
      "  farcull experiment savings two-bunnies --methods far,boxes --repeat 15\n\n"
      "Exit status 1: a method that promises finds other pairs with --full than without.");
}

int SavingsCommand::run() {
  if (repeat_) arguments_.repeat = parse_repeat(*repeat_);
  RunOptions& options = arguments_.options;
  options.resolution = resolution_option(resolution_);
  options.device = farcull::device_of(device_);
  const Outputs outputs = checked(outputs_, scene_files(arguments_.scenes));
  TerminalProgress terminal;
  const std::vector<SavingsRow> rows = run_savings(arguments_, terminal.callback());
  terminal.clear();
  if (outputs.json) write_json(savings_json(rows, arguments_), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", savings_table(rows));
  const std::string promise = broken(rows, options);
  if (promise.empty()) return kExitDone;
  complain(promise);
  return kExitBroken;
}

class ExperimentCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    CLI::App* command = add_command(
        app, "experiment", "studies for publication, and their premises", {},
        "Examples:\n  farcull experiment all --quick\n  farcull experiment accuracy --out results\n"
        "  farcull experiment lemma --points 1000000\n  farcull experiment oracles "
        "--pairs 100000\n  farcull experiment family tree-leaves --methods boxes,i-collide\n"
        "  farcull experiment savings two-bunnies");
    allow_one_command(*command);
    commands_ = add_studies(*command);
    commands_.insert(commands_.end(),
                     {add_lemma(*command), declare<OraclesCommand>(*command),
                      declare<FamilyCommand>(*command), declare<SavingsCommand>(*command)});
    return command;
  }
  int run() const {
    for (const Command& command : commands_) {
      if (given(*command.app)) return command.run();
    }
    std::string known = "all";
    for (const Study& study : studies()) known += ", " + study.name;
    throw Error("experiment", "no study is named",
                "name one: " + known + ", lemma, oracles, family, savings");
  }

 private:
  std::vector<Command> commands_;
};

}  // namespace

Command add_experiment(CLI::App& app) { return declare<ExperimentCommand>(app); }

}  // namespace farcull
