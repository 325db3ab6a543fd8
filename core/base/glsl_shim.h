// Lets a kernel file (*.glsl) compile as C++: the few vector types and functions that kernels use.
// A kernel says FAR_OUT(t) and FAR_INOUT(t) for its parameters and FAR_PRECISE before a float that
// no compiler may reassociate, FAR_KERNEL before a function that several files may compile;
// contraction is off for all of farcull (CMakeLists.txt), so both compilations round every
// operation once.
#pragma once

#include <cmath>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

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
inline float clamp(float a, float lo, float hi) { return min(max(a, lo), hi); }

// Operators on vec4 work component by component; with SSE2 one instruction does all four.
#ifdef __SSE2__
inline __m128 lanes(vec4 a) { return _mm_load_ps(&a.x); }
inline vec4 from_lanes(__m128 a) {
  vec4 out;
  _mm_store_ps(&out.x, a);
  return out;
}
inline vec4 operator+(vec4 a, vec4 b) { return from_lanes(_mm_add_ps(lanes(a), lanes(b))); }
inline vec4 operator-(vec4 a, vec4 b) { return from_lanes(_mm_sub_ps(lanes(a), lanes(b))); }
inline vec4 operator*(float a, vec4 b) { return from_lanes(_mm_mul_ps(_mm_set1_ps(a), lanes(b))); }
inline vec4 min(vec4 a, vec4 b) { return from_lanes(_mm_min_ps(lanes(b), lanes(a))); }
inline vec4 max(vec4 a, vec4 b) { return from_lanes(_mm_max_ps(lanes(b), lanes(a))); }
inline vec4 abs(vec4 a) { return from_lanes(_mm_andnot_ps(_mm_set1_ps(-0.f), lanes(a))); }
#else
inline vec4 operator+(vec4 a, vec4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
inline vec4 operator-(vec4 a, vec4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
inline vec4 operator*(float a, vec4 b) { return {a * b.x, a * b.y, a * b.z, a * b.w}; }
inline vec4 min(vec4 a, vec4 b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z), min(a.w, b.w)};
}
inline vec4 max(vec4 a, vec4 b) {
  return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z), max(a.w, b.w)};
}
inline vec4 abs(vec4 a) { return {abs(a.x), abs(a.y), abs(a.z), abs(a.w)}; }
#endif

}  // namespace farcull::glsl

#define FAR_OUT(type) type&
#define FAR_INOUT(type) type&
#define FAR_PRECISE
#define FAR_KERNEL inline
#define FAR_FIXED(x) fixed(x)
// Kernels write these for bool, ?: and global constants, since pixels may be lanes of a vector
// (core/native/glsl_lanes-inl.h). FAR_UNIFORM(c): as a condition of `if`, where c is the same for
// all lanes.
#define FAR_CONSTANT const float
#define FAR_BOOL bool
#define FAR_SELECT(c, a, b) ((c) ? (a) : (b))
#define FAR_UNIFORM(c) (c)
