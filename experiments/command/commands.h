// Commands of the program: each declares its options below another command or the program, and is
// run by what it gives back.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "experiments/command/declare.h"

namespace farcull {

/// A command that is declared. run() gives the exit status, and throws Error where the arguments
/// are bad.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

/// A command whose options are members of a class with add_to() and run().
template <class Class>
Command declare(CLI::App& parent) {
  const auto command = std::make_shared<Class>();
  return {command->add_to(parent), [command] { return command->run(); }};
}

// Below the program.
/// 1: two contestants disagree.
Command add_bench(CLI::App& app);
/// 1: an assumption does not hold on the device.
Command add_doctor(CLI::App& app);
/// All that is named below `farcull experiment`.
Command add_experiment(CLI::App& app);
Command add_merge(CLI::App& app);
/// 1: a row or a picture breaks a promise.
Command add_report(CLI::App& app);
Command add_scenes(CLI::App& app);
Command add_suite(CLI::App& app);

// Below `farcull experiment`.
/// 1: a method that promises missed a pair.
Command add_family(CLI::App& experiment);
/// 1: a violation at the budget radius or beyond.
Command add_lemma(CLI::App& experiment);
/// 1: a method that promises finds other pairs with --full than without.
Command add_savings(CLI::App& experiment);
/// A command for each study, and `all`: 1 where a method that promises missed, 2 where a point
/// could not be measured.
std::vector<Command> add_studies(CLI::App& experiment);

/// The folder of results unless --out says otherwise; `farcull report` reads it.
inline constexpr const char* kResultsFolder = "farcull-results";

}  // namespace farcull
