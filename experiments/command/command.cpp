// Declares options with CLI11, for all commands. Checks values and output paths before a command
// runs. A file is identified by device and inode, with links followed. A file that does not exist
// yet is identified by its name and its folder's device and inode.
#include "experiments/command/command.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "experiments/record/stage_words.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {

// ---- functions that use CLI11, whose templates take seconds to compile ----

DeclaredCommand declared(const CLI::App& app, const std::string& parents) {
  DeclaredCommand out;
  out.name = parents.empty() ? app.get_name() : parents + " " + app.get_name();
  for (const CLI::Option* option : app.get_options()) {
    DeclaredOption one;
    for (const std::string& name : option->get_snames()) one.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) one.names.push_back("--" + name);
    one.flag = !option->get_positional() && option->get_items_expected_max() == 0;
    one.type = option->get_positional() ? option->get_name(true)
               : one.flag               ? ""
                                        : option->get_type_name();
    (option->get_positional() ? out.arguments : out.options).push_back(std::move(one));
  }
  for (const CLI::App* command : app.get_subcommands({}))
    out.commands.push_back(declared(*command, out.name));
  return out;
}

CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title,
                      const Rows& options, const Footer& footer) {
  CLI::App* command = parent.add_subcommand(name, title);
  for (const OptionRow& row : options) {
    CLI::Option* option = nullptr;
    std::visit(
        [&](auto* value) {
          using Value = std::decay_t<decltype(*value)>;
          if constexpr (std::is_same_v<Value, bool>) {
            option = command->add_flag(row.name, *value, row.help)->disable_flag_override();
          } else {
            option = command->add_option(row.name, *value, row.help);
          }
        },
        row.value);
    if (option->get_items_expected_max() > 0)
      option->type_name(row.type)->required(row.need == Need::must);
    if (*row.group != 0) option->group(row.group);
  }
  command->footer("");  // keeps CLI11 from appending the parent's footer
  std::visit([&](const auto& text) { command->footer(text); }, footer);
  return command;
}

void allow_one_command(CLI::App& command) { command.require_subcommand(0, 1); }

std::string help_of(const CLI::App& app, const std::vector<std::string>& names) {
  const CLI::App* command = &app;
  std::string before;
  for (const std::string& name : names) {
    const auto found =
        command->get_subcommands([&](const CLI::App* below) { return below->get_name() == name; });
    if (found.empty()) return "";
    before += (before.empty() ? "" : " ") + command->get_name();
    command = found.front();
  }
  // App::help() would describe the parsed command, which is `help`.
  return command->get_formatter()->make_help(
      command, before.empty() ? command->get_name() : before + " " + command->get_name(),
      CLI::AppFormatMode::Normal);
}

bool given(const CLI::App& command) { return command.parsed(); }

// ---- options and files ----

namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "standard output";

// Identifies a file. If the file does not exist yet, device and inode are those of its folder.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  std::string name;      // name of a missing file; empty if the file exists
  bool regular = false;  // true for a regular or a missing file
  auto operator<=>(const Identity&) const = default;
};

// Returns the path of the file that writing to `path` would create, with links to missing files
// followed. Follows at most kMostLinks links, as the system does.
fs::path made_by(fs::path path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;  // an absolute target replaces the path
  }
  return path;
}

std::optional<Identity> identity_of(const std::string& path) {
  struct stat status = {};
  const int found = path == "-" ? ::fstat(STDOUT_FILENO, &status) : ::stat(path.c_str(), &status);
  if (found == 0) return Identity{status.st_dev, status.st_ino, "", S_ISREG(status.st_mode)};
  if (path == "-") return std::nullopt;
  const fs::path file = made_by(path);
  const std::string folder = file.parent_path().empty() ? "." : file.parent_path().string();
  if (::stat(folder.c_str(), &status) != 0) return std::nullopt;
  return Identity{status.st_dev, status.st_ino, file.filename().string(), true};
}

