// The exact offset: the Minkowski sum of a triangle and a ball. Its surface is made of three
// cylinders along the edges, three spheres and two shifted triangles (Govindaraju, Lin, Manocha
// 2004, section 4.2). The shader function offsets/minkowski.glsl evaluates it in each pixel.
#pragma once

#include "core/canvas/fatten.h"

namespace farcull {

/// A primitive clipped to more than three corners is drawn as a fan of triangles, each fattened;
/// their union contains the fattened polygon.
Fattener minkowski_fattener();

}  // namespace farcull
