// Where a triangle can be in pixel space: its bounds, and its depth interval over a rectangle of the image. This file compiles
// as GLSL for the GL back end, and as C++ for the CPU back end and property tests. Every bound and interval contains the exact
// one, for any rounding that GLSL allows; the constants are derived in docs/budget.md, "Interval pairs".
//
// A triangle is three float corners (px). Every point of the real triangle is within `widen` (px per axis) plus half a unit in
// the last place of the point of the float triangle with the same barycentric coordinates. Preconditions: a coordinate is 0 or
// 2^-60 <= |coordinate| <= 2^20; 2^-40 <= widen <= 2^20.

#ifndef FAR_PAIR_ROUNDING  // 0 in the test that shows what happens without it
#define FAR_PAIR_ROUNDING 1.0f
#endif
const float kBoundUnit = FAR_PAIR_ROUNDING * 4.76837158203125e-7f;  // 4 u, u = 2^-23; powers of two, so exact
const float kClipUnit = FAR_PAIR_ROUNDING * 7.62939453125e-6f;      // 64 u
const float kShort = 8.67361737988403547e-19f;                     // 2^-60

// The bounds of the real triangle; w stands for nothing.
FAR_KERNEL void far_bounds(vec4 a, vec4 b, vec4 c, vec4 widen, FAR_OUT(vec4) lo, FAR_OUT(vec4) hi) {
  vec4 least = min(min(a, b), c);
  vec4 most = max(max(a, b), c);
  FAR_PRECISE vec4 e = widen + kBoundUnit * (max(abs(least), abs(most)) + widen);
  FAR_PRECISE vec4 below = least - e;
  FAR_PRECISE vec4 above = most + e;
  lo = below;
  hi = above;
}

// How far a rectangle grows per axis, so that what the float triangle does in it covers the real one, whose bounds are lo, hi.
FAR_KERNEL vec4 far_margin(vec4 lo, vec4 hi, vec4 widen) {
  FAR_PRECISE vec4 e = widen + kClipUnit * max(abs(lo), abs(hi));
  e.x = e.x + kClipUnit;
  e.y = e.y + kClipUnit;
  e.z = e.z + kClipUnit;
  return e;
}

// The part of a triangle in a strip of the image, seen along y: the boundary of its image in the x-z plane, as segments.
struct FarStrip {
  vec4 segment[5];   // x, z of the end with the smaller x; x, z of the other
  float inverse[5];  // of the length along x; 0 for a short one
  int count;
  float lo;          // the range along x; lo > hi where the strip is empty
  float hi;
};

FAR_KERNEL void far_segment(FAR_INOUT(FarStrip) strip, float px, float pz, float qx, float qz) {
  bool ordered = px <= qx;
  vec4 s;
  s.x = ordered ? px : qx;
  s.y = ordered ? pz : qz;
  s.z = ordered ? qx : px;
  s.w = ordered ? qz : pz;
  FAR_PRECISE float length = s.z - s.x;
  float inverse = 0.0f;
  if (length > kShort) inverse = 1.0f / length;
  strip.segment[strip.count] = s;
  strip.inverse[strip.count] = inverse;
  strip.count = strip.count + 1;
  strip.lo = min(strip.lo, s.x);
  strip.hi = max(strip.hi, s.z);
}

// The first crossings of edges with the strip's two border lines. A line crosses an even number of edges, since each edge
// contains only its upper end.
struct FarChords {
  vec4 first;  // x, z on the lower line; x, z on the upper line
  bool lower;  // the first crossing of that line has been seen
  bool upper;
};