std::string shown(const NamedFile& file) { return file.path == "-" ? kStandardOutput : file.path; }

std::string complaint(const std::string& message) {
  return wrapped("farcull: " + clean_name(message), text_columns(stderr), 9);
}

}  // namespace

Rows scene_rows(SceneArguments& scene, const char* name, const std::string& help, Need need) {
  return {{name, &scene.names, "", help, need},
          {"--weld", &scene.weld, "T",
           "merge vertices of a mesh that are at most T apart, in\nits units, or relative to the "
           "diagonal of its box, as in\n1e-7*size"},
          {"--format", &scene.format, "F",
           "of the mesh SCENE -, standard input: obj, off, ply or stl"}};
}

OptionRow ignore_row(Text& ignore) {
  return {"--ignore", &ignore, "LIST", help_of_option("ignore")};
}

Rows MethodOptions::rows(const std::vector<std::string>& names) {
  Rows out;
  for (const Option& option : run_options()) {
    Text& text = texts_[option.name];
    bool& flag = flags_[option.name];
    if (!names.empty() && std::ranges::find(names, option.name) == names.end()) continue;
    out.push_back({option_word(option.name), &text, option.type, spelled(option.help)});
    if (*option.type == 0) out.back().value = &flag;
    const auto draws_or_lacks = [&](Method method) {
      return draws(method) || !option.serves(traits(method));
    };
    if (std::ranges::all_of(all_methods(), draws_or_lacks))
      out.back().group = "Options of methods that draw";
  }
  return out;
}

GivenOptions MethodOptions::given() const {
  GivenOptions out;
  for (const Option& option : run_options()) {
    if (has(option.name)) out[option.name] = text(option.name).value_or("");
  }
  return out;
}

std::string help_of_option(const std::string& name) { return spelled(run_option(name).help); }

void print(const std::string& text) { write_output("-", wrapped(text)); }

void complain(const std::string& message) { std::fputs(complaint(message).c_str(), stderr); }

void say_notes() {
  static std::set<std::string> said;  // several frames may give the same note
  for (const std::string& note : take_reading_notes()) {
    if (said.insert(note).second) complain(note);
  }
}

Scene read_scene(const SceneArguments& arguments, bool self) {
  Scene scene = load_scene(arguments);
  say_notes();
  if (self) make_self(scene);
  return scene;
}

std::function<std::vector<ObjectPair>(const TakePart&)> scene_in_parts(
    const SceneArguments& arguments, bool self) {
  return [&arguments, self](const TakePart& take) {
    return stream_scene(arguments, [&](Scene& part) {
      if (self) make_self(part);
      take(part);
      say_notes();
    });
  };
}

void complain_broken(const std::string& message) {
  std::fputs(coloured(complaint(message), Colour::bad, STDERR_FILENO).c_str(), stderr);
}

std::string command_with(const std::string& command, const SceneArguments& scene) {
  std::string out = command;
  for (const std::string& word : scene.words()) out += " " + quoted(clean_name(word));
  return out;
}

void require_pairs(const NothingToTest& nothing, const std::string& command) {
  if (nothing.reason.empty()) return;
  throw Error("SCENE", "nothing to test: " + nothing.reason,
              nothing.with_self ? "name two objects or more, or test this one: " + command
                                : "name two objects or more");
}

void require_asked(const Scene& scene, const std::vector<ObjectPair>& ignored) {
  require_asked(scene, ignored, "SCENE", "test objects against themselves with --self");
}

Progress TerminalProgress::callback(const char* first) {
  const char* const terminal = std::getenv("TERM");
  if (!is_terminal(stderr) || terminal == nullptr || std::string_view(terminal) == "dumb")
    return {};
  if (first != nullptr) show(std::string(first) + " ...");
  return [this](const ProgressStep& step) { show(text_of(step) + " ..."); };
}

void TerminalProgress::clear() {
  if (std::exchange(shown_, false)) std::fputs("\r\033[K", stderr);
}

