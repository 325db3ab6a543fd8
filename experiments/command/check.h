// `farcull check`: a certificate, or a list of pairs, against the scene that it speaks about.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/scenes/frames.h"

namespace farcull {

struct CheckArguments {
  std::string certificate;         // a file, of frames with a number; "": `pairs` is checked alone
  std::vector<std::string> scene;  // as of `farcull run`
  std::string json = {};           // "" for none, "-" for standard output instead of the text
  bool self = false;               // every object is tested against itself, as by run --self
  std::string pairs = {};          // "" for none, or a list as `farcull run --pairs` writes it
  std::optional<double> clearance = {};  // of the list; of a certificate it has to be the same
  std::optional<FrameRange> frames = {};
};

/// Prints the verdict, of frames one for each and one in all. 0: proved, and the list that is given
/// is the one that is proved; 1: refuted or not proved. Throws Error where the certificate, the
/// scene or the list cannot be read, and where the list is of frames and none are named, or the
/// contrary.
int run_check(const CheckArguments& arguments);

}  // namespace farcull
