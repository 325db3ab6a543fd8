// core/pairs/interval.glsl compiled as C++, in the namespace farcull::interval.
#pragma once

#include "core/base/glsl_shim.h"

namespace farcull::interval {

using namespace farcull::glsl;
#include "core/pairs/interval.glsl"

}  // namespace farcull::interval
