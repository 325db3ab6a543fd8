// Draws raw triangles by the fixed rules of OpenGL: corners snapped to 8 subpixel bits, pixel
// centres inside by the top-left rule, depth interpolated from the corners'. Nothing is promised of
// them; they are what CULLIDE draws.
#pragma once

#include "core/native/job.h"

namespace farcull {

constexpr int kNativeSubpixelBits = 8;

void draw_triangles_native(const NativeJob& job);

}  // namespace farcull
