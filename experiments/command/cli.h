// The command line of farcull.
#pragma once

namespace farcull {

/// Exit status: 0 done; 1 a guarantee is broken; 2 bad input or environment, a device error
/// included.
int command_line(int argc, char** argv);

}  // namespace farcull
