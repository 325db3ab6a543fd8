// Finds where the line through a pixel centre along z enters and leaves a triangle fattened by a ball. Widens the interval
// outward. This file compiles as GLSL and as C++, after offsets/slab.glsl.
//
// The solid: hull(v0, v1, v2) + ball(r), cut by zlo <= z <= zhi; a degenerate triangle makes it a capsule or a ball.
//   s0 = (m, zlo), s1 = (v0 - m, r), s2 = (v1 - m, zhi), s3 = (v2 - m, -); r <= 2^20
// The surface has three spheres, three cylinders along the edges and the two shifted triangles. The line's first and last
// contact with each part is found in plain float arithmetic, and only serves to choose a normal. Any normal n bounds the solid
// by the halfspace n . p <= max n . v_i + r |n|, so an inaccurate contact cannot make the returned bound wrong. If the contact
// is accurate, the halfspace touches the solid there (docs/budget.md, "The exact offset"). The extent along n, the length of n
// and the halfspace must use the same bits of n. In GLSL, a variable that is not `precise` may be recomputed with other
// roundings at each use. So every variable that holds a normal is precise, and so are the parameters through which a function
// returns a normal (docs/budget.md, "One normal").

// Returns an upper bound of n . (p - m) over all points p of the solid.
FAR_KERNEL float far_extent(vec4 n, vec4 v0, vec4 v1, vec4 v2) {
  FAR_PRECISE float a0 = abs(n.x * v0.x) + abs(n.y * v0.y) + abs(n.z * v0.z);
  FAR_PRECISE float a1 = abs(n.x * v1.x) + abs(n.y * v1.y) + abs(n.z * v1.z);
  FAR_PRECISE float a2 = abs(n.x * v2.x) + abs(n.y * v2.y) + abs(n.z * v2.z);
  FAR_PRECISE float q0 = n.x * v0.x + n.y * v0.y + n.z * v0.z;
  FAR_PRECISE float q1 = n.x * v1.x + n.y * v1.y + n.z * v1.z;
  FAR_PRECISE float q2 = n.x * v2.x + n.y * v2.y + n.z * v2.z;
  FAR_PRECISE float e = max(max(a0, a1), a2) * kEightU + kTiny;
  FAR_PRECISE float squared = n.x * n.x + n.y * n.y + n.z * n.z;
  // The bound |n| <= (1 + |n|^2) / 2 needs no root. It exceeds |n| by (|n| - 1)^2 / 2.
  FAR_PRECISE float length = (0.5f + 0.5f * squared) * kUp * kUp;
  FAR_PRECISE float ball = v0.w * length * kUp;
  FAR_PRECISE float sum = max(max(q0, q1), q2) + e + ball;
  FAR_PRECISE float extent = sum + abs(sum) * kEightU;  // a return value cannot be `precise`
  return extent;
}

// Cuts [lo, hi] with the solid's halfspace of normal n. Returns false if the line misses the
// halfspace. If |n|^2 is not between 1/4 and 4, nothing is cut.
FAR_KERNEL FAR_BOOL far_touch(vec2 d, float mz, vec4 n, vec4 v0, vec4 v1, vec4 v2, float reach, FAR_INOUT(float) lo,
                   FAR_INOUT(float) hi) {
  float squared = n.x * n.x + n.y * n.y + n.z * n.z;
  FAR_BOOL usable = squared > 0.25f && squared < 4.0f;
  float cut_lo = lo;
  float cut_hi = hi;
  FAR_BOOL hit = far_halfspace(d, mz, n, far_extent(n, v0, v1, v2), reach, cut_lo, cut_hi);
  lo = FAR_SELECT(usable, cut_lo, lo);
  hi = FAR_SELECT(usable, cut_hi, hi);
  return !usable || hit;
}

// Finds the line's first (sign -1) or last (sign 1) contact with the capsule around edge a, b. n
// stores the outermost contact so far: x, y, z the normal, w the z coordinate.
FAR_KERNEL void far_edge(vec2 d, vec4 a, vec4 b, float r, float sign, FAR_PRECISE FAR_INOUT(vec4) n) {
  float fx = b.x - a.x;
  float fy = b.y - a.y;
  float fz = b.z - a.z;
  float px = a.x - d.x;
  float py = a.y - d.y;
  float along2 = fx * fx + fy * fy;
  float t = FAR_SELECT(sign * fz > 0.0f, 1.0f, 0.0f);
  FAR_BOOL met = FAR_BOOL(true);
  if (FAR_UNIFORM(along2 > 1e-12f)) {
    float cross = px * fy - py * fx;
    float rho2 = r * r - cross * cross / along2;
    met = !(rho2 <= 0.0f);
    float foot = -(px * fx + py * fy) / along2;
    float shift = sign * fz * sqrt(max(rho2, 0.0f) / (along2 + fz * fz)) / sqrt(along2);
    t = min(max(foot + shift, 0.0f), 1.0f);
  }
  float cx = px + t * fx;
  float cy = py + t * fy;
  float q = r * r - cx * cx - cy * cy;
  met = met && !(q < 0.0f);
  float root = sqrt(max(q, 0.0f));
  float z = a.z + t * fz + sign * root;
  FAR_BOOL beyond = met && sign * z > sign * n.w;
  float scale = 1.0f / max(r, 1e-20f);
  n.x = FAR_SELECT(beyond, -cx * scale, n.x);
  n.y = FAR_SELECT(beyond, -cy * scale, n.y);
  n.z = FAR_SELECT(beyond, sign * root * scale, n.z);
  n.w = FAR_SELECT(beyond, z, n.w);
}

