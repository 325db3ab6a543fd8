// Depth slices (core/pairs/interval.glsl stands before this text), and the conversion that chooses a pixel. A case: z, near end, slices
// per px, x.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Cases { uvec4 cases[]; };
layout(std430, binding = 1) writeonly buffer Answers { ivec2 answers[]; };
layout(location = 0) uniform uint u_count;

void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w >= u_count) return;
  vec4 c = uintBitsToFloat(cases[w]);
  answers[w] = ivec2(far_slice(c.x, c.y, c.z), int(clamp(c.w, 0.0f, 65536.0f)));
}
