// Counts the fragments of each pixel where gl_FragCoord says they are, and writes that place into the pixel that the
// rasterizer chose, so that the two can be compared. FAR_DISCARD: a program that may discard, and never does.
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
