// Finds where the line through a pixel centre along z enters and leaves an oriented box. Widens the interval outward. This file
// compiles as GLSL and as C++, after offsets/slab.glsl.
//
// The solid: three slabs |a.x (x - m.x) + a.y (y - m.y) + a.z (z - m.z)| <= h, cut by zlo <= z <= zhi.
//   s0 = (m, zlo), s1 = (a0, h0), s2 = (a1, h1), s3 = (a2, h2), s4 = (zhi, -, -, -)
// Each component of a normal is at most 2 in magnitude. These floats define the box, so its normals need not have length 1 and
// need not be perpendicular.

FAR_KERNEL FAR_BOOL solid_interval(vec2 c, vec4 s0, vec4 s1, vec4 s2, vec4 s3, vec4 s4, FAR_OUT(float) entry,
                    FAR_OUT(float) exit) {
  FAR_PRECISE vec2 d = c;
  d.x = c.x - s0.x;
  d.y = c.y - s0.y;
  entry = s0.w;
  exit = s4.x;
  FAR_PRECISE float below = abs(s0.w - s0.z);
  FAR_PRECISE float above = abs(s4.x - s0.z);
  FAR_PRECISE float reach = max(below, above) * kUp;
  FAR_BOOL hit = far_slab(d, s0.z, s1, reach, entry, exit) && far_slab(d, s0.z, s2, reach, entry, exit) &&
             far_slab(d, s0.z, s3, reach, entry, exit);
  return hit && entry <= exit;
}
