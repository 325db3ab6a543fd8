// Asks a contestant, which runs in separate processes. A crash, a hang, or a process that takes all
// memory counts as the answer to the question at which it happened; the next question goes to a new
// process.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/peers/contestant.h"
#include "experiments/suite/reader.h"

namespace farcull {

// ---- a process with limits that is fed lines and answers with lines ----

struct ChildLimits {
  double start_s = 60;           // wall clock until the first line
  double line_s = 10;            // from one line to the next
  std::uint64_t cpu_s = 3600;    // CPU time
  std::uint64_t memory_mib = 0;  // of data that it may write; 0: no limit
};

struct ChildEnd {
  enum class How : std::uint8_t { peace, crash, time, memory } how = How::peace;
  std::string reason;  // except for peace: the signal or the status, and the last text it printed
  /// A limit of the whole process (CPU time or memory) ended the process, not the limit of one
  /// line. Earlier work may have used the limit up.
  bool used_up = false;
};

/// Starts `command`, whose first word is a path or looked for in PATH, in a new process group.
/// `more` gives the next part of its input, or nothing at the end of the input. `line` is called
/// with each whole line of its standard output, without the newline; if it returns false, the line
/// is not allowed, and the group is killed (crash). The whole group has ended on return, also if
/// `line` throws. Throws Error if no process can be made, or if there is no such program.
ChildEnd run_child(const std::vector<std::string>& command, const ChildLimits& limits,
                   const std::function<std::string()>& more,
                   const std::function<bool(std::string_view)>& line);

// ---- contestants ----

/// The words of a command line that starts a contestant.
using ContestProgram = std::vector<std::string>;

/// A contestant that can be asked.
struct Invited {
  ContestantCard card;
  ContestProgram program;
};

struct ContestLimits {
  double answer_s = 10;        // wall clock from one answer to the next
  double start_s = 60;         // wall clock to the first answer of the first process; for later
                               // processes at most twice answer_s
  std::uint64_t cpu_s = 3600;  // CPU time of a process
  std::uint64_t memory_mib = 4096;  // of data that it may write
  /// When so many processes have ended badly, the questions that are left are not asked.
  std::size_t most_deaths = 100;
};

enum class ContestOutcome : std::uint8_t {
  apart,
  meets,
  refused,     // an error instead of an answer
  unanswered,  // the process went on to the next question, or ended normally without an answer
  crashed,     // the process ended in another way, or wrote a line that is no answer
  hung,        // it took longer than the limit, of wall clock or of CPU time
  no_memory,   // it took more memory than the limit
  not_asked,   // too many processes had ended badly
};
std::string to_string(ContestOutcome outcome);
/// True for apart, meets and refused.
bool answered(ContestOutcome outcome);
/// True for crashed, hung and no_memory.
bool is_death(ContestOutcome outcome);

struct ContestAnswer {
  ContestOutcome outcome = ContestOutcome::not_asked;
  double ns = 0;            // as the contestant measured it; 0 without an answer
  std::string reason = {};  // of a refusal or a death: the signal, the last text it printed
};

struct PairsAnswer {
  std::vector<ContestAnswer> answers = {};  // one for each pair
  std::size_t asked_twice = 0;              // pairs of the sample
  std::vector<std::size_t> differing =
      {};                     // positions of pairs whose second answer was different or missing
  std::size_t processes = 0;  // how many were started
};

/// Asks about all pairs, then about every `sample`th pair once more, in a new process and in the
/// opposite order; 0: about none. The limits of memory and CPU time are limits of the whole
/// process: if one ends a process that has answered something, the question is asked again in a new
/// process, and is blamed only if that process ends too. Throws Error if no process can be started.
PairsAnswer ask_pairs(const Invited& invited, std::span<const SuitePair> pairs,
                      const ContestLimits& limits = {}, std::size_t sample = 16);

struct MeshAnswer {
  ContestOutcome outcome = ContestOutcome::not_asked;  // meets: it answered with `pairs`
  double ns = 0;
  std::string reason = {};
  std::vector<TrianglePair> pairs = {};  // of the scene, sorted, each once; no triangle with itself
  bool differs = false;  // the second answer, from a new process, was different or missing
};

/// Asks about one mesh, whose OBJ files are in `folder`; with `twice`, asks a second time. Throws
/// Error if no process can be started.
MeshAnswer ask_mesh(const Invited& invited, const SuiteMesh& mesh, const std::string& folder,
                    const ContestLimits& limits = {}, bool twice = true);

/// The contestant that a command starts, asked for its card. Throws Error if the program does not
/// start, does not end within the limit, or gives no card.
Invited invite(const ContestProgram& program, const ContestLimits& limits = {});

/// A contestant that the study knows, whether this build has it or not.
struct KnownContestant {
  std::string name = {};               // as its card says
  std::string program = {};            // farcull_contestant_PROGRAM
  std::string package = {};            // the package that it needs; empty: none
  bool pairs = false, meshes = false;  // which questions it is asked
  bool ours = false;                   // a method of farcull
};

/// The contestants in the order of tables, the same in every build.
const std::vector<KnownContestant>& known_contestants();
/// The contestant with this name. Throws Error if there is none.
const KnownContestant& known_contestant(const std::string& name);

/// A contestant, or why it cannot be asked.
struct Invitation {
  std::optional<Invited> invited;
  std::string missing = {};
};
/// Looks for the contestant's program in the folder that the variable FARCULL_CONTESTANTS names,
/// else in the folder `contestants` beside this program, and asks it for its card, once in this
/// process.
Invitation invite_known(const KnownContestant& contestant);

}  // namespace farcull
