// `farcull run` and `farcull verify`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/cli_parts.h"
#include "experiments/frames.h"

namespace farcull {

/// Declares one of the two commands on the program's options; run() runs it.
class RunCommand {
 public:
  /// strict: `verify`, which asks the guarantee of every method.
  explicit RunCommand(bool strict) : strict_(strict) {}
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 done, 1 a guarantee is broken. Throws Error where the arguments are bad.
  int run() const;

 private:
  RunOptions parse() const;
  void refuse_idle(Method chosen) const;
  int run_once(const RunOptions& options, const Outputs& outputs) const;
  int run_frames(const RunOptions& options, const Outputs& outputs, FrameRange range) const;

  bool strict_;
  std::vector<std::string> scene_;
  Text method_, resolution_, radius_, offset_, depth_, depth_format_, query_, views_, device_;
  Text clearance_, frames_;
  Outputs outputs_;
  bool self_ = false, no_verify_ = false;
};

}  // namespace farcull
