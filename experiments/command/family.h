// `farcull experiment family` and `farcull experiment savings`.
#pragma once

#include "experiments/command/options.h"
#include "experiments/measure/compare.h"
#include "experiments/measure/family.h"

namespace farcull {

/// Options, declaration and run of `family`.
class FamilyCommand {
 public:
  CLI::App* add_to(CLI::App& experiments);
  /// 1: a method that promises missed a pair. Throws Error where the arguments are bad.
  int run();

 private:
  FamilyArguments arguments_;
  Text frames_, resolution_, views_, query_, device_;
  Outputs outputs_;
  bool no_verify_ = false;
};

/// Options, declaration and run of `savings`.
class SavingsCommand {
 public:
  CLI::App* add_to(CLI::App& experiments);
  /// 1: a method that promises finds other pairs with --full than without. Throws Error where the
  /// arguments are bad.
  int run();

 private:
  SavingsArguments arguments_;
  Text repeat_, resolution_, device_;
  Outputs outputs_;
};

}  // namespace farcull