// n stores the edge nearest to the pixel centre in the image: x, y, z the direction from edge to
// centre, w the squared distance. Replaces n if edge a, b is nearer.
FAR_KERNEL void far_outward(vec2 d, vec4 a, vec4 b, FAR_PRECISE FAR_INOUT(vec4) n) {
  float fx = b.x - a.x;
  float fy = b.y - a.y;
  float px = a.x - d.x;
  float py = a.y - d.y;
  float along2 = fx * fx + fy * fy;
  float t = 0.0f;
  if (FAR_UNIFORM(along2 > 1e-12f)) t = min(max(-(px * fx + py * fy) / along2, 0.0f), 1.0f);
  float cx = px + t * fx;
  float cy = py + t * fy;
  float distance2 = cx * cx + cy * cy;
  FAR_BOOL nearer = distance2 < n.w && distance2 > 1e-12f;
  float scale = 1.0f / sqrt(max(distance2, 1e-12f));
  n.x = FAR_SELECT(nearer, -cx * scale, n.x);
  n.y = FAR_SELECT(nearer, -cy * scale, n.y);
  n.z = FAR_SELECT(nearer, 0.0f, n.z);
  n.w = FAR_SELECT(nearer, distance2, n.w);
}

FAR_KERNEL FAR_BOOL solid_interval(vec2 c, vec4 s0, vec4 s1, vec4 s2, vec4 s3, vec4 s4, FAR_OUT(float) entry, FAR_OUT(float) exit) {
  FAR_PRECISE vec2 d = c;
  d.x = c.x - s0.x;
  d.y = c.y - s0.y;
  float mz = s0.z;
  float r = s1.w;
  entry = s0.w;
  exit = s2.w;
  FAR_PRECISE float below = abs(entry - mz);
  FAR_PRECISE float above = abs(exit - mz);
  FAR_PRECISE float reach = max(below, above) * kUp;

  // Cuts with the planes of the two shifted triangles.
  float ux = s2.x - s1.x;
  float uy = s2.y - s1.y;
  float uz = s2.z - s1.z;
  float vx = s3.x - s1.x;
  float vy = s3.y - s1.y;
  float vz = s3.z - s1.z;
  FAR_PRECISE vec4 plane = s4;
  plane.x = uy * vz - uz * vy;
  plane.y = uz * vx - ux * vz;
  plane.z = ux * vy - uy * vx;
  float largest = max(max(abs(plane.x), abs(plane.y)), max(abs(plane.z), 1e-30f));
  plane.x = plane.x / largest;
  plane.y = plane.y / largest;
  plane.z = plane.z / largest;
  float scale = 1.0f / sqrt(max(plane.x * plane.x + plane.y * plane.y + plane.z * plane.z, 1e-20f));
  plane.x = FAR_FIXED(plane.x * scale);
  plane.y = FAR_FIXED(plane.y * scale);
  plane.z = FAR_FIXED(plane.z * scale);
  FAR_BOOL hit = far_touch(d, mz, plane, s1, s2, s3, reach, entry, exit);
  plane.x = -plane.x;
  plane.y = -plane.y;
  plane.z = -plane.z;
  hit = far_touch(d, mz, plane, s1, s2, s3, reach, entry, exit) && hit;

  // Cuts beside the triangle's image: the normal points from the image to the pixel centre.
  FAR_PRECISE vec4 aside = s4;
  aside.x = 0.0f;
  aside.y = 0.0f;
  aside.z = 0.0f;
  aside.w = 1e30f;
  far_outward(d, s1, s2, aside);
  far_outward(d, s2, s3, aside);
  far_outward(d, s3, s1, aside);
  aside.x = FAR_FIXED(aside.x);
  aside.y = FAR_FIXED(aside.y);
  hit = far_touch(d, mz, aside, s1, s2, s3, reach, entry, exit) && hit;

  // Cuts with the normals of the first and last contact with the capsules around the edges.
  FAR_PRECISE vec4 first = s4;
  first.x = 0.0f;
  first.y = 0.0f;
  first.z = 0.0f;
  first.w = 1e30f;
  far_edge(d, s1, s2, r, -1.0f, first);
  far_edge(d, s2, s3, r, -1.0f, first);
  far_edge(d, s3, s1, r, -1.0f, first);
  FAR_PRECISE vec4 last = s4;
  last.x = 0.0f;
  last.y = 0.0f;
  last.z = 0.0f;
  last.w = -1e30f;
  far_edge(d, s1, s2, r, 1.0f, last);
  far_edge(d, s2, s3, r, 1.0f, last);
  far_edge(d, s3, s1, r, 1.0f, last);
  first.x = FAR_FIXED(first.x);
  first.y = FAR_FIXED(first.y);
  first.z = FAR_FIXED(first.z);
  last.x = FAR_FIXED(last.x);
  last.y = FAR_FIXED(last.y);
  last.z = FAR_FIXED(last.z);
  hit = far_touch(d, mz, first, s1, s2, s3, reach, entry, exit) && hit;
  hit = far_touch(d, mz, last, s1, s2, s3, reach, entry, exit) && hit;
  return hit && entry <= exit;
}
