// `farcull report`.
#pragma once

#include <string>

#include "experiments/command/options.h"

namespace farcull {

class ReportCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 1 where a row or a picture breaks a promise, else 0. Throws Error as
  /// write_report() does.
  int run();

 private:
  std::string folder_;
  Text device_;
  bool no_pictures_ = false;
};

}  // namespace farcull
