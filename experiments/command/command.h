// The commands of the program, and what several commands share: options, files, outputs, progress.
// Each add_...() declares the options of a command and returns the Command. Only command.cpp and
// cli.cpp include <CLI/CLI.hpp>, which takes seconds to compile.
#pragma once

#include <cstdint>
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
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"
#include "verify/certificate/certificate.h"

namespace CLI {
class App;
}  // namespace CLI

namespace farcull {

/// Runs the command line of farcull. Returns the exit status: 0 done; 1 a guarantee is broken; 2
/// the input, the environment or a device has a fault.
int command_line(int argc, char** argv);

using Text = std::optional<std::string>;  // value of an option; nullopt if it was not given

enum class Need : std::uint8_t { may, must };

/// An option, or an argument if the name has no dashes. Parsing the command line sets `value`. An
/// option with bool* is a flag. `type` stands for the value in the help.
struct OptionRow {
  std::string name;
  std::variant<bool*, Text*, std::string*, std::uint64_t*, std::vector<std::string>*> value;
  const char* type = "";
  std::string help;
  Need need = Need::may;
  const char* group = "";  // heading of the option in the help; empty: the common heading
};
using Rows = std::vector<OptionRow>;
inline Rows operator+(Rows first, const Rows& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

/// The text at the end of a help. A function is called when the help is printed.
using Footer = std::variant<const char*, std::string, std::function<std::string()>>;

/// Declares a subcommand of `parent`, a command or the program. The subcommand lives as long as
/// `parent`.
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title,
                      const Rows& options, const Footer& footer);
/// Allows at most one of the subcommands of this command.
void allow_one_command(CLI::App& command);
/// True if the parsed command line names this command.
bool given(const CLI::App& command);

/// An option as the help shows it, or an argument if `names` is empty.
struct DeclaredOption {
  std::vector<std::string> names;  // with their dashes, as in "-o", "--out"
  std::string type;                // the word for the value in the help; empty for a flag
  bool flag = false;
};
/// A declared command with all its subcommands.
struct DeclaredCommand {
  std::string name;  // with the names of its parents, as in "farcull experiment all"
  std::vector<DeclaredOption> options;    // in the order of the help
  std::vector<DeclaredOption> arguments;  // in the order of the command line
  std::vector<DeclaredCommand> commands;
};
/// parents: the names of the commands above `app`.
DeclaredCommand declared(const CLI::App& app, const std::string& parents = "");
/// Returns the text of --help for the command with these names, or for the program if there are no
/// names. Returns "" if there is no such command.
std::string help_of(const CLI::App& app, const std::vector<std::string>& names);

/// A topic of `farcull help`: a file of docs/help.
struct HelpTopic {
  const char* name;   // one word
  const char* title;  // one line
  const char* text;   // ends with a newline
};
std::span<const HelpTopic> help_topics();

/// A declared command. run() executes it and returns the exit status. It throws Error for bad
/// arguments.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

/// Makes a Command from a class that has its options as members, and add_to() and run().
template <class Class, class... Arguments>
Command declare(CLI::App& parent, const Arguments&... arguments) {
  const auto command = std::make_shared<Class>(arguments...);
  return {command->add_to(parent), [command] { return command->run(); }};
}

// The commands of the program. The --help of a command says what exit status 1 means.
Command add_run(CLI::App& app);
Command add_verify(CLI::App& app);
Command add_plan(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_distance(CLI::App& app);
Command add_clash(CLI::App& app);
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

// A command of `farcull experiment`. Exit status 1: there was a violation with the budget radius or
// a larger radius.
Command add_lemma(CLI::App& experiment);

inline constexpr const char* kResultsFolder = "farcull-results";

// ---- options, files, outputs and progress ----

inline constexpr const char* kVersion = "farcull 0.1";
inline constexpr int kExitDone = 0, kExitBroken = 1, kExitBad = 2;  // exit statuses

/// A file as the command line names it.
struct NamedFile {
  std::string by;    // the option or argument: "--json", "SCENE"
  std::string path;  // "-": standard output
};

/// Returns one path per frame if there is a range and the path has a place for a number. Otherwise
/// returns the path alone.
std::vector<std::string> numbered_files(const std::string& path,
                                        const std::optional<FrameRange>& range);

/// Returns the files that load_scene() reads for these arguments or, with a range, FrameSource:
/// - the scene file and its meshes, or the mesh files; for a numbered file, one file per frame;
/// - the meshes of mesh_folder() if a built-in scene needs them, or if there are no arguments (then
/// for all built-in scenes).
/// NamedFile::by is SCENE. A file that cannot be read is no error here.
std::vector<NamedFile> scene_files(const std::vector<std::string>& arguments,
                                   const std::optional<FrameRange>& range = {});

/// Throws Error, which names the two options, if an output is one of the inputs. Files are compared
/// by device and inode, with links followed.
void require_not_read(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// Calls require_not_read(). Also throws Error if two outputs are one file, even a file that does
/// not exist yet. The file behind standard output counts as an output. A terminal, /dev/null or
/// another file that is not regular may be an output several times, but "-" only once.
void require_apart(const std::vector<NamedFile>& inputs, std::vector<NamedFile> outputs);

/// Writes text for people to standard output, with its long lines wrapped (text_table.h).
void print(const std::string& text);

/// Prints a failure on standard error as one paragraph. Lines after the first are indented by nine
/// blanks. Replaces control characters, which paths may have.
void complain(const std::string& message);

/// Prints each line of take_reading_notes() once on standard error.
void say_notes();

/// Calls load_scene() and say_notes(), and make_self() if `self` is set.
Scene read_scene(const SceneArguments& arguments, bool self = false);
/// Returns a function that reads the scene part by part (stream_scene()), and calls say_notes(),
/// and make_self() if `self` is set, for each part. The arguments must outlive the function.
std::function<std::vector<ObjectPair>(const TakePart&)> scene_in_parts(
    const SceneArguments& arguments, bool self);

/// Prints a broken guarantee as complain() does, but in red on a terminal.
void complain_broken(const std::string& message);

/// Throws Error if there is nothing to test, since 0 pairs would look like a scene without
/// collisions. command: a command line that tests an object against itself.
void require_pairs(const NothingToTest& nothing, const std::string& command);
/// Throws Error if no pair of objects is left to test: the scene has two objects or more, tests
/// none against itself, and `ignored` and scene.ignored together hold all pairs. ignored: a result
/// of in_order().
void require_asked(const Scene& scene, const std::vector<ObjectPair>& ignored);
/// Returns the command followed by the words of a scene, quoted for a shell.
std::string command_with(const std::string& command, const SceneArguments& scene);

/// One line on standard error that each update overwrites. Nothing is printed without a terminal.
class TerminalProgress {
 public:
  /// first: text that is shown at once.
  Progress callback(const char* first = nullptr);
  void clear();
  TerminalProgress() = default;
  ~TerminalProgress() { clear(); }
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

 private:
  void show(std::string line);

  bool shown_ = false;
};

/// The outputs of a command besides the table.
struct Outputs {
  Text json = {};
  Text pairs = {};
  Text certificate = {};
  Text csv = {};
  Text picture = {};  // -o
  Text page = {};     // --html
  Text figure = {};   // --figure

  bool to_stdout() const;
};

/// Checks the outputs of a command that reads `inputs`, and returns them. Throws Error for what is
/// known to fail before the command runs: bad paths, and what require_apart() or check_output()
/// refuses. With frames there is one certificate per frame, so its path must have a place for a
/// number. Without frames, the path must have no such place.
Outputs checked(Outputs outputs, const std::vector<NamedFile>& inputs,
                const std::optional<FrameRange>& frames = {});

/// Reads a number from `least` to `most`. For any other text, throws Error naming the option, with
/// the reason "'TEXT' is WHAT".
template <class Value>
Value number_of(const char* option, const std::string& text, const std::string& what, Value least,
                Value most, const std::string& remedy) {
  const std::optional<Value> value = parse_number<Value>(text);
  if (value && *value >= least && *value <= most) return *value;
  throw Error(option, "'" + text + "' is " + what, remedy);
}
/// Returns the index of the text in `words`; 0 if the option was not given. Throws Error as
/// number_of() does if `words` does not contain the text.
std::size_t word_of(const char* option, const Text& text, const std::vector<std::string>& words,
                    const std::string& what, const std::string& remedy);
/// Throws Error if any of the options was given. The error names the first of the given options.
void refuse_given(const std::vector<std::pair<const char*, bool>>& options,
                  const std::string& reason, const std::string& remedy);

/// Throws Error if a name of the scene is empty.
void check_scene(const std::vector<std::string>& scene);
/// Returns the seed if the scene is a random built-in scene.
std::optional<std::uint64_t> seed_of(const std::vector<std::string>& scene);

/// The options of the methods on a command line. run_options() is the table of these options.
class MethodOptions {
 public:
  /// Returns rows for the named options, in the order of the table. If there are no names, returns
  /// rows for all options.
  Rows rows(const std::vector<std::string>& names = {});
  GivenOptions given() const;
  const Text& text(const std::string& name) const { return texts_.at(name); }
  bool has(const std::string& name) const { return texts_.at(name) || flags_.at(name); }

 private:
  // One entry per option of the table. The addresses must not change, since rows point at entries.
  std::map<std::string, Text> texts_;
  std::map<std::string, bool> flags_;
};

/// Reads a distance in world units. Throws Error naming --clearance.
double parse_clearance(const std::string& text);
/// Implements --self: every object of the scene is tested against itself.
void make_self(Scene& scene);

/// Returns a text for complain(): the guarantee that the run broke.
std::string missed(const Record& record);

/// Returns the value of --device; empty if it was not given. Throws Error if "" was given.
std::string device_of(const Text& device);

void write_json(const nlohmann::ordered_json& json, const std::string& path);

OptionRow ignore_row(Text& ignore);

std::string help_of_option(const std::string& name);
inline constexpr const char* kSceneHelp =
    "mesh files (.obj .off .ply .stl, also .obj.gz and\n"
    "so on), each an object;\n"
    "or one scene file (.json: farcull help scene-file); or\n"
    "one built-in scene (farcull scenes lists them)";
Rows scene_rows(SceneArguments& scene, const char* name = "SCENE",
                const std::string& help = kSceneHelp, Need need = Need::must);
inline constexpr const char* kNoRiskHelp =
    "of far: do not count the pairs at risk, which are lost\n"
    "at 0.9 of the radius, or without a ball. That takes two\n"
    "more runs, in all up to five times the time of drawing";
inline constexpr const char* kJsonHelp =
    "write the record as JSON to this file; - for standard\n"
    "output, without the table";

// `farcull check`: checks a certificate, or a list of pairs, against its scene.

struct CheckArguments {
  std::string certificate;  // a path, with a place for a number if there are frames; "": none
  SceneArguments scene;
  std::string json = {};   // a path; "": none; "-": standard output, in place of the text
  bool self = false;       // every object is tested against itself, as by run --self
  std::string pairs = {};  // the path of a list that `farcull run --pairs` wrote; "": none
  std::optional<double> clearance = {};  // must be the certificate's clearance, if any
  std::optional<FrameRange> frames = {};
  std::optional<FrameRange> tiles = {};  // the numbers of the tiles
  bool verified = false;                 // true: calls check_again()
};

/// Prints a verdict for each frame or tile, and one for all. Returns 0 if the certificate or the
/// list is proved, else 1. Throws Error if a file cannot be read, and if only one of list and
/// arguments has frames. Precondition: a certificate or a list is given.
int run_check(const CheckArguments& arguments);

constexpr std::uint64_t kMaxCheckedBytes = std::uint64_t{4} << 30;

Certificate read_certificate(const std::string& path);

/// Replaces characters that a terminal cannot show, line by line.
std::string clean_lines(const std::string& text);

/// Is called with each word of a scene: the words that scene_hash() hashes, in the same order.
using TakeWord = std::function<void(std::uint64_t)>;

/// Runs `farcull-check-verified`, the checker that is proved in Coq (verify/certificate/coq), on
/// the certificates and the scene. This program is in the folder of farcull or in the PATH. Prints
/// the SHA-256 sums of the files, then the checker's output: the same sums and a verdict. words:
/// calls its argument with each word of the scene. status: the exit status of our own checker.
/// Throws Error if the proved checker cannot be run, or if its verdict differs.
void check_again(const CheckArguments& arguments, const std::vector<std::string>& files,
                 const std::function<void(const TakeWord&)>& words, int status);

/// Checks certificates of tiles one after the other. For each tile, reads the scene part by part
/// (scene_in_parts()) and keeps only triangles that meet the tile. whole: true if the files must be
/// all tiles of the scene, in their order. Prints the verdict. Returns the status of run_check().
int check_tiles(const CheckArguments& arguments, const std::vector<std::string>& files, bool whole);

/// give_words() calls take() with all words of a scene, give_coordinates() only with those of its
/// coordinates.
void give_words(const Scene& scene, const TakeWord& take);
void give_coordinates(const Scene& scene, const TakeWord& take);

class PictureCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// Writes the picture. Returns the exit status: 0 done; 1 a method with a guarantee missed a
  /// pair. Throws Error for bad arguments.
  int run() const;
  /// Returns the parsed and checked options, without the paths of outputs.
  PictureArguments arguments() const;

 private:
  PageArguments page_arguments(const PictureArguments& picture) const;

  SceneArguments scene_;
  Text method_, compare_, resolution_, radius_, offset_, depth_, device_, frame_, frames_, view_,
      up_, size_, output_, html_, resolutions_;
  bool self_ = false, zoom_ = false;
};

/// Returns a line for each of these objects that is not closed but would be closed with --weld. The
/// line names the tolerance. Returns at most three lines, and none if the objects together have
/// more than 4 million triangles.
std::string weld_lines(const Scene& scene, const std::vector<std::uint32_t>& objects);

}  // namespace farcull
