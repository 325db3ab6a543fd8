// Crowded cells, cut into FAR_SUBDIVISION^2 smaller ones wherever that leaves at most half of the tests: the function subdivide
// of core/pair_tile.cpp. Parents are the crowded cells of a level, u_bins and u_cells those of the level below.
layout(std430, binding = 0) readonly buffer Items { vec4 items[]; };
layout(std430, binding = 1) readonly buffer Above { uvec4 above[]; };  // the parents of the level before, where there is one
layout(std430, binding = 2) buffer Parents { uvec4 parents[]; };  // cell, entries, bits of the lower left corner x, y (px)
layout(std430, binding = 3) buffer Counts { uint counts[]; };
layout(std430, binding = 4) readonly buffer First { uint first[]; };  // of the level itself for kList, else of the level below
layout(std430, binding = 5) readonly buffer Entries { uvec4 entries[]; };
layout(std430, binding = 6) readonly buffer EntryCells { uint entry_cells[]; };
layout(std430, binding = 8) buffer State { uint state[]; };  // of a cell: its number as a parent + 1, 0 where it is not cut
layout(std430, binding = 9) writeonly buffer SubEntries { uvec4 sub_entries[]; };
layout(std430, binding = 10) writeonly buffer SubEntryCells { uint sub_entry_cells[]; };

const uint kList = 0u;
const uint kCount = 1u;
const uint kDecide = 2u;
const uint kSubCells = FAR_SUBDIVISION * FAR_SUBDIVISION;

// u_extra: x level, y bins of a cell of the level. u_numbers.x: side of a smaller cell (px).

void far_list(uint cell) {
  uint n = first[(cell + 1u) * u_extra.y] - first[cell * u_extra.y];
  uint number = 0u;
  if (n > FAR_CROWDED) {
    uint at = atomicAdd(counters[FAR_PARENTS], 1u);
    if (at < u_capacity) {
      precise float x;
      precise float y;
      if (u_extra.x == 0u) {
        uint width = uint(u_tile.y - u_tile.x + 1);
        x = float(u_tile.x + int(cell % width));
        y = float(u_tile.z + int(cell / width));
      } else {
        uvec4 from = above[cell / kSubCells];
        uint part = cell % kSubCells;
        float side = u_numbers.x * float(FAR_SUBDIVISION);
        x = uintBitsToFloat(from.z) + float(part % FAR_SUBDIVISION) * side;
        y = uintBitsToFloat(from.w) + float(part / FAR_SUBDIVISION) * side;
      }
      parents[at] = uvec4(cell, n, floatBitsToUint(x), floatBitsToUint(y));
      number = at + 1u;
    }
  }
  state[cell] = number;
}

// n (n - 1), which may need 64 bits: low, high.
uvec2 far_twice_tests(uint n) {
  uvec2 product;
  umulExtended(n, n - min(n, 1u), product.y, product.x);
  return product;
}

void far_decide(uint p) {
  uvec2 left = uvec2(0u);
  for (uint c = 0u; c < kSubCells; ++c) {
    uint n = 0u;
    for (uint k = 0u; k < u_bins.x; ++k) n += counts[(p * kSubCells + c) * u_bins.x + k];
    uvec2 tests = far_twice_tests(n);
    left.x += tests.x;
    left.y += tests.y + (left.x < tests.x ? 1u : 0u);
  }
  uvec2 all = far_twice_tests(parents[p].y);
  uvec2 twice = uvec2(left.x << 1, left.y << 1 | left.x >> 31);
  if (twice.y > all.y || (twice.y == all.y && twice.x > all.x)) {
    state[parents[p].x] = 0u;
    for (uint k = 0u; k < kSubCells * u_bins.x; ++k) counts[p * kSubCells * u_bins.x + k] = 0u;
  }
}

void far_add_entry(uint cell, uvec4 entry, float near, float far) {
  uint bin = far_bin(cell, near);
  if (u_step == kCount) {
    atomicAdd(counts[bin], 1u);
    return;
  }
  uint left = atomicAdd(counts[bin], 0xffffffffu);
  if (left == 0u) return;  // more than was counted: the count is not 0 in the end
  uint at = first[bin] + left - 1u;
  if (at >= u_capacity) return;
  sub_entries[at] = uvec4(entry.xy, floatBitsToUint(near), floatBitsToUint(far));
  sub_entry_cells[at] = cell;
}

int far_part(float p, float from) {
  precise float part = (p - from) / u_numbers.x;
  return int(clamp(part, 0.0f, float(FAR_SUBDIVISION - 1u)));
}

void far_cut(uint e) {
  uint p = state[entry_cells[e]];
  if (p == 0u) return;
  p -= 1u;
  uvec4 parent = parents[p];
  uvec4 entry = entries[e];
  float x = uintBitsToFloat(parent.z);
  float y = uintBitsToFloat(parent.w);
  float near = uintBitsToFloat(entry.z);
  float far = uintBitsToFloat(entry.w);
  FarRows r;
  r.lo = items[kItemSize * entry.x + 3u];
  r.hi = items[kItemSize * entry.x + 4u];
  int i0 = far_part(r.lo.x, x);
  int i1 = far_part(r.hi.x, x);
  int j0 = far_part(r.lo.y, y);
  int j1 = far_part(r.hi.y, y);
  if ((i1 - i0 + 1) * (j1 - j0 + 1) <= FAR_WHOLE_PIXELS) {
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) far_add_entry(p * kSubCells + uint(j) * FAR_SUBDIVISION + uint(i), entry, near, far);
    }
    return;
  }
  r.a = items[kItemSize * entry.x];
  r.b = items[kItemSize * entry.x + 1u];
  r.c = items[kItemSize * entry.x + 2u];
  for (int j = j0; j <= j1; ++j) {
    float lo;
    float hi;
    precise float y0 = y + float(j) * u_numbers.x;
    precise float y1 = y0 + u_numbers.x;
    if (!far_row(r, y0, y1, lo, hi)) continue;
    int last = far_part(hi, x);
    for (int i = far_part(lo, x); i <= last; ++i) {
      precise float x0 = x + float(i) * u_numbers.x;
      precise float x1 = x0 + u_numbers.x;
      float sub_near;
      float sub_far;
      if (!far_cell(r, x0, x1, sub_near, sub_far)) continue;
      sub_near = max(sub_near, near);
      sub_far = min(sub_far, far);
      if (sub_near <= sub_far) far_add_entry(p * kSubCells + uint(j) * FAR_SUBDIVISION + uint(i), entry, sub_near, sub_far);
    }
  }
}

void work(uint w) {
  if (u_step == kList) {
    far_list(w);
  } else if (u_step == kDecide) {
    far_decide(w);
  } else {
    far_cut(w);
  }
}
