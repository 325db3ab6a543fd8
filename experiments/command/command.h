// The commands of the program, and what they declare: each names its options, and is run by what it
// gives back. Commands include this in place of <CLI/CLI.hpp>, which takes seconds of every file
// that includes it: only command.cpp, cli.cpp and compare_main.cpp do.
//
// And options, files, outputs and progress that several commands share.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/cull/cull.h"
#include "experiments/method/run.h"
#include "experiments/picture/picture.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/scene_file.h"

namespace CLI {
class App;
}  // namespace CLI

namespace farcull {

/// The command line of farcull. Exit status: 0 done; 1 a guarantee is broken; 2 bad input or
/// environment, a device error included.
int command_line(int argc, char** argv);

using Text = std::optional<std::string>;  // of an option; empty where it was not given

/// An option whose value may be left out.
struct BareOption {
  bool given = false;
  std::string value;
};

enum class Need : std::uint8_t { may, must };

/// An option, or an argument where the name has no dashes. `value` is written when the command line
/// is parsed; that of a bool is a flag without a value. `type` stands for the value in the help.
struct OptionRow {
  const char* name;
  std::variant<bool*, Text*, std::string*, std::uint64_t*, std::vector<std::string>*, BareOption*>
      value;
  const char* type = "";
  std::string help;
  Need need = Need::may;
};
using Rows = std::vector<OptionRow>;
inline Rows operator+(Rows first, const Rows& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

/// The end of a help; a function is called when the help is printed.
using Footer = std::variant<const char*, std::string, std::function<std::string()>>;

/// Declares a command below another one, or below the program. It lives as long as `parent`.
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title,
                      const Rows& options, const Footer& footer);
/// At most one of the commands below this one may be given.
void allow_one_command(CLI::App& command);
/// Whether the parsed command line has this.
bool given(const CLI::App& command);

/// An option, or an argument where `names` is empty, as the help shows it.
struct DeclaredOption {
  std::vector<std::string> names;  // with their dashes, as in "-o", "--out"
  std::string type;  // stands for the value; empty for a flag. The name of an argument
  std::string help;  // lines as in the help
  bool flag = false;
  bool bare = false;      // its value may be left out
  bool many = false;      // an argument that may be given several times
  bool required = false;  // an argument that has to be given
};
/// A command as it was declared, with all below it: completion and the manual are made of this.
struct DeclaredCommand {
  std::string name;  // with those of its parents, as in "farcull experiment all"
  std::string title;
  std::string footer;
  std::vector<DeclaredOption> options;    // in the order of the help
  std::vector<DeclaredOption> arguments;  // in their order
  std::vector<DeclaredCommand> commands;
};
DeclaredCommand declared(const CLI::App& app);
/// What --help prints for the program (no names), a command of it, or a command below that one.
/// Empty where there is no such command.
std::string help_of(const CLI::App& app, const std::vector<std::string>& names);

/// A topic of `farcull help`: a file of docs/help.
struct HelpTopic {
  const char* name;   // one word
  const char* title;  // one line
  const char* text;   // ends with a newline
};
std::span<const HelpTopic> help_topics();
/// "terms: the words of the tables", a line for each topic, indented.
std::string help_topics_text();

/// A command that is declared. run() gives the exit status, and throws Error where the arguments
/// are bad.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

/// A command whose options are members of a class with add_to() and run().
template <class Class, class... Arguments>
Command declare(CLI::App& parent, const Arguments&... arguments) {
  const auto command = std::make_shared<Class>(arguments...);
  return {command->add_to(parent), [command] { return command->run(); }};
}

// Below the program, by exit status: 1 of run, verify and compare: a guarantee is broken. bench:
// two contestants disagree. distance: the accounting found a nearer pair or a wrong answer, or the
// reliable diagram lost a nearest object. doctor: an assumption does not hold on the device. check:
// refuted, or not proved. picture, report: a promise is broken.
Command add_run(CLI::App& app);
Command add_verify(CLI::App& app);
Command add_plan(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_distance(CLI::App& app);
Command add_bench(CLI::App& app);
Command add_doctor(CLI::App& app);
Command add_check(CLI::App& app);
Command add_experiment(CLI::App& app);
Command add_merge(CLI::App& app);
Command add_picture(CLI::App& app);
Command add_report(CLI::App& app);
Command add_scenes(CLI::App& app);
Command add_suite(CLI::App& app);
Command add_help(CLI::App& app);
Command add_completion(CLI::App& app);
Command add_manual(CLI::App& app);

// Below `farcull experiment`. 1 of lemma: a violation at the budget radius or beyond.
Command add_lemma(CLI::App& experiment);
/// A command for each study, and `all`: 1 where a method that promises missed, 2 where a point
/// could not be measured.
std::vector<Command> add_studies(CLI::App& experiment);

/// The folder of results unless --out says otherwise; `farcull report` reads it.
inline constexpr const char* kResultsFolder = "farcull-results";

}  // namespace farcull

namespace farcull {

// ---- options, files, outputs and progress ----

inline constexpr const char* kVersion = "farcull 0.1";
inline constexpr int kExitDone = 0, kExitBroken = 1, kExitBad = 2;  // exit statuses

/// A file as the command line names it.
struct NamedFile {
  std::string by;    // the option or argument: "--json", "SCENE"
  std::string path;  // "-": standard output
};

/// The files of a path: with a range one for each frame where the path has a number, else itself.
std::vector<std::string> numbered_files(const std::string& path,
                                        const std::optional<FrameRange>& range);

/// The files that load_scene() and, with a range, FrameSource read for these arguments: the scene
/// file and the meshes that it names, or the mesh files, numbered ones for each frame; for a
/// built-in scene of packaged meshes, and for no arguments (all built-in scenes), the meshes of
/// mesh_folder(). By SCENE. Throws nothing where a file cannot be read: whoever reads the scene
/// says so.
std::vector<NamedFile> scene_files(const std::vector<std::string>& arguments,
                                   const std::optional<FrameRange>& range = {});

/// Throws Error naming both options where an output is one of the inputs: by device and inode,
/// links followed.
void require_not_read(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// The same for all outputs of a command, among which is standard output, wherever it goes; and
/// where two outputs are one file, which does not have to exist yet. Anything but a
/// regular file (a terminal, /dev/null) may be an output several times, but "-" only once.
void require_apart(const std::vector<NamedFile>& inputs, std::vector<NamedFile> outputs);

/// SCENE, which has to be given.
OptionRow scene_row(std::vector<std::string>& scene);

/// The one line of a failure, on standard error. A path may hold anything, so control characters do
/// not get through.
void complain(const std::string& message);

/// The same, in red on a terminal: a guarantee is broken.
void complain_broken(const std::string& message);

/// Two lines for people: why nothing was tested, and `command`, which tests it. Empty where
/// something was tested.
std::string nothing_note(const NothingToTest& nothing, const std::string& command);
/// A command with the words of a scene, as a shell takes it.
std::string command_with(const std::string& command, const std::vector<std::string>& scene);

/// One line on standard error that is written over, on a terminal only.
class TerminalProgress {
 public:
  Progress callback();
  void clear();
  TerminalProgress() = default;
  ~TerminalProgress() { clear(); }
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

 private:
  void show(std::string line);

  bool shown_ = false;
};

/// Where results go besides the table.
struct Outputs {
  Text json = {};
  Text pairs = {};
  Text certificate = {};
  Text csv = {};
  Text picture = {};  // -o
  Text page = {};     // --html

  bool to_stdout() const;
};

/// The outputs of a command that reads these files, or an Error for what can be known to go wrong
/// with them before anything is run: paths that are none, outputs that are inputs or one another
/// (require_apart()), what check_output() refuses. With frames a certificate is a file for each: it
/// has to have a number in its name, and without frames none.
Outputs checked(Outputs outputs, const std::vector<NamedFile>& inputs,
                const std::optional<FrameRange>& frames = {});

/// A number from `least` to `most`. Throws Error naming the option: "'TEXT' is WHAT".
template <class Value>
Value number_of(const char* option, const std::string& text, const std::string& what, Value least,
                Value most, const std::string& remedy) {
  const std::optional<Value> value = parse_number<Value>(text);
  if (value && *value >= least && *value <= most) return *value;
  throw Error(option, "'" + text + "' is " + what, remedy);
}
/// Which of the words the text is; 0 where it was not given. Throws Error as number_of() does.
std::size_t word_of(const char* option, const Text& text, const std::vector<std::string>& words,
                    const std::string& what, const std::string& remedy);
/// Throws Error naming the first option that was given.
void refuse_given(const std::vector<std::pair<const char*, bool>>& options,
                  const std::string& reason, const std::string& remedy);

/// Throws Error where a name of the scene is empty.
void check_scene(const std::vector<std::string>& scene);
/// The seed of the scene, where it is a random built-in one.
std::optional<std::uint64_t> seed_of(const std::vector<std::string>& scene);

/// Options of the methods on a command line, as the table has them (experiments/method/options.h).
class MethodOptions {
 public:
  /// Options of the table, in its order: those of these names, all where none is named.
  Rows rows(const std::vector<std::string>& names = {});
  /// Those that were given.
  GivenOptions given() const;
  /// The value that was given, and whether one was.
  const Text& text(const std::string& name) const { return texts_.at(name); }
  bool has(const std::string& name) const { return texts_.at(name) || flags_.at(name); }

 private:
  // Of every option of the table, at places that do not change.
  std::map<std::string, Text> texts_;
  std::map<std::string, bool> flags_;
  std::deque<std::string> words_;
};
/// Reads an option where its text was given.
void take_given(const char* name, const Text& text, RunOptions& options);

/// A distance in world units. Throws Error naming --clearance.
double parse_clearance(const std::string& text);
/// --self: every object of the scene is tested against itself.
void make_self(Scene& scene);

/// The guarantee that `record` broke, for complain().
std::string missed(const Record& record);

/// Empty where none is asked for. Throws Error where the value is none.
std::string device_of(const Text& device);

void write_json(const nlohmann::ordered_json& json, const std::string& path);

/// The help of an option of the table.
std::string help_of_option(const std::string& name);
inline constexpr const char* kFacesHelp =
    "with --pairs: two more columns, face_a and face_b, the\n"
    "faces of the mesh files (see farcull help pairs)";
inline constexpr const char* kSceneHelp =
    "mesh files (.obj .off .ply .stl, also .obj.gz and\n"
    "so on), each an object;\n"
    "or one scene file (.json: farcull help scene-file); or\n"
    "one built-in scene (farcull scenes lists them)";
inline constexpr const char* kJsonHelp =
    "write the record as JSON to this file; - for standard\n"
    "output, without the table";

// `farcull check`: a certificate, or a list of pairs, against the scene that it speaks about.

struct CheckArguments {
  std::string certificate;         // a file, of frames with a number; "": `pairs` is checked alone
  std::vector<std::string> scene;  // as of `farcull run`
  std::string json = {};           // "" for none, "-" for standard output instead of the text
  bool self = false;               // every object is tested against itself, as by run --self
  std::string pairs = {};          // "" for none, or a list as `farcull run --pairs` writes it
  std::optional<double> clearance = {};  // of the list; of a certificate it has to be the same
  std::optional<FrameRange> frames = {};
};

/// Prints the verdict, of frames one for each and one in all. 0: proved, and the list that is given
/// is the one that is proved; 1: refuted or not proved. Throws Error where the certificate, the
/// scene or the list cannot be read, and where the list is of frames and none are named, or the
/// contrary.
int run_check(const CheckArguments& arguments);

// ---- `farcull picture` ----

class PictureCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 done, 1 a method that promises missed a pair (the picture is there then).
  /// Throws Error where the arguments are bad.
  int run() const;
  /// The parsed options, checked; all but the paths of the files.
  PictureArguments arguments() const;
  /// The contents of the page of --html, from the arguments of its flat picture.
  PageArguments page_arguments(const PictureArguments& picture) const;

 private:
  /// The options that all panels share.
  RunOptions usual_options() const;

  std::vector<std::string> scene_;
  Text method_, compare_, resolution_, radius_, offset_, depth_, device_, frame_, frames_, view_,
      up_, size_, output_, html_, resolutions_;
  BareOption depth_view_;
  bool self_ = false, zoom_ = false;
};

}  // namespace farcull
