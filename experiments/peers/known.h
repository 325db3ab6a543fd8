// The contestants that the study knows, whether this build has them or not.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/peers/runner.h"

namespace farcull {

struct KnownContestant {
  std::string name = {};               // as its card says
  std::string program = {};            // farcull_contestant_PROGRAM
  std::string package = {};            // that it needs; empty: none
  bool pairs = false, meshes = false;  // what it is asked
  bool ours = false;                   // a method of farcull
};

/// In the order of tables: the same in every build.
const std::vector<KnownContestant>& known_contestants();
/// Throws Error where there is none of that name.
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
