// Computes the distance of one triangle from one cell. Pass 0 keeps the nearest object by the depth test; 1 keeps the nearest
// of the others; 2 compares every distance with what 0 and 1 kept. 3 keeps the least upper bound; 4 compares every upper bound
// with it, and lists the triangles whose lower bound is not much larger. Each fragment adds its echo to the report of the cell,
// so that a lost fragment is noticed.
layout(std430, binding = 2) buffer Report { uvec4 report_tag; uint report[]; };  // of each cell: echoes, flags, two objects
layout(std430, binding = 3) buffer List { uvec4 list_tag; uint list[]; };  // how many, 3 unused; cell, triangle, bounds of each
layout(binding = 0) uniform sampler2D u_first_depth;
layout(binding = 1) uniform usampler2D u_first;
layout(binding = 2) uniform sampler2D u_second_depth;
layout(binding = 3) uniform usampler2D u_second;
uniform uint u_pass;
uniform uint u_width;
uniform uint u_capacity;
uniform vec4 u_numbers;
uniform float u_unscale;  // 1 / scale of the depth; both are powers of two, so products are exact

flat in vec3 v_a, v_b, v_c;
flat in uvec2 v_id;
flat in uint v_echo;
layout(location = 0) out uint o_object;

// Flags of a cell.
const uint kFirst = 1u;   // what the first pass kept is the distance of some triangle
const uint kSecond = 2u;  // what the second pass kept is the distance of some triangle
const uint kWrong = 4u;   // a distance is less than what was kept
const uint kRoot = 8u;    // sqrt is worse than the bounds allow

void far_list(uint cell, uint triangle, float lower, float upper) {
  uint at = atomicAdd(list[0], 1u);
  uint sum = 0u;
  FAR_ADD(32u, triangle) FAR_ADD(33u, floatBitsToUint(lower)) FAR_ADD(34u, floatBitsToUint(upper))
  atomicAdd(report[4u * cell], sum);
  if (at < u_capacity) {
    list[4u + 4u * at] = cell;
    list[5u + 4u * at] = triangle;
    list[6u + 4u * at] = floatBitsToUint(lower);
    list[7u + 4u * at] = floatBitsToUint(upper);
  }
}

void main() {
  ivec2 pixel = ivec2(floor(gl_FragCoord.xy));
  uint cell = uint(pixel.x) + u_width * uint(pixel.y), object = v_id.y;
  FarStep centre = FarStep(float(pixel.x) + 0.5, float(pixel.y) + 0.5, u_numbers.x);
  float computed, lower, upper;
  bool root_fails;
  far_distance(centre, FarStep(v_a.x, v_a.y, v_a.z), FarStep(v_b.x, v_b.y, v_b.z), FarStep(v_c.x, v_c.y, v_c.z),
               u_numbers.y, computed, lower, upper, root_fails);
  precise float depth = (u_pass < 3u ? computed : upper) * u_numbers.z;
  atomicAdd(report[4u * cell], v_echo);
  uint flags = root_fails ? kRoot : 0u;
  float first_depth = texelFetch(u_first_depth, pixel, 0).r;
  uint first = texelFetch(u_first, pixel, 0).r;
  bool other = u_pass != 1u || object != first;
  if (u_pass == 2u) {
    float second_depth = texelFetch(u_second_depth, pixel, 0).r;
    uint second = texelFetch(u_second, pixel, 0).r;
    if (depth < first_depth || (depth == first_depth && object < first)) flags |= kWrong;
    if (depth == first_depth && object == first) {
      flags |= kFirst;
      report[4u * cell + 2u] = first;
    }
    if (object != first) {
      if (depth < second_depth || (depth == second_depth && object < second)) flags |= kWrong;
      if (depth == second_depth && object == second) {
        flags |= kSecond;
        report[4u * cell + 3u] = second;
      }
    }
  }
  if (u_pass == 4u) {
    if (depth < first_depth) flags |= kWrong;
    if (depth == first_depth) flags |= kFirst;
    precise float least = first_depth * u_unscale;
    precise float limit = least + u_numbers.w;
    if (lower <= limit) far_list(cell, v_id.x, lower, upper);
  }
  if (flags != 0u) atomicOr(report[4u * cell + 1u], flags);
  if (!other) discard;
  o_object = object;
  gl_FragDepth = depth;
}
