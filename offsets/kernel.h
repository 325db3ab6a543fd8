// Adapts a kernel, a GLSL function solid_interval() compiled as C++, to the types of SolidProgram.
#pragma once

#include "core/base/glsl_shim.h"
#include "core/base/glsl_worst.h"
#include "core/canvas/canvas.h"

namespace farcull {

template <class V4>
V4 vec4_of(const std::array<float, 4>& s) {
  return {s[0], s[1], s[2], s[3]};
}

/// Calls a kernel that was compiled with float.
template <auto Kernel>
bool kernel_interval(float cx, float cy, const Solid& s, float& entry, float& exit) {
  using glsl::vec4;
  return Kernel({cx, cy}, vec4_of<vec4>(s[0]), vec4_of<vec4>(s[1]), vec4_of<vec4>(s[2]),
                vec4_of<vec4>(s[3]), vec4_of<vec4>(s[4]), entry, exit);
}

/// Calls a kernel compiled with Worst, which tracks all rounding that GLSL permits. Returns false
/// if some rounding gives a miss. Otherwise sets the latest entry and the earliest exit.
template <auto Kernel>
bool kernel_interval_worst(float cx, float cy, const Solid& s, float& entry, float& exit) {
  using glsl_worst::vec4;
  glsl_worst::Worst first, last;
  if (!Kernel({cx, cy}, vec4_of<vec4>(s[0]), vec4_of<vec4>(s[1]), vec4_of<vec4>(s[2]),
              vec4_of<vec4>(s[3]), vec4_of<vec4>(s[4]), first, last)) {
    return false;
  }
  entry = first.hi();
  exit = last.lo();
  return true;
}

}  // namespace farcull
