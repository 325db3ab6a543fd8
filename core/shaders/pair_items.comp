// Bounds of the active triangles; those that meet the tile become items, in any order.
layout(std430, binding = 0) readonly buffer Vertices { vec4 vertices[]; };
layout(std430, binding = 1) readonly buffer Triangles { uint triangles[]; };  // three vertices each
layout(std430, binding = 2) readonly buffer Owners { uint owners[]; };        // object of each triangle
layout(std430, binding = 3) readonly buffer Active { uint active_ones[]; };
// Eight words an object: bits of its limits lo.xyz and hi.xyz, its number << 3 | kSelf, -.
layout(std430, binding = 4) readonly buffer Objects { uint objects[]; };
layout(std430, binding = 5) writeonly buffer Items { vec4 items[]; };
layout(std430, binding = 6) writeonly buffer Heads { uvec4 heads[]; };
layout(std430, binding = 8) writeonly buffer Listed { uint listed[]; };

// u_extra.x: not 0 where triangles and owners are those of the active ones, in their order. u_numbers.x: pixels of a large one.

int far_pixel(float x, int count) { return int(clamp(x, 0.0f, float(count - 1))); }

void work(uint w) {
  uint triangle = active_ones[w];
  uint t = u_extra.x != 0u ? w : triangle;
  vec4 a = vertices[triangles[3u * t]];
  vec4 b = vertices[triangles[3u * t + 1u]];
  vec4 c = vertices[triangles[3u * t + 2u]];
  vec4 lo;
  vec4 hi;
  far_bounds(a, b, c, u_widen, lo, hi);
  vec4 margin = far_margin(lo, hi, u_widen);
  uint object = 8u * owners[t];
  lo.xyz = max(lo.xyz, vec3(uintBitsToFloat(objects[object]), uintBitsToFloat(objects[object + 1u]),
                            uintBitsToFloat(objects[object + 2u])));
  hi.xyz = min(hi.xyz, vec3(uintBitsToFloat(objects[object + 3u]), uintBitsToFloat(objects[object + 4u]),
                            uintBitsToFloat(objects[object + 5u])));
  if (!(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z)) return;
  int i0 = far_pixel(lo.x, u_window.x);
  int i1 = far_pixel(hi.x, u_window.x);
  int j0 = far_pixel(lo.y, u_window.y);
  int j1 = far_pixel(hi.y, u_window.y);
  if (i1 < u_tile.x || i0 > u_tile.y || j1 < u_tile.z || j0 > u_tile.w) return;
  uint code = objects[object + 6u];
  if ((i1 - i0 + 1) * (j1 - j0 + 1) <= FAR_WHOLE_PIXELS) {
    code |= kWhole;
  } else {
    precise float width = hi.x - lo.x;
    precise float height = hi.y - lo.y;
    if (far_footprint(a, b, c, width, height) > u_numbers.x) {
      code |= kLarge;
      atomicAdd(counters[FAR_LARGE], 1u);
    } else {
      uint rows = uint(min(j1, u_tile.w) - max(j0, u_tile.z) + 1);
      uint spans = uint(min(i1, u_tile.y) - max(i0, u_tile.x)) / FAR_SPAN + 1u;
      far_add(FAR_ROWS_TOTAL, rows * spans);
    }
  }
  uint at = atomicAdd(counters[FAR_ITEMS], 1u);
  if (at >= u_capacity) return;
  items[kItemSize * at] = vec4(a.xyz, margin.x);
  items[kItemSize * at + 1u] = vec4(b.xyz, margin.y);
  items[kItemSize * at + 2u] = vec4(c.xyz, margin.z);
  items[kItemSize * at + 3u] = lo;
  items[kItemSize * at + 4u] = hi;
  heads[at] = uvec4(triangle, code, uint(i0) | uint(j0) << 16, uint(i1) | uint(j1) << 16);
  listed[at] = 0u;
}
