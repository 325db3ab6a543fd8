// Fragments of proxies that canvas.vert placed.
// FAR_COVERAGE: counts the fragments of each pixel at the pixel that gl_FragCoord names, and writes that pixel into the one that
// the rasterizer chose, so that the two can be compared. FAR_DISCARD: may discard, and never does.
// FAR_DEPTH: writes a given depth, and marks the pixel if the depth test let it pass: by a colour, since buffer writes also happen
// for fragments that fail a late depth test.
// FAR_TRANSPORT: returns the bits that reached a fragment by flat varyings (20 words a slot) and by uniforms (256 words in all).
#if defined(FAR_COVERAGE)
layout(std430, binding = 2) buffer Counts { uint counts[]; };
layout(location = 0) out uint place;

#ifdef FAR_DISCARD
flat in uint v_slot;
#endif
uniform uint u_width;   // of the target, px
uniform float u_shift;  // px; other than 0 only in the twin of the probe

void main() {
#ifdef FAR_DISCARD
  if (v_slot == 0xffffffffu) discard;
#endif
  uvec2 pixel = uvec2(floor(gl_FragCoord.xy + vec2(u_shift)));
  uint at = pixel.y * u_width + pixel.x;
  if (at < uint(counts.length())) atomicAdd(counts[at], 1u);
  place = at + 1u;
}
#elif defined(FAR_DEPTH)
flat in uint v_slot;
flat in vec4 v_solid4;
layout(location = 0) out uint mark;

void main() {
  gl_FragDepth = v_solid4.z;
  mark = v_slot + 1u;
}
#else
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
#endif
