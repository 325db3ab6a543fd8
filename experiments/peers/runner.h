// Asks a contestant in processes of its own. A crash, a hang, or a process that takes all memory is
// an answer about the question at which it happened; the next question goes to a new process.
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
  std::uint64_t memory_mib = 0;  // of address space; 0: no limit
};

struct ChildEnd {
  enum class How : std::uint8_t { peace, crash, time, memory } how = How::peace;
  std::string reason;  // but for peace: the signal or the status, and the last that it printed
  /// A limit of the whole process (CPU time or memory) ended it, not that of one line: what it did
  /// before may have used it up.
  bool used_up = false;
};

/// Starts `command`, whose first word is a path or looked for in PATH, in a process group of its
/// own. `more` gives the next part of its input, or nothing at the end of it. `line` is called with
/// each whole line of its standard output, without the newline; false means that the line is not
/// allowed, and kills the group (crash). All of the group has ended on return, also if `line`
/// throws. Throws Error if no process can be made, or if there is no such program.
ChildEnd run_child(const std::vector<std::string>& command, const ChildLimits& limits,
                   const std::function<std::string()>& more,
                   const std::function<bool(std::string_view)>& line);

// ---- contestants ----

/// A program of contestants, with what stands before NAME on its command line.
using ContestProgram = std::vector<std::string>;

/// A contestant that can be asked.
struct Invited {
  ContestantCard card;
  ContestProgram program;
};

struct ContestLimits {
  double answer_s = 10;          // wall clock from one answer to the next
  double start_s = 60;           // the same to the first answer of the first process; of later ones
                                 // at most twice answer_s
  std::uint64_t cpu_s = 3600;    // of a process
  std::uint64_t memory_mib = 0;  // of address space; 0: as the card says
  /// When so many processes ended badly, the questions that are left are not asked.
  std::size_t most_deaths = 100;
};

enum class ContestOutcome : std::uint8_t {
  apart,
  meets,
  refused,     // an error instead of an answer
  unanswered,  // it went on to the next question, or ended in peace without an answer
  crashed,     // the process ended otherwise, or wrote what is no answer
  hung,        // it took longer than the limit, of wall clock or of CPU time
  no_memory,   // it took more memory than the limit
  not_asked,   // too many processes had ended badly
};
std::string to_string(ContestOutcome outcome);
/// apart, meets and refused.
bool answered(ContestOutcome outcome);
/// crashed, hung and no_memory.
bool is_death(ContestOutcome outcome);

struct ContestAnswer {
  ContestOutcome outcome = ContestOutcome::not_asked;
  double ns = 0;            // as the contestant measured it; 0 without an answer
  std::string reason = {};  // of a refusal or a death: the signal, the last that it printed
};

struct PairsAnswer {
  std::vector<ContestAnswer> answers = {};  // one for each pair
  std::size_t asked_twice = 0;              // pairs of the sample
  std::vector<std::size_t> differing =
      {};                     // positions of pairs that were answered otherwise then, or not
  std::size_t processes = 0;  // that were started
};

/// Asks about all pairs, then about every `sample`th of them once more, in a new process and in the
/// opposite order; 0: none. A limit of memory or of CPU time is one of the whole process: where it
/// ends a process that has answered something, the question is asked again in a new process, and is
/// blamed if that one ends too. Throws Error where no process can be started.
PairsAnswer ask_pairs(const Invited& invited, std::span<const SuitePair> pairs,
                      const ContestLimits& limits = {}, std::size_t sample = 16);

struct MeshAnswer {
  ContestOutcome outcome = ContestOutcome::not_asked;  // meets: it answered with the pairs below
  double ns = 0;
  std::string reason = {};
  std::vector<TrianglePair> pairs = {};  // of the scene, sorted, each once; none of a triangle with
                                         // itself
  bool differs = false;  // asked again in a new process, it answered otherwise, or not at all
};

/// Asks about one mesh, whose OBJ files are in `folder`; `twice`: then once more. Throws Error
/// where no process can be started.
MeshAnswer ask_mesh(const Invited& invited, const SuiteMesh& mesh, const std::string& folder,
                    const ContestLimits& limits = {}, bool twice = true);

/// The contestants of a program. Throws Error where it does not start, does not end within the
/// limit, or prints no cards.
std::vector<Invited> invite(const ContestProgram& program, const ContestLimits& limits = {});

/// A contestant that the study knows, whether this build has it or not.
struct KnownContestant {
  std::string name = {};               // as its card says
  std::string program = {};            // farcull_contestant_PROGRAM
  std::string package = {};            // that it needs; empty: none
  bool pairs = false, meshes = false;  // what it is asked
  bool ours = false;                   // a method of farcull
};

/// In the order of tables: the same in every build.
const std::vector<KnownContestant>& known_contestants();
/// Throws Error if no contestant has that name.
const KnownContestant& known_contestant(const std::string& name);

/// A contestant, or why it cannot be asked.
struct Invitation {
  std::optional<Invited> invited;
  std::string missing = {};
};
/// Looks for its program in the folder `contestants` beside this program, or where the variable
/// FARCULL_CONTESTANTS says, and asks it for its card, once in a process.
Invitation invite_known(const KnownContestant& contestant);

}  // namespace farcull