// Cuts the line to the width of the terminal, since \r cannot go back over a wrapped line.
void TerminalProgress::show(std::string line) {
  if (const unsigned columns = terminal_columns(stderr); columns > 1)
    line = line.substr(0, columns - 1);
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  shown_ = true;
}

std::vector<std::string> numbered_files(const std::string& path,
                                        const std::optional<FrameRange>& range) {
  if (!range || !is_numbered(path)) return {path};
  std::vector<std::string> out;
  for (long frame = range->first; frame <= range->last; ++frame)
    out.push_back(numbered(path, frame));
  return out;
}

std::vector<NamedFile> scene_files(const std::vector<std::string>& arguments,
                                   const std::optional<FrameRange>& range) {
  std::vector<NamedFile> out;
  const auto add = [&](const std::string& path) { out.push_back({"SCENE", path}); };
  const auto add_mesh = [&](const std::string& path) {
    for (const std::string& file : numbered_files(path, range)) add(file);
  };
  const auto add_packaged = [&] {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(mesh_folder(), error)) {
      if (has_mesh_extension(entry.path().string())) add(entry.path().string());
    }
  };
  if (arguments.empty()) add_packaged();
  for (const std::string& argument : arguments) {
    if (argument == "-") continue;  // standard input
    if (const BuiltinScene* const builtin = find_builtin_scene(argument)) {
      if (builtin->needs_meshes) add_packaged();
    } else if (is_scene_file(argument)) {
      add(argument);
      for (const std::string& mesh : meshes_of_scene_file(argument)) add_mesh(mesh);
    } else {
      add_mesh(argument);
    }
  }
  return out;
}

void require_not_read(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
  std::map<Identity, const NamedFile*> written;  // the first output to each file
  for (const NamedFile& output : outputs) {
    const std::optional<Identity> identity = identity_of(output.path);
    if (identity && identity->regular && identity->name.empty())
      written.try_emplace(*identity, &output);
  }
  if (written.empty()) return;
  for (const NamedFile& input : inputs) {
    const std::optional<Identity> read = identity_of(input.path);
    if (!read) continue;
    const auto found = written.find(*read);
    if (found == written.end()) continue;
    const NamedFile& output = *found->second;
    throw Error(output.by,
                shown(output) + " is " + input.path + ", which " + input.by +
                    " reads, and would be overwritten",
                "choose another place for " + output.by);
  }
}

void require_apart(const std::vector<NamedFile>& inputs, std::vector<NamedFile> outputs) {
  if (std::ranges::find(outputs, "-", &NamedFile::path) == outputs.end())
    outputs.insert(outputs.begin(), {kStandardOutput, "-"});
  std::map<Identity, const NamedFile*> files;
  const NamedFile* standard_output = nullptr;
  for (const NamedFile& output : outputs) {
    const std::optional<Identity> identity = identity_of(output.path);
    const NamedFile* other = nullptr;
    if (identity && identity->regular) {
      const auto [place, is_new] = files.try_emplace(*identity, &output);
      if (!is_new) other = place->second;
    }
    if (output.path == "-") {
      if (standard_output != nullptr) other = standard_output;
      standard_output = &output;
    }
    if (other == nullptr) continue;
    throw Error(output.by,
                shown(output) + " is " + shown(*other) + ", where " + other->by + " goes as well",
                "give each output a place of its own");
  }
  require_not_read(inputs, outputs);
}

bool Outputs::to_stdout() const {
  return json == "-" || pairs == "-" || certificate == "-" || csv == "-" || picture == "-";
}

