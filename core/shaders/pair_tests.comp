// Pairs of entries of one cell whose intervals overlap. The entries of a cell are in the order of the slices of their near
// depths, so the partners of an entry are among those after it, up to the bin of its far depth.
layout(std430, binding = 0) readonly buffer Items { vec4 items[]; };
layout(std430, binding = 1) readonly buffer Heads { uvec4 heads[]; };
layout(std430, binding = 2) writeonly buffer Pairs { uvec2 pairs[]; };
layout(std430, binding = 3) buffer Units { uint units[]; };  // work items left of each entry; of the entries before it
layout(std430, binding = 4) readonly buffer First { uint first[]; };
layout(std430, binding = 5) readonly buffer Entries { uvec4 entries[]; };
layout(std430, binding = 6) readonly buffer EntryCells { uint entry_cells[]; };
layout(std430, binding = 8) readonly buffer State { uint state[]; };  // not 0: the cell is cut into smaller ones
FAR_LAST_AT_MOST(far_entry_of_unit, units)

// u_extra: x level, y not 0 where a cell may be cut, z entries, w the first work item.

uint far_size(uint cell) { return first[(cell + 1u) * u_bins.x] - first[cell * u_bins.x]; }

// Two whole triangles overlap in all their common pixels or in none: the first one reports them unless it is out of reach, or
// crowded, where their intervals are finer.
bool far_elsewhere(uvec4 a, uvec4 b, uint cell) {
  uint i = max(a.z & 0xffffu, b.z & 0xffffu);
  uint j = max(a.z >> 16, b.z >> 16);
  if (int(i) < u_tile.x || int(j) < u_tile.z) return false;
  uint at = (j - uint(u_tile.z)) * uint(u_tile.y - u_tile.x + 1) + i - uint(u_tile.x);
  return at != cell && far_size(at) <= FAR_CROWDED;
}

void far_test(uvec4 x, uint cell, uint begin, uint end) {
  float near = uintBitsToFloat(x.z);
  float far = uintBitsToFloat(x.w);
  vec4 lo = items[kItemSize * x.x + 3u];
  vec4 hi = items[kItemSize * x.x + 4u];
  for (uint k = begin; k < end; ++k) {
    uvec4 y = entries[k];
    if (!far_may_meet(x.y, y.y) || !(near <= uintBitsToFloat(y.w) && uintBitsToFloat(y.z) <= far)) continue;
    vec4 lo2 = items[kItemSize * y.x + 3u];
    vec4 hi2 = items[kItemSize * y.x + 4u];
    if (!(lo.x <= hi2.x && lo2.x <= hi.x && lo.y <= hi2.y && lo2.y <= hi.y)) continue;
    uvec4 a = heads[x.x];
    uvec4 b = heads[y.x];
    if (u_extra.x == 0u && (a.y & b.y & kWhole) != 0u && far_size(cell) <= FAR_CROWDED && far_elsewhere(a, b, cell)) continue;
    uint at = atomicAdd(counters[FAR_PAIRS], 1u);
    if (at < u_capacity) pairs[at] = uvec2(min(a.x, b.x), max(a.x, b.x));
  }
  far_add(FAR_TESTS, end - begin);
}

void work(uint index) {
  uint w = u_extra.w + index;
  if (u_step == 0u) {
    uint cell = entry_cells[w];
    uint more = 0u;
    if (u_extra.y == 0u || state[cell] == 0u) {
      uvec4 x = entries[w];
      uint end = first[far_bin(cell, uintBitsToFloat(x.w)) + 1u];
      if (end - w - 1u > FAR_UNIT) {
        more = (end - w - 2u) / FAR_UNIT;
        end = w + 1u + FAR_UNIT;
        counters[FAR_MORE] = 1u;
      }
      if (end > w + 1u) far_test(x, cell, w + 1u, end);
    }
    units[w] = more;
    return;
  }
  uint e = far_entry_of_unit(w, u_extra.z);
  uint cell = entry_cells[e];
  uvec4 x = entries[e];
  uint begin = e + 1u + (w - units[e] + 1u) * FAR_UNIT;
  uint end = first[far_bin(cell, uintBitsToFloat(x.w)) + 1u];
  far_test(x, cell, begin, min(begin + FAR_UNIT, end));
}
