// `farcull bench`.
#pragma once

#include "experiments/command/options.h"
#include "experiments/measure/bench.h"

namespace farcull {

/// Declares the command on the program's options; run() runs it.
class BenchCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 1 where two contestants disagree. Throws Error where the arguments are bad.
  int run();

 private:
  BenchOptions parse() const;
  DistanceBenchOptions parse_distances(const BenchOptions& options) const;

  std::vector<std::string> scene_;
  bool self_ = false;
  Text peers_, methods_, threads_, repeat_, limit_, device_, distances_, within_;
  Outputs outputs_;
};

}  // namespace farcull
