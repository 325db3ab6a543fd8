// Depth slices (core/pairs/interval.glsl stands before this text), and the conversion that chooses a pixel. A case: z, steps per
// px, first step, slices per step; x.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Cases { uvec4 cases[]; };
layout(std430, binding = 1) writeonly buffer Answers { ivec2 answers[]; };
layout(location = 0) uniform uint u_count;

void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w >= u_count) return;
  uvec4 c = cases[2u * w];
  float x = uintBitsToFloat(cases[2u * w + 1u].x);
  answers[w] = ivec2(far_slice(uintBitsToFloat(c.x), uintBitsToFloat(c.y), int(c.z), int(c.w)), int(clamp(x, 0.0f, 65536.0f)));
}
