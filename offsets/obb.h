// The OBB offset: an oriented box around a primitive, each slab moved outward by the radius, so
// that it contains the Minkowski sum with a ball (Govindaraju, Lin, Manocha 2004, section 4.3:
// "bounding OBBs").
#pragma once

#include "core/canvas/fatten.h"

namespace farcull {

/// The box evaluated per pixel by its shader function (offsets/obb.glsl). The reliable path.
Fattener obb_fattener();
/// The box drawn as a closed surface of twelve triangles with interpolated depth. The published
/// path, for comparison.
Fattener obb_surface_fattener();

}  // namespace farcull
