// Fragment programs of the probes; canvas.vert places the proxies. One define selects the program:
// FAR_COVERAGE: counts the fragments of the pixel at gl_FragCoord, and writes the number of this
// pixel as colour. If the colour is stored in a pixel with another number, gl_FragCoord is wrong.
// FAR_DISCARD, with FAR_COVERAGE: adds a discard that never happens.
// FAR_DEPTH: writes a given depth, and a colour that marks the pixel if the depth test passes.
// FAR_ARITHMETIC: stores the bits of the results of the operations that kernels use.
// No define: stores the bits that a fragment reads from flat varyings (20 words for each slot) and
// from uniforms (256 words in all).
#if defined(FAR_COVERAGE)
layout(std430, binding = 2) buffer Counts { uint counts[]; };
layout(location = 0) out uint place;

#ifdef FAR_DISCARD
flat in uint v_slot;
#endif
uniform uint u_width;   // width of the target, px
uniform float u_shift;  // px; 0 unless ProbeOptions::shifted_pixel is set

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
#elif defined(FAR_ARITHMETIC)
layout(std430, binding = 2) readonly buffer Operands { vec4 operands[]; };  // a, b, c, unused
layout(std430, binding = 3) writeonly buffer Results { uvec4 results[]; };  // three for each case

void probe_case(uint i) {
  float a = operands[i].x;
  float b = operands[i].y;
  float c = operands[i].z;
  FAR_PRECISE float sum = a + b;
  FAR_PRECISE float difference = a - b;
  FAR_PRECISE float product = a * b;
  FAR_PRECISE float quotient = a / b;
  FAR_PRECISE float chain = difference + b;   // a, if the compiler simplifies
  FAR_PRECISE float remainder = product - c;  // rounding error of a * b, if contracted
  float least = min(a, b);
  float most = max(a, b);
  float size = abs(a);
  uint order = (a < b ? 1u : 0u) | (a <= b ? 2u : 0u) | (a > b ? 4u : 0u) | (a >= b ? 8u : 0u) |
               (a == b ? 16u : 0u) | (a != b ? 32u : 0u);
  results[3u * i] = floatBitsToUint(vec4(sum, difference, product, quotient));
  results[3u * i + 1u] = floatBitsToUint(vec4(chain, remainder, least, most));
  results[3u * i + 2u] = uvec4(floatBitsToUint(size), order, floatBitsToUint(a), floatBitsToUint(c));
}

uniform uint u_width;  // width of the target, px

void main() {
  uvec2 pixel = uvec2(floor(gl_FragCoord.xy));
  probe_case(pixel.y * u_width + pixel.x);
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
