// The threads in which a software device of Mesa draws. They may write to memory that was freed
// (docs/drivers.md), so no promise rests on a device that has some (assumption A10).
#pragma once

#include <string>

namespace farcull {

/// To be called before the first display is opened. Mesa's llvmpipe then reads LP_NUM_THREADS, and
/// never again; this remembers what it says.
void note_asked_threads();

/// How many threads of the driver draw in this process: those of llvmpipe, where the renderer is
/// it or draws with it; else 0. Where LP_NUM_THREADS asked for more than there are now, that
/// number.
int driver_threads(const std::string& renderer);

/// What those threads risk, and the remedy, without a full stop; empty where there are none.
std::string risk_of_threads(const std::string& renderer);

}  // namespace farcull
