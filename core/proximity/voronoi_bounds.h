// core/proximity/voronoi_bounds.glsl compiled as C++, in the namespace farcull::voronoi_bounds.
#pragma once

#include "core/base/glsl_shim.h"

namespace farcull::voronoi_bounds {

using namespace farcull::glsl;
#include "core/proximity/voronoi_bounds.glsl"

/// 48 v N, with N cells along the longest side.
inline float error(int longest) { return 0x1.8p-18f * static_cast<float>(longest); }

}  // namespace farcull::voronoi_bounds
