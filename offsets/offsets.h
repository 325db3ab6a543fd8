// Offsets. An offset is a solid that is drawn in place of a primitive. It contains all points whose
// distance from the primitive is at most the radius.
#pragma once

#include <array>
#include <span>

#include "core/canvas/fatten.h"

namespace farcull {

// The OBB offset is an oriented box around a primitive. Each slab is moved outward by the radius,
// so the box contains the Minkowski sum of the primitive and a ball (Govindaraju, Lin, Manocha
// 2004, section 4.3: "bounding OBBs").

/// Returns the reliable fattener: offsets/obb.glsl evaluates the box in each pixel.
Fattener obb_fattener();
/// Returns the published fattener, for comparison: the box is drawn as a closed surface of twelve
/// triangles with interpolated depth.
Fattener obb_surface_fattener();

// The exact offset is the Minkowski sum of a triangle and a ball. Its surface consists of parts of
// three cylinders around the edges, three spheres and two shifted triangles (Govindaraju, Lin,
// Manocha 2004, section 4.2). The shader function offsets/minkowski.glsl evaluates the offset in
// each pixel.

/// Clipping can give a primitive more than three corners. Such a polygon becomes a fan of
/// triangles. The union of the fattened triangles contains the fattened polygon.
Fattener minkowski_fattener();

// The next functions fit rectangles and solids to primitives in double (offsets/fit.inl).

/// Returns the corners of a rectangle inside `bounds` that contains the image of `points`, fattened
/// by a disc of `radius` px. The rectangle is parallel to the longest edge if such a rectangle
/// fits. Otherwise the rectangle is axis-aligned and cut off at `bounds`, which are at least a
/// pixel outside the window. The corners are rounded to the nearest floats. The term "input" of the
/// error budget covers this rounding.
std::array<float, 8> proxy_rectangle(std::span<const Vec3> points, double radius,
                                     const ProxyBounds& bounds);

/// Returns the numbers that offsets/obb.glsl reads: an oriented box around the hull of `points`
/// (px) fattened by a ball of `radius` px, rounded outward. Precondition: at least one point.
Solid obb_of(std::span<const Vec3> points, double radius);

/// Returns the numbers that offsets/minkowski.glsl reads: the triangle a, b, c (px) fattened by a
/// ball of `radius` px, rounded outward. The corners are rounded to floats relative to a float
/// centre, so the radius grows by the largest displacement of a corner.
Solid minkowski_solid(const Vec3& a, const Vec3& b, const Vec3& c, double radius);

}  // namespace farcull
