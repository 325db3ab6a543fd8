// Options of `farcull experiment family` and `savings`, and their runs.
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/command/commands.h"
#include "experiments/command/options.h"
#include "experiments/measure/compare.h"
#include "experiments/measure/family.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

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
  CLI::App* command = add_command(experiments, "family",
                                  "moving scenes by every method, beside the rates of the papers");
  add_option(*command, "SCENE", arguments_.scenes, "", kMovingHelp);
  const auto add = [&](const char* name, Text& text, const char* type, const char* help) {
    add_option(*command, name, text, type, help);
  };
  add("--methods", arguments_.methods, "LIST", "by commas; default all that apply");
  add("--frames", frames_, "N|A:B", "of each scene; default 30");
  add("--resolution", resolution_, "N",
      "px, of the methods that draw; default 512; far-pairs\nchooses by the scene");
  add("--views", views_, "VIEWS", "of the methods that draw; default x,y,z");
  add("--query", query_, "flags|occlusion", "how visibility is asked; default flags");
  add("--device", device_, "DEVICE", kDeviceHelp);
  add_flag(*command, "--self", arguments_.self, help_of_option("self"));
  add_flag(*command, "--no-verify", no_verify_, "leave out the accounting of all pairs");
  add("--csv", outputs_.csv, "FILE",
      "a row a frame, with the factor by which i-collide keeps\nmore, to this file; - for standard "
      "output");
  add("--json", outputs_.json, "FILE", kJsonHelp);
  add_footer(
      *command,
      "Examples:\n"
      "  farcull experiment family tree-leaves --methods far-pairs,i-collide --frames 100\n"
      "  farcull experiment family breaking-dragon --methods far,i-collide --csv efficiency.csv\n"
      "  farcull experiment family --json family.json\n\n"
      "Exit status 1: a method that promises missed a pair.");
  return command;
}

int FamilyCommand::run() {
  if (frames_) arguments_.range = parse_frames(*frames_);
  RunOptions& options = arguments_.options;
  options.resolution = resolution_option(resolution_);
  options.device = farcull::device_of(device_);
  options.verify = !no_verify_;
  options.method = Method::far;  // for all that draw: the scene chooses no views
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
  CLI::App* command = add_command(
      experiments, "savings", "what leaving out saves: times as planned over times with --full");
  add_option(*command, "SCENE", arguments_.scenes, "",
             "built-in scenes or scene files; default all built-in\nones but the costly");
  add_option(*command, "--methods", arguments_.methods, "LIST", "by commas; default far-pairs");
  const auto add = [&](const char* name, Text& text, const char* type, const char* help) {
    add_option(*command, name, text, type, help);
  };
  add("--repeat", repeat_, "N", "runs of each; default 15");
  add("--resolution", resolution_, "N", "px, of the methods that draw; default 512");
  add("--device", device_, "DEVICE", kDeviceHelp);
  add("--json", outputs_.json, "FILE", kJsonHelp);
  add_footer(*command,
             "Examples:\n"
             "  farcull experiment savings\n"
             "  farcull experiment savings two-bunnies --methods far,far-pairs --repeat 15\n\n"
             "Exit status 1: a method that promises finds other pairs with --full than without.");
  return command;
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

}  // namespace

Command add_family(CLI::App& experiment) { return declare<FamilyCommand>(experiment); }

Command add_savings(CLI::App& experiment) { return declare<SavingsCommand>(experiment); }

}  // namespace farcull
