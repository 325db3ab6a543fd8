// `farcull suite`: writes the labelled suite of triangle pairs and meshes, or checks one.
#pragma once

#include "experiments/command/options.h"

namespace farcull {

/// Declares the command on the program's options; run() runs it.
class SuiteCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status. Throws Error where the arguments are bad, a file cannot be read or written,
  /// or the suite that is checked is not right.
  int run() const;

 private:
  std::string folder_;
  Text size_, seed_;
  bool check_ = false;
};

}  // namespace farcull
