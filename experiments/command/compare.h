// `farcull compare`.
#pragma once

#include "experiments/command/options.h"
#include "experiments/measure/compare.h"

namespace farcull {

/// Declares the command on the program's options; run() runs it.
class CompareCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 done, 1 a guarantee is broken. Throws Error where the arguments are bad.
  int run() const;

 private:
  CompareArguments arguments_;
  MethodOptions options_;
  Outputs outputs_;
};

}  // namespace farcull
