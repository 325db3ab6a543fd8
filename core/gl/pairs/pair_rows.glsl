// The strips of one item over rows of pixels or parts of a pixel, as PairRows of core/pairs/grid.h.
struct FarRows {
  vec4 a;
  vec4 b;
  vec4 c;
  vec4 lo;
  vec4 hi;
  FarStrip strip;
};

// The range along x of the real triangle between y0 and y1; false: none.
bool far_row(inout FarRows rows, float y0, float y1, out float lo, out float hi) {
  precise float below = y0 - rows.b.w;
  precise float above = y1 + rows.b.w;
  far_strip(rows.a, rows.b, rows.c, below, above, rows.strip);
  precise float left = rows.strip.lo - rows.a.w;
  precise float right = rows.strip.hi + rows.a.w;
  lo = max(left, rows.lo.x);
  hi = min(right, rows.hi.x);
  return lo <= hi;
}

// The depth interval over x0 .. x1 of the row; false: none.
bool far_cell(inout FarRows rows, float x0, float x1, out float near, out float far) {
  precise float left = x0 - rows.a.w;
  precise float right = x1 + rows.a.w;
  if (!far_depths(rows.strip, left, right, near, far)) return false;
  precise float least = near - rows.c.w;
  precise float most = far + rows.c.w;
  near = max(least, rows.lo.z);
  far = min(most, rows.hi.z);
  return near <= far;
}
