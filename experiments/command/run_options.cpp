// Declares the command and parses the words with it, so that the rules are those of the command
// line.
#include "experiments/command/run_options.h"

#include <CLI/CLI.hpp>

#include "core/base/error.h"
#include "experiments/command/run.h"

namespace farcull {

RunOptions parse_run_options(const std::vector<std::string>& words) {
  CLI::App app;
  RunCommand run(RunCommand::Kind::run);
  run.add_to(app);
  // CLI11 takes the words from the end.
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  reversed.insert(reversed.end(), {"scene", "run"});
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app.remaining(true);
    const std::string where = unknown.empty() ? "options" : unknown.front();
    throw Error(where.substr(0, where.find('=')), unknown.empty() ? error.what() : "is no option",
                "see farcull run --help");
  }
  return run.parse();
}

}  // namespace farcull
