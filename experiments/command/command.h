// The commands of the program, and functions that several commands use: for options, files, outputs
// and progress. Each add_...() declares a command's options and returns the Command. Only
// command.cpp and cli.cpp include <CLI/CLI.hpp>, which takes seconds to compile.
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

/// An option, or a positional argument if the name has no dashes. Parsing writes to the variable
/// that `value` points to. A bool* makes the option a flag. The help shows `type` for the value.
struct OptionRow {
  std::string name;
  std::variant<bool*, Text*, std::string*, std::uint64_t*, std::vector<std::string>*> value;
  const char* type = "";
  std::string help;
  Need need = Need::may;
  const char* group = "";  // heading above the option in the help; "": the default
};
using Rows = std::vector<OptionRow>;
inline Rows operator+(Rows first, const Rows& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

/// The text at the end of a command's help, or a function that returns this text.
using Footer = std::variant<const char*, std::string, std::function<std::string()>>;

/// Declares a subcommand of `parent`, which is the program or a command. `parent` owns the
/// subcommand.
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title,
                      const Rows& options, const Footer& footer);
/// Allows at most one subcommand of this command on a command line.
void allow_one_command(CLI::App& command);
/// True if the parsed command line names this command.
bool given(const CLI::App& command);

/// An option as the help shows it, or a positional argument if `names` is empty.
struct DeclaredOption {
  std::vector<std::string> names;  // with their dashes, as in "-o", "--out"
  std::string type;                // the help shows this word for the value; empty for a flag
  bool flag = false;
};
/// A declared command with all its subcommands.
struct DeclaredCommand {
  std::string name;  // with the names of its parents, as in "farcull experiment all"
  std::vector<DeclaredOption> options;    // in the order of the help
  std::vector<DeclaredOption> arguments;  // in the order of the command line
  std::vector<DeclaredCommand> commands;
};
/// Describes `app` and its subcommands. parents: names of the commands above `app`.
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

/// Makes a Command from a class with the member functions add_to() and run().
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

// Declares `farcull experiment lemma`. Exit status 1: a lemma is violated, although the radius is
// at least the budget radius.
Command add_lemma(CLI::App& experiment);

inline constexpr const char* kResultsFolder = "farcull-results";

// ---- options, files, outputs and progress ----

inline constexpr const char* kVersion = "farcull 0.1";
inline constexpr int kExitDone = 0, kExitBroken = 1, kExitBad = 2;

/// A file that the command line names.
struct NamedFile {
  std::string by;    // the option or argument: "--json", "SCENE"
  std::string path;  // "-": standard output
};

/// Returns one path per frame if there is a range and the path has a place for a number. Otherwise
/// returns the path alone.
std::vector<std::string> numbered_files(const std::string& path,
                                        const std::optional<FrameRange>& range);

/// Returns the files that load_scene() reads for these arguments (with a range, FrameSource):
/// - the scene file and its meshes, or the mesh files; for a numbered file, one file per frame;
/// - the meshes in mesh_folder(), if there are no arguments or if a built-in scene needs these
/// meshes.
/// NamedFile::by is SCENE. Unreadable files are no error here.
std::vector<NamedFile> scene_files(const std::vector<std::string>& arguments,
                                   const std::optional<FrameRange>& range = {});