FAR_KERNEL void far_edge(FAR_INOUT(FarStrip) strip, FAR_INOUT(FarChords) chords, float ax, float ay, float az, float bx,
                         float by, float bz, float from, float to) {
  bool up = ay <= by;
  float px = up ? ax : bx;
  float py = up ? ay : by;
  float pz = up ? az : bz;
  float qx = up ? bx : ax;
  float qy = up ? by : ay;
  float qz = up ? bz : az;
  if (qy < from || py > to) return;
  float t0 = 0.0f;
  float t1 = 1.0f;
  if (py < qy) {
    FAR_PRECISE float height = qy - py;
    FAR_PRECISE float below = from - py;
    FAR_PRECISE float above = to - py;
    t0 = clamp(below / height, 0.0f, 1.0f);
    t1 = clamp(above / height, 0.0f, 1.0f);
  }
  FAR_PRECISE float x0 = px + (qx - px) * t0;
  FAR_PRECISE float z0 = pz + (qz - pz) * t0;
  FAR_PRECISE float x1 = px + (qx - px) * t1;
  FAR_PRECISE float z1 = pz + (qz - pz) * t1;
  far_segment(strip, x0, z0, x1, z1);
  if (py < from && from <= qy) {
    if (chords.lower) far_segment(strip, chords.first.x, chords.first.y, x0, z0);
    chords.lower = true;
    chords.first.x = x0;
    chords.first.y = z0;
  }
  if (py < to && to <= qy) {
    if (chords.upper) far_segment(strip, chords.first.z, chords.first.w, x1, z1);
    chords.upper = true;
    chords.first.z = x1;
    chords.first.w = z1;
  }
}

// The part of the float triangle with from <= y <= to.
FAR_KERNEL void far_strip(vec4 a, vec4 b, vec4 c, float from, float to, FAR_OUT(FarStrip) strip) {
  FarChords chords;
  chords.lower = false;
  chords.upper = false;
  strip.count = 0;
  strip.lo = 3.0e38f;
  strip.hi = -3.0e38f;
  far_edge(strip, chords, a.x, a.y, a.z, b.x, b.y, b.z, from, to);
  far_edge(strip, chords, b.x, b.y, b.z, c.x, c.y, c.z, from, to);
  far_edge(strip, chords, c.x, c.y, c.z, a.x, a.y, a.z, from, to);
}

// The depths of the strip with from <= x <= to; false: it has no point there.
FAR_KERNEL bool far_depths(FAR_INOUT(FarStrip) strip, float from, float to, FAR_OUT(float) near, FAR_OUT(float) far) {
  near = 3.0e38f;
  far = -3.0e38f;
  for (int i = 0; i < strip.count; ++i) {
    vec4 s = strip.segment[i];
    if (s.z < from || s.x > to) continue;
    float z0 = s.y;
    float z1 = s.w;
    if (strip.inverse[i] > 0.0f) {
      FAR_PRECISE float t0 = (from - s.x) * strip.inverse[i];
      FAR_PRECISE float t1 = (to - s.x) * strip.inverse[i];
      FAR_PRECISE float rise = s.w - s.y;
      FAR_PRECISE float at0 = s.y + rise * clamp(t0, 0.0f, 1.0f);
      FAR_PRECISE float at1 = s.y + rise * clamp(t1, 0.0f, 1.0f);
      z0 = at0;
      z1 = at1;
    }
    near = min(near, min(z0, z1));
    far = max(far, max(z0, z1));
  }
  return near <= far;
}

// The depth slice of z, 0 .. 63: never decreasing in z, so two intervals with a common depth have a common slice. It is exact for
// any rounding, so it is one number in all programs (docs/budget.md, "Slices"): steps_per_px is a power of two, int() drops the
// fraction, and the rest is whole numbers. first_step: of the near end; slices_per_step: times 2^16, at most 2^16.
FAR_KERNEL int far_slice(float z, float steps_per_px, int first_step, int slices_per_step) {
  FAR_PRECISE float steps = z * steps_per_px;
  int step = int(clamp(steps, -1073741824.0f, 1073741824.0f)) - first_step;
  step = step < 0 ? 0 : (step > 16383 ? 16383 : step);
  int slice = (step * slices_per_step) >> 16;
  return slice < 63 ? slice : 63;
}

// The part of a cell, 0 .. last, that holds p; from: the cell's lower border (px), parts_per_px: a power of two. Exact for
// any rounding: where p is inside the cell the subtraction is exact, elsewhere its sign or its excess is, and the product
// always is (docs/budget.md, "Parts of a pixel"). A division by the side would not be exact.
FAR_KERNEL int far_part(float p, float from, float parts_per_px, float last) {
  FAR_PRECISE float part = (p - from) * parts_per_px;
  return int(clamp(part, 0.0f, last));
}

// How many pixels the triangle meets, on average over its position: the area of its image, grown by a pixel. For choices
// alone; nothing depends on its accuracy.
FAR_KERNEL float far_footprint(vec4 a, vec4 b, vec4 c, float width, float height) {
  FAR_PRECISE float twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  FAR_PRECISE float count = 0.5f * abs(twice) + width + height + 1.0f;
  return count;
}
