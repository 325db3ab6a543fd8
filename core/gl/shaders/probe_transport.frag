// Returns the bits of what reached a fragment by flat varyings (20 words a slot) and by uniforms (256 words in all).
flat in uint v_slot;
flat in vec4 v_solid0, v_solid1, v_solid2, v_solid3, v_solid4;
layout(std430, binding = 2) writeonly buffer Varyings { uvec4 varyings[]; };
layout(std430, binding = 3) writeonly buffer Uniforms { uvec4 uniforms[]; };

uniform vec4 u_values[64];

void main() {
  uint at = v_slot * 5u;
  varyings[at] = floatBitsToUint(v_solid0);
  varyings[at + 1u] = floatBitsToUint(v_solid1);
  varyings[at + 2u] = floatBitsToUint(v_solid2);
  varyings[at + 3u] = floatBitsToUint(v_solid3);
  varyings[at + 4u] = floatBitsToUint(v_solid4);
  if (v_slot < 64u) uniforms[v_slot] = floatBitsToUint(u_values[v_slot]);
}
