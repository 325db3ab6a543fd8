// `farcull picture`.
#pragma once

#include <string>
#include <vector>

#include "experiments/command/options.h"
#include "experiments/picture/picture.h"

namespace farcull {

class PictureCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 done, 1 a method that promises missed a pair (the picture is there then).
  /// Throws Error where the arguments are bad.
  int run() const;
  /// The parsed options, checked; all but the paths of the files.
  PictureArguments arguments() const;
  /// The contents of the page of --html, from the arguments of its flat picture.
  PageArguments page_arguments(const PictureArguments& picture) const;

 private:
  /// The options that all panels share.
  RunOptions usual_options() const;

  std::vector<std::string> scene_;
  Text method_, compare_, resolution_, radius_, offset_, depth_, device_, frame_, frames_, view_,
      up_, size_, output_, html_, resolutions_;
  BareOption depth_view_;
  bool self_ = false, zoom_ = false;
};

}  // namespace farcull
