// The contestants that the study "libraries" knows. experiments/suite/ask.py (docs/ask.md) asks
// them like any other program, and counts their wrong answers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace farcull {

/// A contestant that the study knows, whether this build has it or not.
struct KnownContestant {
  std::string name = {};     // as its card says
  std::string program = {};  // farcull_contestant_PROGRAM
  std::string package = {};  // the package that it needs; empty: none
  std::string answers = {};  // the questions that the study asks it, such as "pair mesh"
};

/// The contestants in the order of tables, the same in every build.
const std::vector<KnownContestant>& known_contestants();
/// The contestant with this name. Throws Error if there is none.
const KnownContestant& known_contestant(const std::string& name);
/// The command line of the contestant's program. The program is in the folder that the variable
/// FARCULL_CONTESTANTS names, else in the folder `contestants` beside this program. Empty: it was
/// not built.
std::string command_of(const KnownContestant& contestant);

/// Runs `ask.py --json` with these options on the program that `command` starts, and returns what
/// it prints. Throws Error with the reason if it fails.
nlohmann::json ask_program(const std::string& command, const std::vector<std::string>& options);

}  // namespace farcull
