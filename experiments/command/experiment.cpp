// The commands below `farcull experiment`: the studies, and lemma.
#include "core/base/error.h"
#include "experiments/command/command.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

class ExperimentCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    CLI::App* command = add_command(
        app, "experiment", "studies for publication, and their premises", {},
        "Examples:\n  farcull experiment all --quick\n  farcull experiment accuracy --out results\n"
        "  farcull experiment lemma --points 1000000");
    allow_one_command(*command);
    commands_ = add_studies(*command);
    commands_.insert(commands_.end(), {add_lemma(*command)});
    return command;
  }
  int run() const {
    for (const Command& command : commands_) {
      if (given(*command.app)) return command.run();
    }
    std::string known = "all";
    for (const Study& study : studies()) known += ", " + study.name;
    throw Error("experiment", "no study is named", "name one: " + known + ", lemma");
  }

 private:
  std::vector<Command> commands_;
};

}  // namespace

Command add_experiment(CLI::App& app) { return declare<ExperimentCommand>(app); }

}  // namespace farcull
