// Polygons into triangles. Every sign that decides here is exact, since exact tests answer about
// the triangles afterwards: a triangle outside its polygon would collide with what the polygon does
// not touch.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// The sign of the area of the triangle a, b, c in the plane of the coordinates u and v: 1 if it
/// turns left at b (u to the right, v up), -1 if it turns right, 0 if the three are collinear
/// there. Exact for finite doubles of any size.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
/// The same where rounded arithmetic is certain of the sign; 0 where turn() has to add without
/// rounding: three points close to a line, or products of differences that overflow or underflow.
int certain_turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);
using Turn = int (*)(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);

enum class Triangulation {
  whole,      // the triangles have the area of the polygon, all one orientation, and do not overlap
  too_large,  // no triangles: neither convex nor within reach of ear clipping
  folded,     // the polygon is not simple in its plane: the triangles overlap or face both ways
};

/// Triangles of a polygon, as positions in `corners`: always size - 2 of them (none if too_large),
/// in the orientation of the polygon; some may be degenerate where corners are collinear. The
/// polygon is cut in its projection along the axis nearest to its normal, up to a factor of 2
/// between components; the projection only drops a coordinate. A simple planar polygon is cut into
/// triangles as `whole` says; so is one that is not planar, if its projection is simple, and one
/// that touches itself along a seam, where that can be done. A polygon whose corners are collinear
/// is whole. `by` is for tests of what another sign does. Precondition: 3 corners or more, finite.
Triangulation triangulate(std::span<const Vec3> corners,
                          std::vector<std::array<std::uint32_t, 3>>& triangles, Turn by = turn);

}  // namespace farcull
