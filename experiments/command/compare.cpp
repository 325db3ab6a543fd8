// Reads the options, runs the methods side by side and prints their table.
#include "experiments/measure/compare.h"

#include <algorithm>
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
  void require_meaning() const;

  SceneArguments scene_;
  CompareArguments arguments_;
  Text offsets_;
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
               {"--offsets", &offsets_, "LIST",
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

// Throws Error naming an option that none of the listed methods has.
void CompareCommand::require_meaning() const {
  if (!arguments_.methods) return;
  std::vector<Method> methods;
  for (const std::string& name : split_list(*arguments_.methods))
    methods.push_back(parse_method(name, "--methods"));
  const auto require = [&](const std::string& word, bool (*serves)(const Traits&)) {
    if (std::ranges::any_of(methods, [&](Method m) { return serves(traits(m)); })) return;
    throw Error(word, "has no meaning for any of the methods",
                "leave it out, or add one of " + method_names(serves) + " to --methods");
  };
  if (arguments_.resolutions) require("--resolutions", [](const Traits& t) { return t.draws; });
  if (offsets_) require("--offsets", [](const Traits& t) { return t.fattens; });
  for (const auto& [name, text] : options_.given())
    require(option_word(name), run_option(name).serves);
}

int CompareCommand::run() const {
  require_meaning();
  CompareArguments arguments = arguments_;
  if (offsets_) arguments.offsets = *offsets_;
  RunOptions& options = arguments.options;
  arguments.self = options_.has("self");
  options.seed = seed_of(scene_.names);
  options.method = Method::far;  // far has all options except the clearance
  for (const auto& [name, text] : options_.given()) {
    if (run_option(name).take) take_option(name, text, options);
  }
  validate(arguments);
  check_scene(scene_.names);
  const Outputs outputs = checked(outputs_, scene_files(scene_.names));
  TerminalProgress terminal;
  const Progress progress = terminal.callback("reading the scene");
  Scene scene = read_scene(scene_);
  if (arguments.self) make_self(scene);
  require_pairs(nothing_to_test(scene), command_with("farcull compare", scene_) + " --self");
  const std::string methods = arguments.methods.value_or("");
  if (!has_self(scene) && std::ranges::count(split_list(methods), to_string(Method::s_cullide)) > 0)
    throw Error("--methods", "s-cullide tests objects against themselves, and none of it has to be",
                "add --self, or leave s-cullide out");
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
