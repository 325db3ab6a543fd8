// The fits of offsets/fit.inl on doubles: rectangles and solids of primitives with any number of
// corners.
#pragma once

#include <array>
#include <span>

#include "core/canvas/fatten.h"

namespace farcull {

/// A rectangle that contains the image of `points` fattened by a disc of `radius` px, inside
/// `bounds`: along the longest edge where that fits, else aligned with the axes and cut off at
/// `bounds`, a pixel or more outside the window. Corners are rounded to the nearest floats, which
/// the budget's term "input" pays for.
std::array<float, 8> proxy_rectangle(std::span<const Vec3> points, double radius,
                                     const ProxyBounds& bounds);

/// The oriented box that contains the hull of `points` (px, at least one) fattened by a ball of
/// `radius` px, rounded outward, as offsets/obb.glsl reads it.
Solid obb_of(std::span<const Vec3> points, double radius);

/// The solid that contains the triangle a, b, c (px) fattened by a ball of `radius` px, rounded
/// outward, as offsets/minkowski.glsl reads it: its corners are rounded to floats relative to a
/// float centre, its radius grows by the largest of their displacements.
Solid minkowski_solid(const Vec3& a, const Vec3& b, const Vec3& c, double radius);

}  // namespace farcull
