// Computes one triangle in one pixel as a back end does. No include guard: it stands in the
// namespace of each compilation of core/pairs/interval.glsl, after the kernel. `shrink`: by how
// much the pixel is made smaller on each side, for twins that must fail.

inline farcull::lab::Answer evaluate(const farcull::lab::FloatTriangle& t, float widening, int i,
                                     int j, float shrink = 0) {
  using Scalar = decltype(vec4::x);
  const vec4 widen{widening, widening, widening, 0};
  const vec4 a{t[0][0], t[0][1], t[0][2], 0}, b{t[1][0], t[1][1], t[1][2], 0},
      c{t[2][0], t[2][1], t[2][2], 0};
  vec4 lo, hi;
  far_bounds(a, b, c, widen, lo, hi);
  const vec4 margin = far_margin(lo, hi, widen);
  FarStrip strip;
  far_strip(a, b, c, Scalar(static_cast<float>(j) + shrink) - margin.y,
            Scalar(static_cast<float>(j + 1) - shrink) + margin.y, strip);
  const Scalar row_lo = strip.lo - margin.x, row_hi = strip.hi + margin.x;
  Scalar near, far;
  farcull::lab::Answer out;
  out.hit = far_depths(strip, Scalar(static_cast<float>(i) + shrink) - margin.x,
                       Scalar(static_cast<float>(i + 1) - shrink) + margin.x, near, far);
  near = near - margin.z;
  far = far + margin.z;
  out.lo = {farcull::lab::number(lo.x), farcull::lab::number(lo.y), farcull::lab::number(lo.z)};
  out.hi = {farcull::lab::number(hi.x), farcull::lab::number(hi.y), farcull::lab::number(hi.z)};
  out.row_lo = farcull::lab::number(row_lo);
  out.row_hi = farcull::lab::number(row_hi);
  out.near = farcull::lab::number(near);
  out.far = farcull::lab::number(far);
  return out;
}
