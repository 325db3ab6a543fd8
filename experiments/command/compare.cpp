// Reads the options, runs the methods side by side and prints their table.
#include "experiments/measure/compare.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "experiments/command/command.h"
#include "experiments/system/output_file.h"
#include "experiments/system/python.h"

namespace farcull {
namespace {

// Replaces this process by a Python program, which draws `csv` to `path` and exits with `status`.
void draw(const std::string& csv, const std::string& path, int status) {
  std::FILE* const rows = std::tmpfile();
  if (rows == nullptr || std::fwrite(csv.data(), 1, csv.size(), rows) != csv.size() ||
      std::fflush(rows) != 0 || std::fseek(rows, 0, SEEK_SET) != 0 ||
      ::dup2(::fileno(rows), STDIN_FILENO) < 0)
    throw Error("--figure", "its numbers cannot be kept in a file",
                "set TMPDIR to a folder with room");
  become_python({"-B", report_folder(FARCULL_REPORT_FOLDER) + "/compare_figure.py", path,
                 std::to_string(status)},
                "install it (Debian: python3-matplotlib python3-pandas), or write --csv");
}

class CompareCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "compare", "methods and resolutions side by side",
        scene_rows(scene_) +
            Rows{{"--methods", &arguments_.methods, "LIST",
                  "separated by commas;\ndefault far,cullide,boxes,exact"},
                 {"--resolutions", &arguments_.resolutions, "LIST",
                  "separated by commas, for methods that draw;\ndefault 128,256,512,1024,2048"},
                 {"--offsets", &offsets_, "LIST",
                  "for far, separated by commas: obb, exact;\ndefault obb"},
                 {"--radius", &radii_, "LIST",
                  "for far, separated by commas: budget, published, or\n"
                  "factors on the budget, as in budget,published,0.9;\ndefault budget"},
                 {"--repeat", &arguments_.repeat, "N",
                  "runs of each, the one with the median time is shown;\n"
                  "default 3, and 1 of what takes over 10 seconds"},
                 {"--no-risk", &no_risk_, "", kNoRiskHelp}} +
            options_.rows({"views", "rounds", "clear", "level", "broad_phase", "conservative",
                           "device", "self", "clearance"}) +
            Rows{{"--json", &outputs_.json, "FILE", kJsonHelp},
                 {"--csv", &outputs_.csv, "FILE",
                  "write the table as CSV to this file, with more columns;\n"
                  "- for standard output, without the table"},
                 {"--figure", &outputs_.figure, "FILE.svg",
                  "draw missed pairs against time; needs Python with\nmatplotlib and pandas"}},
        "Examples:\n"
        "  farcull compare two-tori\n"
        "  farcull compare two-bunnies --methods far,exact --resolutions 256,512 --repeat 5\n"
        "  farcull compare two-tori --methods cullide,far --rounds 1 --clear all\n"
        "  farcull compare a.obj b.obj --methods far --radius budget,published,0.9 --csv "
        "radii.csv\n"
        "  farcull compare a.obj b.obj --figure error-time.svg\n"
        "  farcull compare mannequin-devil --methods boxes,exact --self\n\n"
        "farcull help terms explains the columns, farcull help methods the methods.\n\n"
        "Exit status 1: a method that promises missed a pair.");
  }
  int run() const {
    require_meaning();
    CompareArguments arguments = arguments_;
    if (offsets_) arguments.offsets = *offsets_;
    RunOptions& options = arguments.options;
    if (radii_) arguments.radii = *radii_;
    arguments.risk = !no_risk_;
    arguments.self = options_.has("self");
    options.seed = seed_of(scene_.names);
    options.method = Method::far;  // compare() sets the method of each run
    for (const auto& [name, text] : options_.given()) {
      if (run_option(name).take) take_option(name, text, options);
    }
    validate(arguments);
    check_scene(scene_.names);
    const Outputs outputs = checked(outputs_, scene_files(scene_.names));
    if (outputs.figure && !outputs.figure->ends_with(".svg"))
      throw Error("--figure", *outputs.figure + " is no name of an SVG", "let it end in .svg");
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    const Scene scene = read_scene(scene_, arguments.self);
    require_pairs(nothing_to_test(scene), command_with("farcull compare", scene_) + " --self");
    const std::string methods = arguments.methods.value_or("");
    if (!has_self(scene) &&
        std::ranges::count(split_list(methods), to_string(Method::s_cullide)) > 0)
      throw Error("--methods",
                  "s-cullide tests objects against themselves, and none of it has to be",
                  "add --self, or leave s-cullide out");
    const Comparison comparison = compare(scene, arguments, progress);
    terminal.clear();
    const std::vector<Compared> rows = comparison.rows();
    const std::string csv = comparison_csv(scene, rows);
    if (outputs.json) write_json(to_json(scene, comparison), *outputs.json);
    if (outputs.csv) write_output(*outputs.csv, csv);
    if (!outputs.to_stdout()) {
      print(comparison_table(scene, rows));
      if (!arguments.methods && options.clearance > 0)
        print("left out   far, cullide: they take no --clearance\n");
      else if (!arguments.methods && has_self(scene))
        print("left out   cullide: it tests no object against itself (--methods s-cullide does)\n");
    }
    int status = kExitDone;
    for (const auto& [record, least, most, runs] : rows) {
      if (status != kExitDone || !broken(record, false)) continue;
      complain_broken(missed(record));
      status = kExitBroken;
    }
    if (outputs.figure) draw(csv, *outputs.figure, status);
    return status;
  }

 private:
  // Throws Error if an option was given that no listed method has.
  void require_meaning() const {
    std::vector<Method> methods;
    const std::string usual = usual_methods(options_.has("clearance"), options_.has("self"));
    for (const std::string& name : split_list(arguments_.methods.value_or(usual)))
      methods.push_back(parse_method(name, "--methods"));
    const auto require = [&](const std::string& word, bool (*serves)(const Traits&)) {
      if (std::ranges::any_of(methods, [&](Method m) { return serves(traits(m)); })) return;
      throw Error(word, "has no meaning for any of the methods",
                  "leave it out, or add to --methods: " + method_names(serves));
    };
    if (arguments_.resolutions) require("--resolutions", [](const Traits& t) { return t.draws; });
    if (offsets_) require("--offsets", [](const Traits& t) { return t.fattens; });
    if (radii_) require("--radius", [](const Traits& t) { return t.fattens; });
    for (const auto& [name, text] : options_.given())
      require(option_word(name), run_option(name).serves);
  }

  SceneArguments scene_;
  CompareArguments arguments_;
  Text offsets_, radii_;
  bool no_risk_ = false;
  MethodOptions options_;
  Outputs outputs_;
};

}  // namespace

Command add_compare(CLI::App& app) { return declare<CompareCommand>(app); }

}  // namespace farcull