Outputs checked(Outputs outputs, const std::vector<NamedFile>& inputs,
                const std::optional<FrameRange>& frames) {
  std::vector<NamedFile> files;
  std::vector<std::string> to_try;  // the first file of each output path
  for (const auto& [option, path, example] :
       {std::tuple("--json", &outputs.json, "result.json"),
        std::tuple("--pairs", &outputs.pairs, "result.csv"),
        std::tuple("--certificate", &outputs.certificate, "result.json"),
        std::tuple("--csv", &outputs.csv, "result.csv"),
        std::tuple("-o", &outputs.picture, "picture.png"),
        std::tuple("--html", &outputs.page, "page.html"),
        std::tuple("--figure", &outputs.figure, "figure.svg")}) {
    if (!*path) continue;
    // `/dev/stdout` counts as `-`, so that only one stream writes to standard output.
    if (**path == "/dev/stdout") *path = "-";
    if ((*path)->empty())
      throw Error(option, "the path is empty", "name a file, or - for standard output");
    // In `run a.off --json --pairs b.csv`, CLI11 takes `--pairs` for the value of --json.
    if ((*path)->starts_with("-") && **path != "-") {
      throw Error(option, "its value is missing before '" + **path + "'",
                  "name a file, with ./ before a name that begins with -");
    }
    // `run --json a.off b.off` would overwrite the mesh.
    if (has_mesh_extension(**path)) {
      throw Error(option, **path + " is named like a mesh and would be overwritten",
                  std::string("name the file to write first, as in ") + option + " " + example);
    }
    const bool certificate = path == &outputs.certificate;
    if (certificate && is_numbered(**path) != frames.has_value()) {
      if (frames) {
        throw Error(option, "'" + **path + "' has no place for the number of the frame",
                    "put %d or %04d there, as in certificate_%04d.json: each frame has a file of "
                    "its own");
      }
      throw Error(option, "'" + **path + "' has a place for the number of a frame",
                  "say which frames with --frames N or --frames FIRST:LAST, or name one file");
    }
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

std::size_t word_of(const char* option, const Text& text, const std::vector<std::string>& words,
                    const std::string& what, const std::string& remedy) {
  if (!text) return 0;
  const auto at = std::ranges::find(words, *text);
  if (at == words.end()) throw Error(option, "'" + *text + "' is " + what, remedy);
  return static_cast<std::size_t>(at - words.begin());
}

void refuse_given(const std::vector<std::pair<const char*, bool>>& options,
                  const std::string& reason, const std::string& remedy) {
  for (const auto& [option, given] : options) {
    if (given) throw Error(option, reason, remedy);
  }
}

void check_scene(const std::vector<std::string>& scene) {
  if (std::ranges::find(scene, "") != scene.end())
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
  return fmt::format("{} culled pairs that collide: {}",
                     describe(record.options, not_drawn_text(record)),
                     grouped(record.verification->false_negatives));
}

std::string device_of(const Text& device) {
  if (device && device->empty())
    throw Error("--device", "its value is empty", "give native, software, hardware or a number");
  return device.value_or("");
}

std::string weld_lines(const Scene& scene, const std::vector<std::uint32_t>& objects) {
  constexpr std::uint64_t kMostTriangles = 4'000'000;
  constexpr std::size_t kMostLines = 3;
  std::uint64_t triangles = 0;
  for (const std::uint32_t o : objects) triangles += scene.objects[o].triangle_count;
  if (triangles > kMostTriangles) return "";
  std::string out;
  std::size_t lines = 0;
  for (const std::uint32_t o : objects) {
    const std::optional<WeldHint> hint = weld_hint(scene, scene.objects[o]);
    if (!hint) continue;
    out += fmt::format(
        "hint       {} is not closed: {}, one of them at {:.6g} {:.6g} {:.6g}. Their ends nearly\n"
        "           coincide; --weld {:.0e}*size closes it\n",
        scene.objects[o].name, counted(hint->open_edges, "open edge", "open edges"),
        hint->place.x(), hint->place.y(), hint->place.z(), hint->tolerance);
    if (++lines == kMostLines) break;
  }
  return out;
}

void write_json(const nlohmann::ordered_json& json, const std::string& path) {
  write_output(path, json.dump(2) + "\n");
}

}  // namespace farcull
