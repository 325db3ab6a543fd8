// core/interval.glsl compiled as C++, in the namespace farcull::interval.
#pragma once

#include "core/glsl_shim.h"

namespace farcull::interval {

using namespace farcull::glsl;
#include "core/interval.glsl"

}  // namespace farcull::interval
