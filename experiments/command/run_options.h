// The options of `farcull run` for callers without a command line.
#pragma once

#include <string>
#include <vector>

#include "experiments/method/options.h"

namespace farcull {

/// The options of a run, given as on the command line: "--method=far", "--conservative". `--self`
/// is the scene's. Throws Error naming the option where one is unknown or bad, or where options do
/// not go together.
RunOptions parse_run_options(const std::vector<std::string>& words);

}  // namespace farcull
