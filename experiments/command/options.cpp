// Checks values and places of output before a command runs.
#include "experiments/command/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parameter.h"
#include "core/base/terminal.h"
#include "core/base/text.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"
#include "experiments/system/shell_word.h"
#include "experiments/system/text_table.h"

namespace farcull {

void add_scene(CLI::App& command, std::vector<std::string>& scene) {
  add_required(command, "SCENE", scene, kSceneHelp);
}

void MethodOptions::add_to(CLI::App& command, const std::vector<std::string>& names) {
  for (const Option& option : run_options()) {
    Text& text = texts_[option.name];
    bool& flag = flags_[option.name];
    if (!names.empty() && std::ranges::find(names, option.name) == names.end()) continue;
    const std::string word = option_word(option.name);
    if (*option.type == 0) {
      add_flag(command, word.c_str(), flag, spelled(option.help));
    } else {
      add_option(command, word.c_str(), text, option.type, spelled(option.help));
    }
  }
}

GivenOptions MethodOptions::given() const {
  GivenOptions out;
  for (const Option& option : run_options()) {
    if (has(option.name)) out[option.name] = text(option.name).value_or("");
  }
  return out;
}

void take_given(const char* name, const Text& text, RunOptions& options) {
  if (text) take_option(name, *text, options);
}

std::string help_of_option(const std::string& name) { return spelled(run_option(name).help); }

void complain(const std::string& message) {
  std::fprintf(stderr, "farcull: %s\n", clean_name(message).c_str());
}

void complain_broken(const std::string& message) {
  const std::string line = "farcull: " + clean_name(message);
  std::fprintf(stderr, "%s\n", coloured(line, Colour::bad, STDERR_FILENO).c_str());
}

std::string command_with(const std::string& command, const std::vector<std::string>& scene) {
  std::string out = command;
  for (const std::string& word : scene) out += " " + quoted(clean_name(word));
  return out;
}

std::string nothing_note(const NothingToTest& nothing, const std::string& command) {
  if (nothing.reason.empty()) return "";
  const std::string line = "nothing to test: " + nothing.reason;
  return coloured(line, Colour::doubtful, STDOUT_FILENO) + "\n" +
         (nothing.with_self ? "this tests it: " + command + "\n" : "");
}

Progress TerminalProgress::callback() {
  const char* const terminal = std::getenv("TERM");
  if (!is_terminal(stderr) || terminal == nullptr || std::string_view(terminal) == "dumb")
    return {};
  return [this](const std::string& stage) { show(stage + " ..."); };
}

void TerminalProgress::clear() {
  if (std::exchange(shown_, false)) std::fputs("\r\033[K", stderr);
}

// A line that wraps could not be written over, so it is cut to the terminal as it is now.
void TerminalProgress::show(std::string line) {
  if (const unsigned columns = terminal_columns(stderr); columns > 1)
    line = line.substr(0, columns - 1);
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  shown_ = true;
}

bool Outputs::to_stdout() const {
  return json == "-" || pairs == "-" || certificate == "-" || csv == "-" || picture == "-";
}

namespace {

// Certificates are of one scene each.
void require_number(const std::string& certificate, bool frames) {
  if (is_numbered(certificate) == frames) return;
  if (frames) {
    throw Error("--certificate", "'" + certificate + "' has no place for the number of the frame",
                "put %d or %04d there, as in certificate_%04d.json: each frame has a file of its "
                "own");
  }
  throw Error("--certificate", "'" + certificate + "' has a place for the number of a frame",
              "say which frames with --frames N or --frames FIRST:LAST, or name one file");
}

}  // namespace

Outputs checked(Outputs outputs, const std::vector<NamedFile>& inputs,
                const std::optional<FrameRange>& frames) {
  std::vector<NamedFile> files;
  std::vector<std::string> to_try;  // of many files in one folder the first
  for (const auto& [option, path, example] :
       {std::tuple("--json", &outputs.json, "result.json"),
        std::tuple("--pairs", &outputs.pairs, "result.csv"),
        std::tuple("--certificate", &outputs.certificate, "result.json"),
        std::tuple("--csv", &outputs.csv, "result.csv"),
        std::tuple("-o", &outputs.picture, "picture.png"),
        std::tuple("--html", &outputs.page, "page.html")}) {
    if (!*path) continue;
    // By its other name, standard output would be written at two places at once.
    if (**path == "/dev/stdout") *path = "-";
    if ((*path)->empty())
      throw Error(option, "the path is empty", "name a file, or - for standard output");
    // `run a.off --json --pairs b.csv`: CLI11 takes what follows for the value.
    if ((*path)->starts_with("-") && **path != "-") {
      throw Error(option, "its value is missing before '" + **path + "'",
                  "name a file, with ./ before a name that begins with -");
    }
    // `run --json a.off b.off`: the mesh would be gone.
    if (has_mesh_extension(**path)) {
      throw Error(option, **path + " is named like a mesh and would be overwritten",
                  std::string("name the file to write first, as in ") + option + " " + example);
    }
    const bool certificate = path == &outputs.certificate;
    if (certificate) require_number(**path, frames.has_value());
    const std::vector<std::string> each =
        certificate ? numbered_files(**path, frames) : std::vector{**path};
    for (const std::string& file : each) files.push_back({option, file});
    to_try.push_back(each.front());
  }
  require_apart(inputs, files);
  for (const std::string& file : to_try) check_output(file);
  if (!outputs.to_stdout()) check_output("-");
  return outputs;
}

void check_scene(const std::vector<std::string>& scene) {
  if (std::find(scene.begin(), scene.end(), "") != scene.end())
    throw Error("SCENE", "a name is empty", "name mesh files, a scene file or a built-in scene");
}

std::optional<std::uint64_t> seed_of(const std::vector<std::string>& scene) {
  return scene.size() == 1 ? builtin_seed(scene[0]) : std::nullopt;
}

double parse_clearance(const std::string& text) {
  RunOptions options;
  take_option("clearance", text, options);
  return options.clearance;
}

void make_self(Scene& scene) {
  for (Object& object : scene.objects) object.self = true;
}

std::string missed(const Record& record) {
  return fmt::format("{} culled pairs that collide: {}", describe(record.options),
                     grouped(record.verification->false_negatives));
}

std::string device_of(const Text& device) {
  if (device && device->empty())
    throw Error("--device", "its value is empty", "give native, software, hardware or a number");
  return device.value_or("");
}

void write_json(const nlohmann::ordered_json& json, const std::string& path) {
  write_output(path, json.dump(2) + "\n");
}

}  // namespace farcull
