// The instruction sets that the native canvas can use on this processor.
#pragma once

#include <string>
#include <vector>

namespace farcull {

/// Best first, such as "AVX3", "AVX2", "SSE4", "SCALAR" or "EMU128"; the last is plain C++.
std::vector<std::string> lane_targets();
/// The instruction set in use.
std::string lane_target();
/// Uses another one of lane_targets() from now on, in all threads; "": the best. No bit of an
/// answer depends on it. Must not be called while something is drawn. Throws Error for an
/// instruction set that this processor lacks.
void use_lane_target(const std::string& name);

}  // namespace farcull
