// `farcull scenes`.
#pragma once

#include "experiments/command/options.h"

namespace farcull {

/// Declares the command on the program's options; run() runs it.
class ScenesCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status. Throws Error where the arguments are bad or a file cannot be written.
  int run() const;

 private:
  void list(const Outputs& outputs) const;
  void write() const;

  Text name_, folder_, frames_;
  Outputs outputs_;
};

}  // namespace farcull
