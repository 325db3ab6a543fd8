// The exact offset: a triangle and a ball's Minkowski sum itself, three edge-aligned cylinders,
// three spheres and two shifted triangles (Govindaraju, Lin, Manocha 2004, section 4.2), evaluated
// per pixel by its shader function (offsets/minkowski.glsl).
#pragma once

#include "core/canvas/fatten.h"

namespace farcull {

/// A primitive clipped to more than three corners is drawn as a fan of triangles, each fattened;
/// their union contains the fattened polygon.
Fattener minkowski_fattener();

}  // namespace farcull
