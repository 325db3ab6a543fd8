// A point of a triangle with exact coordinates, for tests of the lemmas: decides which pixels
// contain its image, and whether two samples bound its depth. Uses integers only (GMP), and neither
// the budget nor an offset.
#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// (w0 c0 + w1 c1 + w2 c2) / (w0 + w1 + w2) in pixel space: a point of the closed triangle of the
/// corners.
struct ExactPoint {
  std::array<Vec3, 3> corners;  // px, finite
  std::array<int, 3> weights;   // >= 0, their sum > 0
};

struct Pixel {
  int x;  // from 0 at the left of the window
  int y;
};

/// The pixels (closed squares) of a window of width x height px centred on the origin that contain
/// the image of the point: none to four.
std::vector<Pixel> pixels_containing(const ExactPoint& point, int width, int height);

/// entry <= z(point) <= exit, exactly; false if a sample is NaN.
bool bounded(const ExactPoint& point, float entry, float exit);

/// How far z(point) is outside the samples: the larger of entry - z and z - exit, computed exactly
/// and rounded toward 0 to a double. Not positive if bounded(). Precondition: finite samples.
double beyond(const ExactPoint& point, float entry, float exit);
/// beyond() for depths of a depth buffer: the larger of entry - D and D - exit, with
/// D = z(point) * scale + 1/2.
double beyond_stored(const ExactPoint& point, float entry, float exit, float scale);

}  // namespace farcull
