// A point of a triangle with exact coordinates, for tests of the lemmas. Decides which pixels
// contain the point's image, and whether two samples bound its depth. Uses only integers (GMP), and
// neither the budget nor an offset.
#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// A point of the closed triangle with these corners, in pixel space: (w0 c0 + w1 c1 + w2 c2) / (w0
/// + w1 + w2).
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

/// True iff entry <= z(point) <= exit, exactly. False if a sample is not finite.
bool bounded(const ExactPoint& point, float entry, float exit);

/// Returns how far z(point) is outside the samples: the larger of entry - z and z - exit, computed
/// exactly and rounded toward 0 to a double. At most 0 iff bounded(). Precondition: finite samples.
double beyond(const ExactPoint& point, float entry, float exit);
/// beyond() for depths of a depth buffer: the larger of entry - D and D - exit, with
/// D = z(point) * scale + 1/2.
double beyond_stored(const ExactPoint& point, float entry, float exit, float scale);

}  // namespace farcull
