// Offsets: solids that are drawn in place of a primitive and contain all points at most the radius
// away from it.
#pragma once

#include <array>
#include <span>

#include "core/canvas/fatten.h"

namespace farcull {

// The OBB offset: an oriented box around a primitive, each slab moved outward by the radius, so
// that it contains the Minkowski sum with a ball (Govindaraju, Lin, Manocha 2004, section 4.3:
// "bounding OBBs").

/// The box evaluated per pixel by its shader function (offsets/obb.glsl). The reliable path.
Fattener obb_fattener();
/// The box drawn as a closed surface of twelve triangles with interpolated depth. The published
/// path, for comparison.
Fattener obb_surface_fattener();

// The exact offset: the Minkowski sum of a triangle and a ball. Its surface is made of three
// cylinders along the edges, three spheres and two shifted triangles (Govindaraju, Lin, Manocha
// 2004, section 4.2). The shader function offsets/minkowski.glsl evaluates it in each pixel.

/// A primitive clipped to more than three corners is drawn as a fan of triangles, each fattened;
/// their union contains the fattened polygon.
Fattener minkowski_fattener();

// The fits of offsets/fit.inl on doubles: rectangles and solids of primitives with any number of
// corners.

/// A rectangle inside `bounds` that contains the image of `points` fattened by a disc of `radius`
/// px: along the longest edge if that fits; else aligned with the axes and cut off at `bounds`,
/// which is at least a pixel outside the window. Corners are rounded to the nearest floats, which
/// the budget's term "input" covers.
std::array<float, 8> proxy_rectangle(std::span<const Vec3> points, double radius,
                                     const ProxyBounds& bounds);

/// The oriented box that contains the hull of `points` (px, at least one) fattened by a ball of
/// `radius` px, rounded outward, as offsets/obb.glsl reads it.
Solid obb_of(std::span<const Vec3> points, double radius);

/// The solid that contains the triangle a, b, c (px) fattened by a ball of `radius` px, rounded
/// outward, as offsets/minkowski.glsl reads it. Its corners are rounded to floats relative to a
/// float centre, and its radius grows by the largest of their displacements.
Solid minkowski_solid(const Vec3& a, const Vec3& b, const Vec3& c, double radius);

}  // namespace farcull
