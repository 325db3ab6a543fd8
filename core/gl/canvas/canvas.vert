// Reads the element of each draw of a batch, and places its vertices. A batch is a sequence of
// draws that belong to one step and read one element buffer. FAR_PROXY: an element is a
// quadrilateral of two triangles (seven vec4). Otherwise an element is a triangle (three vec4).
// FAR_ECHO: each buffer begins with a tag. A batch begins with a head: this pass's serial number,
// and the index of the batch's word in the report. The batch's first vertex writes an echo to this
// word: a checksum of the values that both shaders read (core/gl/base/objects.h).
#ifdef FAR_ECHO
layout(std430, binding = 0) readonly buffer Elements { uvec4 elements_tag; vec4 elements[]; };
layout(std430, binding = 1) readonly buffer Draws { uvec2 head; uvec2 draws[]; };
layout(std430, binding = 3) buffer Report { uvec4 report_tag; uint report[]; };
uniform uint u_program;  // unique among the programs of the process
uniform ivec4 u_window;  // from here to #else: uniforms of canvas.frag, read here for the echo
uniform vec2 u_centre;
#ifdef FAR_FLAGS
layout(std430, binding = 2) buffer Flags { uvec4 flags_tag; uint flags[]; };
uniform uint u_serial;
uniform bool u_touching;
#endif
#else
layout(std430, binding = 0) readonly buffer Elements { vec4 elements[]; };
layout(std430, binding = 1) readonly buffer Draws { uvec2 draws[]; };  // element, slot
#endif

uniform vec2 u_to_ndc;   // 2 / viewport side: powers of two, so the product is exact
uniform float u_scale;   // scale of the depth map

flat out uint v_slot;
flat out uint v_fixed;  // 1: the canvas's own element: fixed depth, drawn outside the window, too
#ifdef FAR_PROXY
flat out vec4 v_solid0, v_solid1, v_solid2, v_solid3, v_solid4;
#endif
// A control item must be tested at exactly the depth that another program stored.
invariant gl_Position;

#ifdef FAR_ECHO
uint far_echo() {
  uint sum = 0u;
  uvec2 to_ndc = floatBitsToUint(u_to_ndc);
  uvec2 centre = floatBitsToUint(u_centre);
  uvec4 window = uvec4(u_window);
  FAR_ADD(0u, u_program)
  FAR_ADD(1u, head.x)
  FAR_ADD(2u, to_ndc.x) FAR_ADD(3u, to_ndc.y)
  FAR_ADD(4u, floatBitsToUint(u_scale))
  FAR_ADD(5u, window.x) FAR_ADD(6u, window.y) FAR_ADD(7u, window.z) FAR_ADD(8u, window.w)
  FAR_ADD(9u, centre.x) FAR_ADD(10u, centre.y)
  FAR_ADD(11u, elements_tag.x)
  FAR_ADD(12u, report_tag.x)
#ifdef FAR_FLAGS
  FAR_ADD(13u, flags_tag.x)
  FAR_ADD(14u, u_serial)
  FAR_ADD(15u, uint(u_touching))
#endif
  return sum;
}
#endif

void main() {
#ifdef FAR_PROXY
  const uint corner_of[6] = uint[6](0u, 1u, 2u, 0u, 2u, 3u);
  uvec2 item = FAR_AT(draws, gl_VertexID / 6);
  uint corner = corner_of[gl_VertexID % 6];
  uint at = item.x * 7u;
  vec4 pair = FAR_AT(elements, at + corner / 2u);
  precise vec2 p = (corner % 2u == 0u ? pair.xy : pair.zw) * u_to_ndc;
  v_solid0 = FAR_AT(elements, at + 2u);
  v_solid1 = FAR_AT(elements, at + 3u);
  v_solid2 = FAR_AT(elements, at + 4u);
  v_solid3 = FAR_AT(elements, at + 5u);
  v_solid4 = FAR_AT(elements, at + 6u);
  v_fixed = v_solid4.y != 0.0 ? 1u : 0u;
  gl_Position = vec4(p, 0.0, 1.0);
#else
  uvec2 item = FAR_AT(draws, gl_VertexID / 3);
  vec4 corner = FAR_AT(elements, item.x * 3u + uint(gl_VertexID % 3));
  precise vec2 p = corner.xy * u_to_ndc;
  v_fixed = corner.w != 0.0 ? 1u : 0u;
  precise float ndc = corner.w != 0.0 ? 2.0 * corner.z - 1.0 : 2.0 * (corner.z * u_scale);
  gl_Position = vec4(p, ndc, 1.0);
#endif
  v_slot = item.y;
#ifdef FAR_ECHO
  // Computed outside the `if`, so that llvmpipe reads once for all vertices of a vector.
  uint word = head.y, echo = far_echo();
  if (gl_VertexID == 0) FAR_AT(report, word) = echo;
#endif
}
