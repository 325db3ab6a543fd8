// Cuts a line through a pixel centre along z with slabs and halfspaces. Widens every bound outward. This file compiles as GLSL
// and as C++, before the file of an offset (obb.glsl or minkowski.glsl).
//
// In C++, the type float may be a vector with one pixel in each lane (core/native/glsl_lanes-inl.h). Then a FAR_BOOL has a value
// per lane, and FAR_SELECT computes both alternatives and chooses per lane. An `if` needs FAR_UNIFORM, with a condition that is
// the same for all pixels of a solid.
//
// u = 2^-23. The relative error is at most u for an operation in any rounding mode, and 2.5 u for a division (GLSL 4.50, 4.7.1;
// |divisor| >= 2^-20, quotient < 2^126). Results below 2^-126 may be flushed. Constants: docs/budget.md, "The oriented box".

#ifndef FAR_WIDEN  // tests set 0 to show that the widening is needed
#define FAR_WIDEN 1.0f
#endif
FAR_CONSTANT kEightU = FAR_WIDEN * 9.5367431640625e-7f;  // 8 u, a power of two, so exact
FAR_CONSTANT kFourU = FAR_WIDEN * 4.76837158203125e-7f;
FAR_CONSTANT kUp = 1.0f + kEightU;
FAR_CONSTANT kTiny = FAR_WIDEN * 1e-30f;  // covers results below 2^-126 that are flushed to zero
FAR_CONSTANT kParallel = 9.5367431640625e-7f;  // 2^-20

// Cuts [lo, hi] of the line with a slab of centre m. Returns false if the line misses the slab.
// mz = m.z; d = c - m.xy for pixel centre c; reach: upper bound of |z - m.z| in the solid.
FAR_KERNEL FAR_BOOL far_slab(vec2 d, float mz, vec4 slab, float reach, FAR_INOUT(float) lo, FAR_INOUT(float) hi) {
  FAR_PRECISE float sx = slab.x * d.x;
  FAR_PRECISE float sy = slab.y * d.y;
  FAR_PRECISE float s = sx + sy;
  FAR_PRECISE float e = (abs(sx) + abs(sy)) * kEightU + kTiny;
  FAR_PRECISE float h = (slab.w + e) * kUp;
  float steep = abs(slab.z);
  if (FAR_UNIFORM(steep < kParallel)) {  // the slab is nearly parallel to the line
    FAR_PRECISE float slack = steep * reach * kUp;
    FAR_PRECISE float limit = (h + slack) * kUp;
    return abs(s) <= limit;
  }
  FAR_PRECISE float t0 = (-h - s) / slab.z;
  FAR_PRECISE float t1 = (h - s) / slab.z;
  FAR_PRECISE float w0 = abs(t0) * kEightU + kTiny;
  FAR_PRECISE float w1 = abs(t1) * kEightU + kTiny;
  FAR_PRECISE float near = min(t0 - w0, t1 - w1);
  FAR_PRECISE float far = max(t0 + w0, t1 + w1);
  FAR_PRECISE float near_error = (abs(mz) + abs(near)) * kFourU;
  FAR_PRECISE float far_error = (abs(mz) + abs(far)) * kFourU;
  FAR_PRECISE float z0 = (mz + near) - near_error;
  FAR_PRECISE float z1 = (mz + far) + far_error;
  lo = max(lo, z0);
  hi = min(hi, z1);
  return FAR_BOOL(true);
}

// Cuts the interval [lo, hi] of the line with the halfspace n . (x - m) <= h. Returns false if the
// line misses the halfspace. d, mz, reach: as for far_slab().
FAR_KERNEL FAR_BOOL far_halfspace(vec2 d, float mz, vec4 n, float h, float reach, FAR_INOUT(float) lo, FAR_INOUT(float) hi) {
  FAR_PRECISE float sx = n.x * d.x;
  FAR_PRECISE float sy = n.y * d.y;
  FAR_PRECISE float s = sx + sy;
  FAR_PRECISE float e = (abs(sx) + abs(sy)) * kEightU + kTiny;
  FAR_PRECISE float room = (h - s) + e;
  FAR_PRECISE float wide = room + (abs(h) + abs(s) + e) * kEightU;
  float steep = abs(n.z);
  FAR_BOOL parallel = steep < kParallel;
  FAR_PRECISE float slack = steep * reach * kUp;
  FAR_PRECISE float rest = wide + slack * kUp;
  FAR_PRECISE float divisor = FAR_SELECT(parallel, 1.0f, n.z);
  FAR_PRECISE float t = wide / divisor;
  FAR_PRECISE float w = abs(t) * kEightU + kTiny;
  FAR_PRECISE float far = t + w;
  FAR_PRECISE float far_error = (abs(mz) + abs(far)) * kFourU;
  FAR_PRECISE float z1 = (mz + far) + far_error;
  FAR_PRECISE float near = t - w;
  FAR_PRECISE float near_error = (abs(mz) + abs(near)) * kFourU;
  FAR_PRECISE float z0 = (mz + near) - near_error;
  FAR_BOOL above = n.z > 0.0f;
  hi = FAR_SELECT(!parallel && above, min(hi, z1), hi);
  lo = FAR_SELECT(!parallel && !above, max(lo, z0), lo);
  return !parallel || rest >= 0.0f;
}
