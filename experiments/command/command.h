// The commands of the program. Each add_...() declares its options and returns a Command, whose
// run() executes it. Commands include this file and not <CLI/CLI.hpp>, which costs seconds of
// compile time per file: only command.cpp and cli.cpp include that.
//
// Also the options, files, outputs and progress that several commands share.
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

/// The command line of farcull. Exit status: 0 done; 1 a guarantee is broken; 2 bad input or
/// environment, a device error included.
int command_line(int argc, char** argv);

using Text = std::optional<std::string>;  // value of an option; empty if it was not given

enum class Need : std::uint8_t { may, must };

/// An option, or an argument if the name has no dashes. Parsing the command line writes `value`; a
/// bool is a flag without a value. `type` stands for the value in the help.
struct OptionRow {
  std::string name;
  std::variant<bool*, Text*, std::string*, std::uint64_t*, std::vector<std::string>*> value;
  const char* type = "";
  std::string help;
  Need need = Need::may;
  const char* group = "";  // heading above it in the help; empty: the common one
};
using Rows = std::vector<OptionRow>;
inline Rows operator+(Rows first, const Rows& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

/// The end of a help text; a function is called when the help is printed.
using Footer = std::variant<const char*, std::string, std::function<std::string()>>;

/// Declares a command below another one, or below the program. It lives as long as `parent`.
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title,
                      const Rows& options, const Footer& footer);
/// Allows at most one of the subcommands of this command.
void allow_one_command(CLI::App& command);
/// Whether the parsed command line names this command.
bool given(const CLI::App& command);

/// An option as the help shows it, or an argument if `names` is empty.
struct DeclaredOption {
  std::vector<std::string> names;  // with their dashes, as in "-o", "--out"
  std::string type;  // the word for the value, or an argument's name; empty for a flag
  bool flag = false;
};
/// A declared command with all its subcommands; completion is made from it.
struct DeclaredCommand {
  std::string name;  // with the names of its parents, as in "farcull experiment all"
  std::vector<DeclaredOption> options;    // in the order of the help
  std::vector<DeclaredOption> arguments;  // in the order of the command line
  std::vector<DeclaredCommand> commands;
};
/// parents: the names of the commands above it.
DeclaredCommand declared(const CLI::App& app, const std::string& parents = "");
/// The text that --help prints for the program (no names), a command, or a subcommand. Empty if
/// there is no such command.
std::string help_of(const CLI::App& app, const std::vector<std::string>& names);

/// A topic of `farcull help`: a file of docs/help.
struct HelpTopic {
  const char* name;   // one word
  const char* title;  // one line
  const char* text;   // ends with a newline
};
std::span<const HelpTopic> help_topics();

/// A declared command. run() returns the exit status and throws Error if the arguments are bad.
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

// The commands of the program. The --help of each says what exit status 1 means.
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

// A command of `farcull experiment`. Exit status 1: a violation at the budget radius or more.
Command add_lemma(CLI::App& experiment);

/// The folder of results unless --out says otherwise; `farcull report` reads it.
inline constexpr const char* kResultsFolder = "farcull-results";

// ---- options, files, outputs and progress ----

inline constexpr const char* kVersion = "farcull 0.1";
inline constexpr int kExitDone = 0, kExitBroken = 1, kExitBad = 2;  // exit statuses

/// A file as the command line names it.
struct NamedFile {
  std::string by;    // the option or argument: "--json", "SCENE"
  std::string path;  // "-": standard output
};

/// The file of a path; with a range and a place for a number in the path, one file per frame.
std::vector<std::string> numbered_files(const std::string& path,
                                        const std::optional<FrameRange>& range);

/// The files that load_scene() and, with a range, FrameSource read for these names: the scene
/// file and its meshes, or the mesh files, numbered ones once per frame. For a built-in scene of
/// packaged meshes, and for no arguments (all built-in scenes), the meshes of mesh_folder(). `by`
/// is SCENE. A file that cannot be read is no error here: reading the scene reports it.
std::vector<NamedFile> scene_files(const std::vector<std::string>& arguments,
                                   const std::optional<FrameRange>& range = {});

