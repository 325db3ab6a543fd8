// `farcull picture`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/cli_parts.h"
#include "experiments/picture.h"

namespace farcull {

class PictureCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 done, 1 a method that promises missed a pair (the picture is there then).
  /// Throws Error where the arguments are bad.
  int run() const;
  /// What the parsed options ask for, checked; all but where it goes.
  PictureArguments arguments() const;

 private:
  void add_options(CLI::App& command);

  std::vector<std::string> scene_;
  Text method_, compare_, resolution_, radius_, offset_, depth_, device_, frame_, frames_, view_,
      up_, size_, output_;
  std::vector<std::string> depth_view_;
  CLI::Option* depth_view_option_ = nullptr;
  bool self_ = false, zoom_ = false;
};

/// The same of a text, as it stands on a command line after "farcull picture", without -o; the
/// program's name before it does no harm. Throws Error naming the text where it is not understood.
PictureArguments picture_arguments(const std::string& words);

}  // namespace farcull
