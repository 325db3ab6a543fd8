// Options, files, outputs and progress that several commands share.
#pragma once

#include <deque>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/cull/cull.h"
#include "experiments/command/declare.h"
#include "experiments/method/run.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/frames.h"

namespace farcull {

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

}  // namespace farcull
