// Asks Gappa (https://gappa.gitlabpages.inria.fr) to prove a script.
#pragma once

#include <string>

namespace farcull::proofs {

/// False where the program `gappa` is not found.
bool has_gappa();

struct Answer {
  bool proved;
  std::string said;  // errors and warnings
};

/// Runs gappa on the script. A warning is a refusal: it says that a step of the script is not an
/// identity. Throws std::runtime_error where gappa did not run, or did not understand the script.
Answer ask_gappa(const std::string& script);

}  // namespace farcull::proofs
