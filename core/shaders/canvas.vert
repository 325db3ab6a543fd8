// Fetches an element for each draw of a run and places it. FAR_PROXY: a quadrilateral of two triangles that share the
// corners of a diagonal, seven vec4 an element. Otherwise: a triangle, three vec4 an element.
layout(std430, binding = 0) readonly buffer Elements { vec4 elements[]; };
layout(std430, binding = 1) readonly buffer Draws { uvec2 draws[]; };  // element, slot

uniform vec2 u_to_ndc;   // 2 / viewport side: powers of two, so the product is exact
uniform float u_scale;   // of the depth map

flat out uint v_slot;
flat out uint v_fixed;  // 1: an element of the canvas's own, at a fixed depth, drawn outside the window as well
#ifdef FAR_PROXY
flat out vec4 v_solid0, v_solid1, v_solid2, v_solid3, v_solid4;
#endif

void main() {
#ifdef FAR_PROXY
  const uint corner_of[6] = uint[6](0u, 1u, 2u, 0u, 2u, 3u);
  uvec2 item = draws[gl_VertexID / 6];
  uint corner = corner_of[gl_VertexID % 6];
  uint at = item.x * 7u;
  vec4 pair = elements[at + corner / 2u];
  precise vec2 p = (corner % 2u == 0u ? pair.xy : pair.zw) * u_to_ndc;
  v_solid0 = elements[at + 2u];
  v_solid1 = elements[at + 3u];
  v_solid2 = elements[at + 4u];
  v_solid3 = elements[at + 5u];
  v_solid4 = elements[at + 6u];
  v_fixed = v_solid4.y != 0.0 ? 1u : 0u;
  gl_Position = vec4(p, 0.0, 1.0);
#else
  uvec2 item = draws[gl_VertexID / 3];
  vec4 corner = elements[item.x * 3u + uint(gl_VertexID % 3)];
  precise vec2 p = corner.xy * u_to_ndc;
  v_fixed = corner.w != 0.0 ? 1u : 0u;
  precise float ndc = corner.w != 0.0 ? 2.0 * corner.z - 1.0 : 2.0 * (corner.z * u_scale);
  gl_Position = vec4(p, ndc, 1.0);
#endif
  v_slot = item.y;
}
