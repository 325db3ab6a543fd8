// `farcull experiment NAME`: the studies.
#pragma once

#include "experiments/command/family.h"
#include "experiments/command/lemma.h"
#include "experiments/command/options.h"
#include "experiments/command/studies.h"

namespace farcull {

/// Declares the command and its studies on the program's options; run() runs the one that was
/// named.
class ExperimentCommands {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status. Throws Error where no study is named or its arguments are bad.
  int run();

 private:
  int run_oracles();

  CLI::App* lemma_ = nullptr;
  CLI::App* oracles_ = nullptr;
  CLI::App* family_ = nullptr;
  CLI::App* savings_ = nullptr;
  StudiesCommand studies_;
  FamilyCommand family_command_;
  SavingsCommand savings_command_;
  LemmaArguments arguments_;
  Text device_;
  Outputs lemma_outputs_, oracle_outputs_;
  std::uint64_t pairs_ = 100000;
  std::uint64_t seed_ = 1;
};

}  // namespace farcull
