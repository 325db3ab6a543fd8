// The exact offset: a triangle and a ball's Minkowski sum itself, three edge-aligned cylinders,
// three spheres and two shifted triangles (Govindaraju, Lin, Manocha 2004, section 4.2), evaluated
// per pixel by its shader function (offsets/minkowski.glsl).
#pragma once

#include "core/canvas/fatten.h"

namespace farcull {

/// A primitive clipped to more than three corners is drawn as a fan of triangles, each fattened;
/// their union contains the fattened polygon.
Fattener minkowski_fattener();

/// The solid that contains the triangle a, b, c (px) fattened by a ball of `radius` px, rounded
/// outward: its corners are rounded to floats relative to a float centre, its radius grows by the
/// largest of their displacements.
Solid minkowski_solid(const Vec3& a, const Vec3& b, const Vec3& c, double radius);

}  // namespace farcull