/// Throws an Error that names both options if an output file is also an input file. Files are
/// compared by device and inode, with links followed.
void require_not_read(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// Calls require_not_read(). Also throws Error if two outputs are the same file, even if the file
/// does not exist yet. Standard output counts as an output. Several outputs may go to a file that
/// is not regular, such as a terminal or /dev/null, but "-" may be given only once.
void require_apart(const std::vector<NamedFile>& inputs, std::vector<NamedFile> outputs);

/// Prints text on standard output, with long lines wrapped (text_table.h).
void print(const std::string& text);

/// Prints a message on standard error as one paragraph. Lines after the first are indented by nine
/// blanks. Control characters, which a path may contain, are replaced.
void complain(const std::string& message);

/// Prints the notes of take_reading_notes() on standard error, except notes printed before.
void say_notes();

/// Calls load_scene() and say_notes(). If `self` is true, also calls make_self().
Scene read_scene(const SceneArguments& arguments, bool self = false);
/// Returns a function that reads the scene part by part (stream_scene()). For each part it calls
/// say_notes(), and make_self() if `self` is true. The arguments must outlive the function.
std::function<std::vector<ObjectPair>(const TakePart&)> scene_in_parts(
    const SceneArguments& arguments, bool self);

/// Prints a broken guarantee as complain() does, but in red on a terminal.
void complain_broken(const std::string& message);

/// Throws Error if there is nothing to test, since 0 pairs would look like a scene without
/// collisions. command: a command line that tests an object against itself.
void require_pairs(const NothingToTest& nothing, const std::string& command);
/// Throws Error if no pair of objects is left to test: the scene has two objects or more, no object
/// is tested against itself, and `ignored` and scene.ignored together hold all pairs. ignored: a
/// result of in_order().
void require_asked(const Scene& scene, const std::vector<ObjectPair>& ignored);
/// Returns the command followed by the arguments of the scene, quoted for a shell.
std::string command_with(const std::string& command, const SceneArguments& scene);

/// One line on standard error, which each step overwrites. Prints nothing without a terminal.
class TerminalProgress {
 public:
  /// Returns a function that shows a step; null without a terminal. first: text shown at once.
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

/// The paths of a command's outputs, besides the printed table. "-": standard output.
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

/// Checks the outputs of a command that reads `inputs`, and returns the outputs. Throws Error for
/// bad paths, and for paths that require_apart() or check_output() refuses. With frames, there is
/// one certificate per frame, so the path of the certificate must have a place for a number.
/// Without frames, this path must have no place for a number.
Outputs checked(Outputs outputs, const std::vector<NamedFile>& inputs,
                const std::optional<FrameRange>& frames = {});

/// Parses a number from `least` to `most`, both included. Throws Error for any other text: the
/// error names the option, and the reason is "'TEXT' is WHAT".
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

/// Throws Error if an argument that names the scene is empty.
void check_scene(const std::vector<std::string>& scene);
/// Returns the seed of a random built-in scene; nullopt for any other scene.
std::optional<std::uint64_t> seed_of(const std::vector<std::string>& scene);

/// Options of methods on a command line, and their values. run_options() lists these options.
class MethodOptions {
 public:
  /// Returns rows for the named options, in the order of run_options(). Without names, returns rows
  /// for all options.
  Rows rows(const std::vector<std::string>& names = {});
  GivenOptions given() const;
  const Text& text(const std::string& name) const { return texts_.at(name); }
  bool has(const std::string& name) const { return texts_.at(name) || flags_.at(name); }

 private:
  // One entry per option of run_options(). Entries must not move: rows() returns pointers to them.
  std::map<std::string, Text> texts_;
  std::map<std::string, bool> flags_;
};

/// Reads a distance in world units. Throws Error naming --clearance.
double parse_clearance(const std::string& text);
/// Implements --self: every object of the scene is tested against itself.
void make_self(Scene& scene);

/// Returns a message for complain(): how many colliding pairs the run culled.
std::string missed(const Record& record);

/// Returns the value of --device, or "" without this option. Throws Error if the value is empty.
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

// `farcull check` checks a certificate or a list of pairs against the scene.

struct CheckArguments {
  std::string certificate;  // a path, with a place for the number of a frame or tile; "": none
  SceneArguments scene;
  std::string json = {};   // a path; "": none; "-": standard output, instead of the text
  bool self = false;       // every object is tested against itself, as by run --self
  std::string pairs = {};  // the path of a list that `farcull run --pairs` wrote; "": none
  std::optional<double> clearance = {};  // world units; must equal the certificate's clearance
  std::optional<FrameRange> frames = {};
  std::optional<FrameRange> tiles = {};  // from 1 to the number of tiles
  bool verified = false;                 // true: also calls check_again()
};

/// Prints a verdict for each frame or tile, and one for all. Returns 0 if the certificate or the
/// list is proved, else 1. Throws Error if a file cannot be read, or if only one of the list and
/// the arguments has frames. Precondition: a certificate or a list is given.
int run_check(const CheckArguments& arguments);

constexpr std::uint64_t kMaxCheckedBytes = std::uint64_t{4} << 30;

Certificate read_certificate(const std::string& path);

/// Replaces characters that a terminal cannot show, line by line.
std::string clean_lines(const std::string& text);

/// A function that receives the 64-bit words of a scene, in the order in which scene_hash() hashes.
using TakeWord = std::function<void(std::uint64_t)>;

/// Runs `farcull-check-verified`, the checker that is proved in Coq (verify/certificate/coq), on
/// the certificates and the scene. This program is in the folder of farcull or in the PATH. Prints
/// the SHA-256 sums of the files, then the output of the proved checker: the same sums and a
/// verdict. words: calls its argument with each word of the scene. status: the exit status of our
/// own checker. Throws Error if the proved checker cannot run, or if the two checkers disagree.
void check_again(const CheckArguments& arguments, const std::vector<std::string>& files,
                 const std::function<void(const TakeWord&)>& words, int status);

/// Checks certificates of tiles one after the other. For each tile, reads the scene part by part
/// (scene_in_parts()) and keeps only triangles that meet the tile. whole: true if the files must be
/// all tiles of the scene, in their order. Prints the verdict. Returns the status of run_check().
int check_tiles(const CheckArguments& arguments, const std::vector<std::string>& files, bool whole);

/// give_words() calls take() with each word of a scene. give_coordinates() calls take() only with
/// the words of coordinates.
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
