// Runs kernels of FAR pairs on given cases, one for each invocation; core/pairs/interval.glsl and pair_rows.glsl stand before
// this file. Without FAR_SLICES: the depth interval of a triangle over a pixel. A case has the corners a, b, c with the
// widening in w, and the pixel; an answer has lo, start of the row; hi, end of the row; near, far, and whether there is an
// interval. With FAR_SLICES: depth slices, and the conversion that chooses a pixel. A case has z, steps per px, first step,
// slices per step, and x, which is converted.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Cases { uvec4 cases[]; };
#ifdef FAR_SLICES
layout(std430, binding = 1) writeonly buffer Answers { ivec2 answers[]; };
#else
layout(std430, binding = 1) writeonly buffer Answers { uvec4 answers[]; };
#endif
layout(location = 0) uniform uint u_count;

#ifdef FAR_SLICES
void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w >= u_count) return;
  uvec4 c = cases[2u * w];
  float x = uintBitsToFloat(cases[2u * w + 1u].x);
  answers[w] = ivec2(far_slice(uintBitsToFloat(c.x), uintBitsToFloat(c.y), int(c.z), int(c.w)), int(clamp(x, 0.0f, 65536.0f)));
}
#else
void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w >= u_count) return;
  vec4 a = uintBitsToFloat(cases[4u * w]);
  vec4 b = uintBitsToFloat(cases[4u * w + 1u]);
  vec4 c = uintBitsToFloat(cases[4u * w + 2u]);
  ivec2 pixel = ivec2(cases[4u * w + 3u].xy);
  vec4 widen = vec4(a.w, a.w, a.w, 0.0);
  a.w = 0.0;
  b.w = 0.0;
  c.w = 0.0;
  FarRows rows;
  far_bounds(a, b, c, widen, rows.lo, rows.hi);
  vec4 margin = far_margin(rows.lo, rows.hi, widen);
  rows.a = vec4(a.xyz, margin.x);
  rows.b = vec4(b.xyz, margin.y);
  rows.c = vec4(c.xyz, margin.z);
  float y = float(pixel.y);
  float x = float(pixel.x);
  float left = 0.0;
  float right = 0.0;
  float near = 0.0;
  float far = 0.0;
  bool hit = far_row(rows, y, y + 1.0, left, right);
  if (hit) hit = far_cell(rows, x, x + 1.0, near, far);
  answers[3u * w] = floatBitsToUint(vec4(rows.lo.xyz, left));
  answers[3u * w + 1u] = floatBitsToUint(vec4(rows.hi.xyz, right));
  answers[3u * w + 2u] = uvec4(floatBitsToUint(near), floatBitsToUint(far), hit ? 1u : 0u, 0u);
}
#endif
