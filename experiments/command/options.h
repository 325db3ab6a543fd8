// Options, outputs and progress that several commands share.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/cull/cull.h"
#include "experiments/command/declare.h"
#include "experiments/command/files.h"
#include "experiments/method/run.h"
#include "experiments/record/tables.h"

namespace farcull {

inline constexpr const char* kVersion = "farcull 0.1";
inline constexpr int kExitDone = 0, kExitBroken = 1, kExitBad = 2;  // exit statuses

/// Declares SCENE, which has to be given.
void add_scene(CLI::App& command, std::vector<std::string>& scene);

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

/// Throws Error where a name of the scene is empty.
void check_scene(const std::vector<std::string>& scene);
/// The seed of the scene, where it is a random built-in one.
std::optional<std::uint64_t> seed_of(const std::vector<std::string>& scene);

/// A distance in world units. Throws Error naming --clearance.
double parse_clearance(const std::string& text);
/// --views as RunOptions takes it: `auto` is "". Throws Error where the value is empty.
std::string parse_views_option(const std::string& text, bool may_choose);
/// --self: every object of the scene is tested against itself.
void make_self(Scene& scene);

/// The guarantee that `record` broke, for complain().
std::string missed(const Record& record);

/// Empty where none is asked for. Throws Error where the value is empty.
std::string device_of(const Text& device);

void write_json(const nlohmann::ordered_json& json, const std::string& path);

inline constexpr const char* kViewsHelp =
    "axes or directions to look along, by commas, as in\n"
    "x,-y,1:1:0.5; default x,y,z; for far-pairs auto: the\n"
    "scene decides whether views are needed, and which";
inline constexpr const char* kRoundsHelp =
    "at most N rounds over all views, for methods that draw;\n"
    "1 is CULLIDE as published; default: until a round\n"
    "changes nothing, for far until it culls little";
inline constexpr const char* kClearHelp =
    "how many views have to clear a triangle before it is\n"
    "culled, for methods that draw; default any";
inline constexpr const char* kLevelHelp =
    "objects: objects are culled as a whole, their triangles\n"
    "are not; for far, cullide and quick-cullide;\n"
    "default triangles, which comes after objects";
inline constexpr const char* kConservativeHelp =
    "draw every pixel that a triangle touches, for the\n"
    "CULLIDE family; OpenGL: where the device can";
inline constexpr const char* kDeviceHelp =
    "native (alias cpu: the cores of the CPU, no GPU), gl,\n"
    "software, hardware or a number that `farcull doctor`\n"
    "lists; default GL where hardware answers and keeps the\n"
    "assumptions, else native";
/// kDeviceHelp for commands that take far-pairs, which obeys a GL device that is named.
std::string device_help_of_methods();
inline constexpr const char* kSelfHelp =
    "every object is tested against itself as well\n"
    "(far, far-pairs, s-cullide, i-collide, exact); collisions\n"
    "of triangles that share a vertex position are listed apart";
inline constexpr const char* kFullHelp =
    "leave nothing out that the scene does not need, to\n"
    "measure what leaving out saves (see farcull plan);\n"
    "far-pairs: with this option views decide";
inline constexpr const char* kFacesHelp =
    "with --pairs: two more columns, face_a and face_b, the\n"
    "faces of the mesh files (see farcull help pairs)";
inline constexpr const char* kClearanceHelp =
    "pairs at this distance or less collide, in world\n"
    "units (far-pairs, exact); default 0";
inline constexpr const char* kSceneHelp =
    "mesh files (.obj .off .ply .stl, also .obj.gz and\n"
    "so on), each an object;\n"
    "or one scene file (.json: farcull help scene-file); or\n"
    "one built-in scene (farcull scenes lists them)";
inline constexpr const char* kJsonHelp =
    "write the record as JSON to this file; - for standard\n"
    "output, without the table";

}  // namespace farcull
