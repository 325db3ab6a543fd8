// Draws raw triangles by the fixed rules of OpenGL: corners snapped to 8 subpixel bits, pixel
// centres inside by the top-left rule, depth interpolated from the corners'. Nothing is promised of
// them; they are what CULLIDE draws.
//
// Conservatively, as GL_NV_conservative_raster does: a fragment in every pixel whose closed square
// the snapped triangle touches, however small or thin it is. Its depth is that of the triangle's
// plane at the pixel's centre, but never outside the depths of its corners; of a triangle whose
// image is a segment or a point, the middle of these. So a fragment has one depth, where the
// triangle has a range of them in the pixel, and pairs can still be missed.
#pragma once

#include "core/native/job.h"

namespace farcull {

constexpr int kNativeSubpixelBits = 8;

void draw_triangles_native(const NativeJob& job);

}  // namespace farcull
