// Reads the options, runs the methods side by side and prints their table.
#include "experiments/measure/compare.h"

#include <nlohmann/json.hpp>

#include "experiments/command/command.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

class CompareCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  int run() const;

 private:
  SceneArguments scene_;
  CompareArguments arguments_;
  MethodOptions options_;
  Outputs outputs_;
};

CLI::App* CompareCommand::add_to(CLI::App& app) {
  return add_command(
      app, "compare", "methods and resolutions side by side",
      scene_rows(scene_) +
          Rows{{"--methods", &arguments_.methods, "LIST",
                "separated by commas;\ndefault far,cullide,boxes,exact"},
               {"--resolutions", &arguments_.resolutions, "LIST",
                "separated by commas, for methods that draw;\ndefault 128,256,512,1024,2048"},
               {"--offsets", &arguments_.offsets, "LIST",
                "for far, separated by commas: obb, exact;\ndefault obb"},
               {"--repeat", &arguments_.repeat, "N",
                "runs of each, the one with the median time is shown;\ndefault 1"}} +
          options_.rows({"views", "rounds", "clear", "level", "broad_phase", "conservative",
                         "device", "self", "clearance"}) +
          Rows{{"--json", &outputs_.json, "FILE", kJsonHelp}},
      "Examples:\n"
      "  farcull compare two-tori\n"
      "  farcull compare two-bunnies --methods far,exact --resolutions 256,512 --repeat 5\n"
      "  farcull compare two-tori --methods cullide,far --rounds 1 --clear all\n"
      "  farcull compare mannequin-devil --methods boxes,exact --self\n\n"
      "farcull help terms explains the columns, farcull help methods the methods.\n\n"
      "Exit status 1: a method that promises missed a pair.");
}

int CompareCommand::run() const {
  CompareArguments arguments = arguments_;
  RunOptions& options = arguments.options;
  arguments.self = options_.has("self");
  options.seed = seed_of(scene_.names);
  options.method = Method::far;  // which has all options but the clearance
  for (const auto& [name, text] : options_.given()) {
    if (run_option(name).take) take_option(name, text, options);
  }
  validate(arguments);
  check_scene(scene_.names);
  const Outputs outputs = checked(outputs_, scene_files(scene_.names));
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  if (progress) progress("reading the scene");
  Scene scene = read_scene(scene_);
  if (arguments.self) make_self(scene);
  require_pairs(nothing_to_test(scene), command_with("farcull compare", scene_) + " --self");
  const Comparison comparison = compare(scene, arguments, progress);
  terminal.clear();
  const std::vector<Record> records = comparison.median_records();
  if (outputs.json) write_json(to_json(scene, comparison), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", comparison_table(scene, records));
  for (const Record& record : records) {
    if (!broken(record, false)) continue;
    complain_broken(missed(record));
    return kExitBroken;
  }
  return kExitDone;
}

}  // namespace

Command add_compare(CLI::App& app) { return declare<CompareCommand>(app); }

}  // namespace farcull
