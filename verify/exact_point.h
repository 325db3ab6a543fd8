// Decides exactly which pixels contain the image of a point of a triangle, and whether two depth
// samples enclose the point's depth. For tests of the lemmas in docs/reliability.md. Uses only
// rational numbers (GMP), and neither the error budget nor an offset.
#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// The point (w0 c0 + w1 c1 + w2 c2) / (w0 + w1 + w2) of the closed triangle with the corners c0 to
/// c2 in pixel space. w0 to w2 are `weights`.
struct ExactPoint {
  std::array<Vec3, 3> corners;  // px, finite
  std::array<int, 3> weights;   // >= 0; the sum is > 0
};

struct Pixel {
  int x;  // from 0 at the left of the window
  int y;
};

/// Returns the pixels (closed squares) that contain the image of the point: none to four. The
/// window has width x height px and is centred on the origin.
std::vector<Pixel> pixels_containing(const ExactPoint& point, int width, int height);

/// True iff entry <= z(point) <= exit (px), decided exactly. False if entry or exit is not finite.
bool bounded(const ExactPoint& point, float entry, float exit);

/// Returns how far z(point) is outside [entry, exit], px: the larger of entry - z and z - exit,
/// rounded toward 0, but never from above 0 to 0. Precondition: finite entry and exit.
double beyond(const ExactPoint& point, float entry, float exit);
/// Like beyond(), but compares depth-buffer values: returns the larger of entry - D and D - exit,
/// with D = z(point) * scale + 1/2.
double beyond_stored(const ExactPoint& point, float entry, float exit, float scale);

}  // namespace farcull
