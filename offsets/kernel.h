// Turns a kernel that was compiled as C++ into the functions of a SolidProgram.
#pragma once

#include "core/base/glsl_shim.h"
#include "core/base/glsl_worst.h"
#include "core/canvas/canvas.h"

namespace farcull {

template <class V4>
V4 vec4_of(const std::array<float, 4>& s) {
  return {s[0], s[1], s[2], s[3]};
}

/// Calls the kernel, a solid_interval() of GLSL, with floats.
template <auto Kernel>
bool kernel_interval(float cx, float cy, const Solid& s, float& entry, float& exit) {
  using glsl::vec4;
  return Kernel({cx, cy}, vec4_of<vec4>(s[0]), vec4_of<vec4>(s[1]), vec4_of<vec4>(s[2]),
                vec4_of<vec4>(s[3]), vec4_of<vec4>(s[4]), entry, exit);
}

/// Calls a kernel that was compiled with the number type Worst. Returns false if the line misses
/// the solid under some permitted rounding. Otherwise gives the latest entry and the earliest exit.
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