/// Throws Error naming both options if an output is one of the inputs. Files are compared by device
/// and inode, with links followed.
void require_not_read(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// As require_not_read(), and throws Error if two outputs are one file, which need not exist yet.
/// Standard output always counts as an output, wherever it goes. Anything but a regular file (a
/// terminal, /dev/null) may be an output several times, but "-" only once.
void require_apart(const std::vector<NamedFile>& inputs, std::vector<NamedFile> outputs);

/// Writes text for people to standard output, with its long lines wrapped (text_table.h).
void print(const std::string& text);

/// Prints a failure on standard error: one paragraph, indented by nine blanks from its second line
/// on. Replaces control characters, which paths may hold.
void complain(const std::string& message);

/// Prints what readers passed over (take_reading_notes()) on standard error, each line once.
void say_notes();

/// load_scene() and say_notes(); then make_self() if `self` is set.
Scene read_scene(const SceneArguments& arguments, bool self = false);
/// The same for stream_scene(), which gives the scene part by part. The arguments must outlive it.
std::function<std::vector<ObjectPair>(const TakePart&)> scene_in_parts(
    const SceneArguments& arguments, bool self);

/// As complain(), in red on a terminal: for a guarantee that is broken.
void complain_broken(const std::string& message);

/// Throws Error if there is nothing to test, since 0 pairs would look like a scene without
/// collisions. command: the one that tests an object against itself.
void require_pairs(const NothingToTest& nothing, const std::string& command);
/// Throws Error if the scene has two objects or more, tests none against itself, and all pairs of
/// objects are ignored, by `ignored` (as in_order() gives it) or by the scene.
void require_asked(const Scene& scene, const std::vector<ObjectPair>& ignored);
/// The command followed by the words of a scene, quoted for a shell.
std::string command_with(const std::string& command, const SceneArguments& scene);

/// One line on standard error that each update overwrites. Nothing is printed without a terminal.
class TerminalProgress {
 public:
  /// first: shown at once.
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

/// The outputs of a command that reads `inputs`. Throws Error for everything that can be known to
/// fail before the command runs: bad paths, outputs that are inputs or one another
/// (require_apart()), what check_output() refuses. With frames a certificate is one file per frame,
/// so its name must hold a number; without frames it must not.
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
/// The index of the text in `words`; 0 if it was not given. Throws Error as number_of() does.
std::size_t word_of(const char* option, const Text& text, const std::vector<std::string>& words,
                    const std::string& what, const std::string& remedy);
/// Throws Error naming the first option that was given.
void refuse_given(const std::vector<std::pair<const char*, bool>>& options,
                  const std::string& reason, const std::string& remedy);

/// Throws Error if a name of the scene is empty.
void check_scene(const std::vector<std::string>& scene);
/// The seed of the scene if it is a random built-in one.
std::optional<std::uint64_t> seed_of(const std::vector<std::string>& scene);

/// The options of the methods on a command line; experiments/method/options.h has their table.
class MethodOptions {
 public:
  /// Rows for the named options of the table, in its order; for all options if no names are given.
  Rows rows(const std::vector<std::string>& names = {});
  /// The options that were given.
  GivenOptions given() const;
  /// The value of an option, and whether it was given.
  const Text& text(const std::string& name) const { return texts_.at(name); }
  bool has(const std::string& name) const { return texts_.at(name) || flags_.at(name); }

 private:
  // One entry per option of the table. Rows point at them, so their addresses must not change.
  std::map<std::string, Text> texts_;
  std::map<std::string, bool> flags_;
};

/// Reads a distance in world units. Throws Error naming --clearance.
double parse_clearance(const std::string& text);
/// Implements --self: every object of the scene is tested against itself.
void make_self(Scene& scene);

/// Describes the guarantee that `record` broke, for complain().
std::string missed(const Record& record);

/// The value of --device; empty if it was not given. Throws Error if the value is empty.
std::string device_of(const Text& device);

void write_json(const nlohmann::ordered_json& json, const std::string& path);

OptionRow ignore_row(Text& ignore);

/// The help text of an option of the table.
std::string help_of_option(const std::string& name);
inline constexpr const char* kSceneHelp =
    "mesh files (.obj .off .ply .stl, also .obj.gz and\n"
    "so on), each an object;\n"
    "or one scene file (.json: farcull help scene-file); or\n"
    "one built-in scene (farcull scenes lists them)";
/// The argument that names a scene, and the options for reading its meshes.
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
  std::string certificate;  // a file, numbered for frames; "": only `pairs` is checked
  SceneArguments scene;
  std::string json = {};   // "" for none; "-": standard output, in place of the text
  bool self = false;       // every object is tested against itself, as by run --self
  std::string pairs = {};  // "" for none, or a list as `farcull run --pairs` writes it
  std::optional<double> clearance = {};  // of the list; a certificate must have the same
  std::optional<FrameRange> frames = {};
  std::optional<FrameRange> tiles = {};  // the numbers of the tiles in the name of the certificate
  bool verified = false;  // the proved checker must agree; goes with certificates of one scene
};

/// Precondition: a certificate or a list is given. Prints the verdict; with frames one verdict per
/// frame and one for all, and likewise with tiles. Returns 0 if proved, and if a given list is the
/// proved one; else 1. Throws Error if the certificate, the scene or the list cannot be read, and
/// if the list has frames but the arguments name none, or the reverse.
int run_check(const CheckArguments& arguments);

/// The largest certificate or list that is read.
constexpr std::uint64_t kMaxCheckedBytes = std::uint64_t{4} << 30;

Certificate read_certificate(const std::string& path);

/// Replaces what a terminal cannot show, line by line.
std::string clean_lines(const std::string& text);

/// Takes the words of a scene one after the other: those that scene_hash() hashes, in its order.
using TakeWord = std::function<void(std::uint64_t)>;

/// Gives the certificates and the scene to the checker that Coq has proved
/// (verify/certificate/coq): `farcull-check-verified`, which is in the folder of this program or in
/// the PATH. Prints the SHA-256 of the files as this program has them, then the output of the
/// checker: the same SHA-256, and its verdict. words: gives the words of the scene; status: the
/// result of this checker. Throws Error if the other one cannot be run, or if they do not agree
/// whether this is proved.
void check_again(const CheckArguments& arguments, const std::vector<std::string>& files,
                 const std::function<void(const TakeWord&)>& words, int status);

/// Checks certificates of tiles in turn, each with the triangles that meet its tile. So the memory
/// is that of the largest part of the scene and of one tile. whole: these must be all tiles, in
/// order. Prints the verdict and returns the exit status, as run_check().
int check_tiles(const CheckArguments& arguments, const std::vector<std::string>& files, bool whole);

/// Gives all words of a scene, or those of its coordinates alone.
void give_words(const Scene& scene, const TakeWord& take);
void give_coordinates(const Scene& scene, const TakeWord& take);

// ---- `farcull picture` ----

class PictureCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// Returns the exit status: 0 done; 1 a method with a guarantee missed a pair (the picture is
  /// written all the same). Throws Error if the arguments are bad.
  int run() const;
  /// The parsed and checked options, all but the paths of the files.
  PictureArguments arguments() const;

 private:
  PageArguments page_arguments(const PictureArguments& picture) const;

  SceneArguments scene_;
  Text method_, compare_, resolution_, radius_, offset_, depth_, device_, frame_, frames_, view_,
      up_, size_, output_, html_, resolutions_;
  bool self_ = false, zoom_ = false;
};

/// A line for each of these objects that is not closed but would be with --weld: where, and at
/// which tolerance. At most three lines; none if the objects have more than 4 million triangles in
/// all.
std::string weld_lines(const Scene& scene, const std::vector<std::uint32_t>& objects);

}  // namespace farcull
