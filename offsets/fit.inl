// Fits solids and rectangles to the corners of a primitive, in double. The file compiles for
// scalars (any number of corners) and for SIMD lanes (one triangle per lane). The including file
// provides dvec3, min, max, abs and sqrt as in GLSL, and FAR_NEAREST, which rounds to float.
// offsets/rounding.h has the constants kFit...

// ---- vectors ----

FAR_KERNEL dvec3 fit_sub(dvec3 a, dvec3 b) {
  dvec3 out = {a.x - b.x, a.y - b.y, a.z - b.z};
  return out;
}
FAR_KERNEL dvec3 fit_scaled(double s, dvec3 a) {
  dvec3 out = {s * a.x, s * a.y, s * a.z};
  return out;
}
FAR_KERNEL double fit_dot(dvec3 a, dvec3 b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
FAR_KERNEL dvec3 fit_cross(dvec3 a, dvec3 b) {
  dvec3 out = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  return out;
}
FAR_KERNEL dvec3 fit_choose(FAR_BOOL c, dvec3 a, dvec3 b) {
  dvec3 out = {FAR_SELECT(c, a.x, b.x), FAR_SELECT(c, a.y, b.y), FAR_SELECT(c, a.z, b.z)};
  return out;
}

// ---- rounding outward ----

// Returns a float at or above x, at most two floats above the least such float. x + |x| 2^-24 is at
// least half a unit in the last place above x. Rounding to nearest lowers the sum by at most half a
// unit. kFitHalfUlp also covers rounding in double; kFitSubnormal covers subnormals.
FAR_KERNEL double fit_up(double x) { return FAR_NEAREST(x + abs(x) * kFitHalfUlp + kFitSubnormal); }
FAR_KERNEL double fit_down(double x) { return -fit_up(-x); }
// fit_below() returns a float <= z - radius. fit_above() returns a float >= z + radius.
FAR_KERNEL double fit_below(double z, double radius) {
  return fit_down(z - radius - kFitDepth * (abs(z) + radius));
}
FAR_KERNEL double fit_above(double z, double radius) {
  return fit_up(z + radius + kFitDepth * (abs(z) + radius));
}

// Sets depths to a lower and an upper bound of z in the fattened primitive. Both are floats.
FAR_KERNEL void fit_depths(const dvec3* p, int count, double radius, double* depths) {
  double lowest = p[0].z;
  double highest = p[0].z;
  for (int k = 1; k < count; ++k) {
    lowest = min(lowest, p[k].z);
    highest = max(highest, p[k].z);
  }
  depths[0] = fit_below(lowest, radius);
  depths[1] = fit_above(highest, radius);
}

// ---- the proxy's rectangle ----

// Computes a rectangle within |x| <= bound_x, |y| <= bound_y around the image of the points,
// fattened by a disc. Prefers a rectangle parallel to the longest edge of the image. If this
// rectangle exceeds the bounds, takes an axis-aligned rectangle, cut off at the bounds. `corners`:
// x, y of four corners, counterclockwise, rounded to nearest (term "input" of the error budget).
FAR_KERNEL void fit_rectangle(const dvec3* p, int count, double radius, double bound_x, double bound_y, double* corners) {
  double ux = 1.0;
  double uy = 0.0;
  double longest2 = 1e-200;  // squared length; a shorter edge counts as a point
  for (int i = 0; i < count; ++i) {
    const dvec3 e = fit_sub(p[(i + 1) % count], p[i]);
    const double length2 = e.x * e.x + e.y * e.y;
    const FAR_BOOL longer = length2 > longest2;
    ux = FAR_SELECT(longer, e.x, ux);
    uy = FAR_SELECT(longer, e.y, uy);
    longest2 = FAR_SELECT(longer, length2, longest2);
  }
  const double inverse = 1.0 / sqrt(ux * ux + uy * uy);
  ux = ux * inverse;
  uy = uy * inverse;
  double lo_s = ux * p[0].x + uy * p[0].y;
  double lo_t = ux * p[0].y - uy * p[0].x;
  double hi_s = lo_s;
  double hi_t = lo_t;
  double lo_x = p[0].x;
  double hi_x = p[0].x;
  double lo_y = p[0].y;
  double hi_y = p[0].y;
  for (int i = 1; i < count; ++i) {
    const double s = ux * p[i].x + uy * p[i].y;
    const double t = ux * p[i].y - uy * p[i].x;
    lo_s = min(lo_s, s);
    hi_s = max(hi_s, s);
    lo_t = min(lo_t, t);
    hi_t = max(hi_t, t);
    lo_x = min(lo_x, p[i].x);
    hi_x = max(hi_x, p[i].x);
    lo_y = min(lo_y, p[i].y);
    hi_y = max(hi_y, p[i].y);
  }
  const double s[4] = {lo_s - radius, hi_s + radius, hi_s + radius, lo_s - radius};
  const double t[4] = {lo_t - radius, lo_t - radius, hi_t + radius, hi_t + radius};
  double reach_x = 0.0;
  double reach_y = 0.0;
  for (int i = 0; i < 4; ++i) {
    corners[2 * i] = s[i] * ux - t[i] * uy;
    corners[2 * i + 1] = s[i] * uy + t[i] * ux;
    reach_x = max(reach_x, abs(corners[2 * i]));
    reach_y = max(reach_y, abs(corners[2 * i + 1]));
  }
  const FAR_BOOL fits = reach_x <= bound_x && reach_y <= bound_y;
  const double x0 = max(lo_x - radius, -bound_x);
  const double x1 = min(hi_x + radius, bound_x);
  const double y0 = max(lo_y - radius, -bound_y);
  const double y1 = min(hi_y + radius, bound_y);
  const double cut_x[4] = {x0, x1, x1, x0};
  const double cut_y[4] = {y0, y0, y1, y1};
  for (int i = 0; i < 4; ++i) {
    corners[2 * i] = FAR_NEAREST(FAR_SELECT(fits, corners[2 * i], cut_x[i]));
    corners[2 * i + 1] = FAR_NEAREST(FAR_SELECT(fits, corners[2 * i + 1], cut_y[i]));
  }
}

// ---- the oriented box ----

// Chooses three directions: the longest edge, the perpendicular from this edge to the farthest
// point, and their normal. Any directions are sound, since the extents are measured later.
FAR_KERNEL void fit_directions(const dvec3* p, int count, dvec3* rows) {
  dvec3 along = {1.0, 0.0, 0.0};
  dvec3 base = p[0];
  double longest2 = 1e-200;  // squared length; a shorter edge counts as a point
  for (int i = 0; i < count; ++i) {
    const dvec3 e = fit_sub(p[(i + 1) % count], p[i]);
    const double length2 = fit_dot(e, e);
    const FAR_BOOL longer = length2 > longest2;
    along = fit_choose(longer, e, along);
    base = fit_choose(longer, p[i], base);
    longest2 = FAR_SELECT(longer, length2, longest2);
  }
  along = fit_scaled(1.0 / sqrt(fit_dot(along, along)), along);
  dvec3 across = {0.0, 0.0, 0.0};
  double farthest2 = 0.0;
  for (int i = 0; i < count; ++i) {
    const dvec3 d = fit_sub(p[i], base);
    dvec3 off = fit_sub(d, fit_scaled(fit_dot(along, d), along));
    off = fit_sub(off, fit_scaled(fit_dot(along, off), along));  // orthogonalizes a second time
    const double distance2 = fit_dot(off, off);
    const FAR_BOOL farther = distance2 > farthest2;
    across = fit_choose(farther, off, across);
    farthest2 = FAR_SELECT(farther, distance2, farthest2);
  }
  // If the points are nearly collinear, any perpendicular of `along` is sound as `across`.
  const FAR_BOOL thin = farthest2 <= max(0x1p-80 * longest2, 1e-200);
  const double ax = abs(along.x);
  const double ay = abs(along.y);
  const double az = abs(along.z);
  const dvec3 x = {1.0, 0.0, 0.0};
  const dvec3 y = {0.0, 1.0, 0.0};
  const dvec3 z = {0.0, 0.0, 1.0};
  const dvec3 axis = fit_choose(ax <= ay && ax <= az, x, fit_choose(ay <= az, y, z));
  across = fit_choose(thin, fit_cross(along, axis), across);
  across = fit_scaled(1.0 / sqrt(fit_dot(across, across)), across);
  rows[0] = along;
  rows[1] = across;
  rows[2] = fit_cross(along, across);
}

// Sets `solid` to the box: the 5 x 4 numbers that obb.glsl reads, all of them floats.
FAR_KERNEL void fit_box(const dvec3* p, int count, double radius, double* solid) {
  dvec3 rows[3];
  fit_directions(p, count, rows);
  dvec3 middle = {0.0, 0.0, 0.0};
  for (int i = 0; i < 3; ++i) {
    double lo = fit_dot(rows[i], p[0]);
    double hi = lo;
    for (int k = 1; k < count; ++k) {
      const double s = fit_dot(rows[i], p[k]);
      lo = min(lo, s);
      hi = max(hi, s);
    }
    middle = fit_sub(middle, fit_scaled(-(0.5 * lo + 0.5 * hi), rows[i]));
  }
  const dvec3 centre = {FAR_NEAREST(middle.x), FAR_NEAREST(middle.y), FAR_NEAREST(middle.z)};
  double depths[2];
  fit_depths(p, count, radius, depths);
  solid[0] = centre.x;
  solid[1] = centre.y;
  solid[2] = centre.z;
  solid[3] = depths[0];
  for (int i = 0; i < 3; ++i) {
    const dvec3 n = {FAR_NEAREST(rows[i].x), FAR_NEAREST(rows[i].y), FAR_NEAREST(rows[i].z)};
    double reach = 0.0;
    double size = 0.0;
    for (int k = 0; k < count; ++k) {
      const dvec3 d = fit_sub(p[k], centre);
      reach = max(reach, abs(fit_dot(n, d)));
      size = max(size, (abs(n.x) * abs(d.x) + abs(n.y) * abs(d.y)) + abs(n.z) * abs(d.z));
    }
    // `reach` has an error below 5 * 2^-53 * size. |n| is at most (1 + |n|^2) / 2. kFitBox is
    // larger than the relative rounding errors of `reach` and of `length`.
    const double length = (0.5 + 0.5 * fit_dot(n, n)) * (1.0 + kFitBox);
    solid[4 * i + 4] = n.x;
    solid[4 * i + 5] = n.y;
    solid[4 * i + 6] = n.z;
    solid[4 * i + 7] = fit_up(reach + kFitBox * size + radius * length);
  }
  solid[16] = depths[1];
  solid[17] = 0.0;
  solid[18] = 0.0;
  solid[19] = 0.0;
}

// ---- the exact offset ----

// Sets `solid` to the triangle p fattened by a ball: the 5 x 4 numbers that minkowski.glsl reads.
// Rounding moves the corners, so the radius grows by the largest displacement.
FAR_KERNEL void fit_minkowski(const dvec3* p, double radius, double* solid) {
  const dvec3 lo = {min(min(p[0].x, p[1].x), p[2].x), min(min(p[0].y, p[1].y), p[2].y), min(min(p[0].z, p[1].z), p[2].z)};
  const dvec3 hi = {max(max(p[0].x, p[1].x), p[2].x), max(max(p[0].y, p[1].y), p[2].y), max(max(p[0].z, p[1].z), p[2].z)};
  const dvec3 centre = {FAR_NEAREST(0.5 * lo.x + 0.5 * hi.x), FAR_NEAREST(0.5 * lo.y + 0.5 * hi.y),
                        FAR_NEAREST(0.5 * lo.z + 0.5 * hi.z)};
  solid[0] = centre.x;
  solid[1] = centre.y;
  solid[2] = centre.z;
  double depths[2];
  fit_depths(p, 3, radius, depths);
  solid[3] = depths[0];
  double lost2 = 0.0;
  double size2 = 0.0;
  for (int i = 0; i < 3; ++i) {
    const dvec3 d = fit_sub(p[i], centre);
    const dvec3 v = {FAR_NEAREST(d.x), FAR_NEAREST(d.y), FAR_NEAREST(d.z)};
    const dvec3 lost = fit_sub(d, v);
    lost2 = max(lost2, fit_dot(lost, lost));
    size2 = max(size2, fit_dot(d, d));
    solid[4 * i + 4] = v.x;
    solid[4 * i + 5] = v.y;
    solid[4 * i + 6] = v.z;
    solid[4 * i + 7] = 0.0;
  }
  // Second term: rounding of the subtraction, 2^-53 |d| per axis. Third term: components below
  // 2^-511, whose squares are below the normal doubles.
  const double displaced = sqrt(lost2) + kFitCorner * sqrt(size2) + kFitUnderflow;
  solid[7] = fit_up((radius + displaced) * (1.0 + kFitRadius));
  solid[11] = depths[1];
  solid[16] = 0.0;
  solid[17] = 0.0;
  solid[18] = 0.0;
  solid[19] = 0.0;
}
