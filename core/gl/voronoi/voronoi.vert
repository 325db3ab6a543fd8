// Places the rectangle of a triangle over the cells of a brick, and hands on the triangle and the echo of all that is read.
layout(std430, binding = 0) readonly buffer Triangles { uvec4 triangles_tag; uvec4 triangles[]; };  // corners; .w of the first: object
layout(std430, binding = 1) readonly buffer Items { uvec4 items_tag; uvec4 items[]; };  // triangle; x, y of the ends, 16 bits each
layout(std430, binding = 2) buffer Report { uvec4 report_tag; uint report[]; };
layout(std430, binding = 3) buffer List { uvec4 list_tag; uint list[]; };
uniform uint u_serial;    // no other pass of the process has it
uniform uint u_pass;
uniform uint u_width;     // cells
uniform uint u_capacity;  // of the list
uniform vec2 u_to_ndc;    // 2 / cells
uniform vec4 u_numbers;   // z of the centres, error, scale of the depth, reach
uniform float u_unscale;  // 1 / scale of the depth

flat out vec3 v_a, v_b, v_c;
flat out uvec2 v_id;  // triangle, object
flat out uint v_echo;

void main() {
  const uint corner_of[6] = uint[6](0u, 1u, 3u, 0u, 3u, 2u);
  uvec4 item = items[gl_VertexID / 6];
  uint corner = corner_of[gl_VertexID % 6];
  uvec4 a = triangles[3u * item.x], b = triangles[3u * item.x + 1u], c = triangles[3u * item.x + 2u];
  uint x = corner % 2u == 0u ? item.y & 0xffffu : item.y >> 16;
  uint y = corner < 2u ? item.z & 0xffffu : item.z >> 16;
  gl_Position = vec4(float(x) * u_to_ndc.x - 1.0, float(y) * u_to_ndc.y - 1.0, 0.0, 1.0);
  v_a = uintBitsToFloat(a.xyz);
  v_b = uintBitsToFloat(b.xyz);
  v_c = uintBitsToFloat(c.xyz);
  v_id = uvec2(item.x, a.w);
  uvec4 numbers = floatBitsToUint(u_numbers);
  uint sum = 0u;
  FAR_ADD(0u, u_serial) FAR_ADD(1u, u_pass) FAR_ADD(2u, u_width) FAR_ADD(3u, u_capacity)
  FAR_ADD(4u, numbers.x) FAR_ADD(5u, numbers.y) FAR_ADD(6u, numbers.z) FAR_ADD(7u, numbers.w)
  FAR_ADD(8u, triangles_tag.x) FAR_ADD(9u, items_tag.x) FAR_ADD(10u, report_tag.x) FAR_ADD(11u, list_tag.x)
  FAR_ADD(15u, floatBitsToUint(u_unscale))
  FAR_ADD(12u, item.x) FAR_ADD(13u, item.y) FAR_ADD(14u, item.z)
  FAR_ADD(16u, a.x) FAR_ADD(17u, a.y) FAR_ADD(18u, a.z) FAR_ADD(19u, a.w)
  FAR_ADD(20u, b.x) FAR_ADD(21u, b.y) FAR_ADD(22u, b.z)
  FAR_ADD(24u, c.x) FAR_ADD(25u, c.y) FAR_ADD(26u, c.z)
  v_echo = sum;
}
