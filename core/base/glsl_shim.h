// Defines the vector types, functions and macros with which a kernel file (*.glsl) compiles as C++.
// Kernels write output parameters as FAR_OUT(t) and FAR_INOUT(t). FAR_PRECISE marks a float whose
// computation must not be reassociated. FAR_KERNEL marks a function that several files may define.
// CMakeLists.txt turns off fused multiply-add, so C++ rounds every operation once, as GLSL does for
// FAR_PRECISE.
#pragma once

#include <cmath>

namespace farcull::glsl {

struct vec2 {
  float x, y;
};
struct alignas(16) vec4 {
  float x, y, z, w;
};

inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline float abs(float a) { return std::fabs(a); }
inline float sqrt(float a) { return std::sqrt(a); }
inline float fixed(float a) { return a; }

}  // namespace farcull::glsl

#define FAR_OUT(type) type&
#define FAR_INOUT(type) type&
#define FAR_PRECISE
#define FAR_KERNEL inline
#define FAR_FIXED(x) fixed(x)
// Kernels use these macros instead of bool, ?: and global constants. A kernel may also be compiled
// for vectors with one pixel per lane (core/native/glsl_lanes-inl.h). FAR_UNIFORM(c) is the
// condition of an `if`; c must be the same for all lanes.
#define FAR_CONSTANT const float
#define FAR_BOOL bool
#define FAR_SELECT(c, a, b) ((c) ? (a) : (b))
#define FAR_UNIFORM(c) (c)
