// Entry and exit of the line through a pixel centre with an oriented box, widened outward. One text for GLSL and C++.
//
// The solid: three slabs |a.x (x - m.x) + a.y (y - m.y) + a.z (z - m.z)| <= h, cut by zlo <= z <= zhi.
//   s0 = (m, zlo), s1 = (a0, h0), s2 = (a1, h1), s3 = (a2, h2), s4 = (zhi, -, -, -)
// |a| <= 2 per component, so a slab's normal need be neither unit nor orthogonal: the box is what these floats say it is.
// With u = 2^-23 per operation in any rounding mode, 2.5 u for a division (GLSL 4.50, 4.7.1; |divisor| >= 2^-20 here, the
// quotient < 2^126), and results below 2^-126 flushed. The constants are derived in docs/budget.md, "The oriented box".

// Cuts [lo, hi] with one slab; false: the line misses it. d = c - m.xy, reach >= |z - m.z| on the solid.
bool far_slab(vec2 d, float mz, vec4 slab, float reach, FAR_INOUT(float) lo,
              FAR_INOUT(float) hi) {
  FAR_PRECISE float sx = slab.x * d.x;
  FAR_PRECISE float sy = slab.y * d.y;
  FAR_PRECISE float s = sx + sy;
  FAR_PRECISE float e = (abs(sx) + abs(sy)) * 9.5367431640625e-7 + 1e-30;  // 8 u
  FAR_PRECISE float h = (slab.w + e) * 1.00000095367431640625;             // 1 + 8 u
  float steep = abs(slab.z);
  if (steep < 9.5367431640625e-7) {  // 2^-20: the slab is all but parallel to the line
    FAR_PRECISE float slack = steep * reach * 1.00000095367431640625;
    FAR_PRECISE float limit = (h + slack) * 1.00000095367431640625;
    return abs(s) <= limit;
  }
  FAR_PRECISE float t0 = (-h - s) / slab.z;
  FAR_PRECISE float t1 = (h - s) / slab.z;
  FAR_PRECISE float w0 = abs(t0) * 9.5367431640625e-7 + 1e-30;
  FAR_PRECISE float w1 = abs(t1) * 9.5367431640625e-7 + 1e-30;
  FAR_PRECISE float near = min(t0 - w0, t1 - w1);
  FAR_PRECISE float far = max(t0 + w0, t1 + w1);
  FAR_PRECISE float near_error = (abs(mz) + abs(near)) * 4.76837158203125e-7;  // 4 u
  FAR_PRECISE float far_error = (abs(mz) + abs(far)) * 4.76837158203125e-7;
  FAR_PRECISE float z0 = (mz + near) - near_error;
  FAR_PRECISE float z1 = (mz + far) + far_error;
  lo = max(lo, z0);
  hi = min(hi, z1);
  return true;
}

bool solid_interval(vec2 c, vec4 s0, vec4 s1, vec4 s2, vec4 s3, vec4 s4, FAR_OUT(float) entry,
                    FAR_OUT(float) exit) {
  vec2 d = c;
  d.x = c.x - s0.x;
  d.y = c.y - s0.y;
  entry = s0.w;
  exit = s4.x;
  FAR_PRECISE float below = abs(s0.w - s0.z);
  FAR_PRECISE float above = abs(s4.x - s0.z);
  FAR_PRECISE float reach = max(below, above) * 1.00000095367431640625;
  bool hit = far_slab(d, s0.z, s1, reach, entry, exit) && far_slab(d, s0.z, s2, reach, entry, exit) &&
             far_slab(d, s0.z, s3, reach, entry, exit);
  return hit && entry <= exit;
}
