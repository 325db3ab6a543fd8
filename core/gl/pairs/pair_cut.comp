// Cuts crowded cells into FAR_SUBDIVISION^2 smaller ones wherever that leaves at most half of the tests, as the function
// subdivide of core/pairs/tile.h does. Parents are the crowded cells of a level; u_bins is about the level below. Step 0, after
// the lists of a level are filled in, counts the bins whose counts are not used up, and lists the parents. Step 1 counts the
// entries of smaller cells. Step 2 decides which parents are cut, and gives the lists of their smaller cells places. Step 3
// fills the entries in. In `first` each parent has one place more than its smaller cells have bins, for the end of its last
// list: the entries of any other parent may follow.
layout(std430, binding = 0) buffer Records { uvec4 tag_0; readonly vec4 records[]; };
#define FAR_TAG_0 tag_0.x
layout(std430, binding = 1) buffer Above { uvec4 tag_1; readonly uvec4 above[]; };  // the parents of the level before, where there is one
#define FAR_TAG_1 tag_1.x
layout(std430, binding = 2) buffer Parents { uvec4 tag_2; uvec4 parents[]; };  // cell, entries, bits of the lower left corner x, y (px)
#define FAR_TAG_2 tag_2.x
layout(std430, binding = 3) buffer Counts { uvec4 tag_3; uint counts[]; };
#define FAR_TAG_3 tag_3.x
layout(std430, binding = 4) buffer First { uvec4 tag_4; uint first[]; };  // step 0: of the level itself; else of the level below
#define FAR_TAG_4 tag_4.x
layout(std430, binding = 5) buffer Entries { uvec4 tag_5; readonly uvec4 entries[]; };
#define FAR_TAG_5 tag_5.x
layout(std430, binding = 6) buffer Places { uvec4 tag_6; readonly uvec2 places[]; };
#define FAR_TAG_6 tag_6.x
layout(std430, binding = 8) buffer State { uvec4 tag_8; uint state[]; };  // of a cell: its number as a parent + 1, 0 where it is not cut
#define FAR_TAG_8 tag_8.x
layout(std430, binding = 9) buffer SubEntries { uvec4 tag_9; writeonly uvec4 sub_entries[]; };
#define FAR_TAG_9 tag_9.x
layout(std430, binding = 10) buffer SubPlaces { uvec4 tag_10; writeonly uvec2 sub_places[]; };
#define FAR_TAG_10 tag_10.x

const uint kSubCells = FAR_SUBDIVISION * FAR_SUBDIVISION;

// u_extra: x level, y bins of a cell of the level. Step 0: u_capacity 0: no cell of the level is cut. u_numbers: x side of a smaller cell (px), y how many of them are a px; powers
// of two.

#if FAR_STEP == 0
void work(uint cell) {
  uint begin = cell * u_extra.y;
  uint left = 0u;
  for (uint k = 0u; k < u_extra.y; ++k) left += FAR_AT(counts, begin + k) != 0u ? 1u : 0u;
  if (left != 0u) atomicAdd(counters[FAR_MISMATCHES], left);
  if (u_extra.x > 0u) begin += cell / kSubCells;
  uint n = FAR_AT(first, begin + u_extra.y) - FAR_AT(first, begin);
  uint number = 0u;
  if (n > FAR_CROWDED) {
    uint at = atomicAdd(counters[FAR_PARENTS + u_extra.x], 1u);
    if (at < u_capacity) {
      precise float x;
      precise float y;
      if (u_extra.x == 0u) {
        uint width = uint(u_tile.y - u_tile.x + 1);
        x = float(u_tile.x + int(cell % width));
        y = float(u_tile.z + int(cell / width));
      } else {
        uvec4 from = FAR_AT(above, cell / kSubCells);
        uint part = cell % kSubCells;
        float side = u_numbers.x * float(FAR_SUBDIVISION);
        x = uintBitsToFloat(from.z) + float(part % FAR_SUBDIVISION) * side;
        y = uintBitsToFloat(from.w) + float(part / FAR_SUBDIVISION) * side;
      }
      FAR_AT(parents, at) = uvec4(cell, n, floatBitsToUint(x), floatBitsToUint(y));
      number = at + 1u;
    }
  }
  if (u_capacity != 0u) FAR_AT(state, cell) = number;
}

#elif FAR_STEP == 2
// n (n - 1), which may need 64 bits: low, high.
uvec2 far_twice_tests(uint n) {
  uvec2 product;
  umulExtended(n, n - min(n, 1u), product.y, product.x);
  return product;
}

void work(uint p) {
  uvec2 left = uvec2(0u);
  uint sum = 0u;
  uint crowded = 0u;
  uint bins = kSubCells * u_bins.x;
  uint begin = p * bins;
  for (uint c = 0u; c < kSubCells; ++c) {
    uint n = 0u;
    for (uint k = 0u; k < u_bins.x; ++k) n += FAR_AT(counts, begin + c * u_bins.x + k);
    if (n > FAR_CROWDED) ++crowded;
    sum += n;
    uvec2 tests = far_twice_tests(n);
    left.x += tests.x;
    left.y += tests.y + (left.x < tests.x ? 1u : 0u);
  }
  uvec2 all = far_twice_tests(FAR_AT(parents, p).y);
  uvec2 twice = uvec2(left.x << 1, left.y << 1 | left.x >> 31);
  if (twice.y > all.y || (twice.y == all.y && twice.x > all.x)) {
    FAR_AT(state, FAR_AT(parents, p).x) = 0u;
    for (uint k = 0u; k < bins; ++k) {
      FAR_AT(counts, begin + k) = 0u;
      FAR_AT(first, begin + p + k) = 0u;
    }
    FAR_AT(first, begin + p + bins) = 0u;
    return;
  }
  // The 64 cells have at most half of the parent's tests, so they have fewer than 6 times its entries: `sum` fits 32 bits if
  // the parent has less than 2^29. The first comparison notices if the sum over all parents goes beyond 32 bits.
  uint at = atomicAdd(counters[FAR_ENTRIES + u_extra.x + 1u], sum);
  if (at + sum < at || FAR_AT(parents, p).y > 0x1fffffffu) counters[FAR_OVERFLOW] = 1u;
  if (crowded != 0u) atomicAdd(counters[FAR_CROWDED_CELLS + u_extra.x + 1u], crowded);
  for (uint k = 0u; k < bins; ++k) {
    FAR_AT(first, begin + p + k) = at;
    at += FAR_AT(counts, begin + k);
  }
  FAR_AT(first, begin + p + bins) = at;
}

#else
void far_add_entry(uint cell, uvec4 lo, uvec4 hi, uint record, float near, float far) {
  uint bin = far_bin(cell, hi.w, uint(far_depth_slice(near)));
#if FAR_STEP == 1
  atomicAdd(FAR_AT(counts, bin), 1u);
#else
  uint left = atomicAdd(FAR_AT(counts, bin), 0xffffffffu);
  if (left == 0u) return;  // more entries than were counted: the count wraps, so it is not 0 in the end
  uint at = FAR_AT(first, bin + cell / kSubCells) + left - 1u;
  if (at >= u_capacity) return;
  FAR_AT(sub_entries, 2u * at) = uvec4(lo.xy, floatBitsToUint(near), lo.w);
  FAR_AT(sub_entries, 2u * at + 1u) = uvec4(hi.xy, floatBitsToUint(far), hi.w);
  FAR_AT(sub_places, at) = uvec2(cell, record);
#endif
}

int far_index(float p, float from) { return far_part(p, from, u_numbers.y, float(FAR_SUBDIVISION - 1u)); }

void work(uint e) {
  uvec2 place = FAR_AT(places, e);
  uint p = FAR_AT(state, place.x);
  if (p == 0u) return;
  p -= 1u;
  uvec4 parent = FAR_AT(parents, p);
  uvec4 lo_bits = FAR_AT(entries, 2u * e);
  uvec4 hi_bits = FAR_AT(entries, 2u * e + 1u);
  uint record = place.y;
  float x = uintBitsToFloat(parent.z);
  float y = uintBitsToFloat(parent.w);
  float near = uintBitsToFloat(lo_bits.z);
  float far = uintBitsToFloat(hi_bits.z);
  FarRows r;
  r.lo = FAR_AT(records, kRecordSize * record + 3u);
  r.hi = FAR_AT(records, kRecordSize * record + 4u);
  int i0 = far_index(r.lo.x, x);
  int i1 = far_index(r.hi.x, x);
  int j0 = far_index(r.lo.y, y);
  int j1 = far_index(r.hi.y, y);
  if ((i1 - i0 + 1) * (j1 - j0 + 1) <= FAR_WHOLE_PIXELS) {
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) far_add_entry(p * kSubCells + uint(j) * FAR_SUBDIVISION + uint(i), lo_bits, hi_bits, record, near, far);
    }
    return;
  }
  r.a = FAR_AT(records, kRecordSize * record);
  r.b = FAR_AT(records, kRecordSize * record + 1u);
  r.c = FAR_AT(records, kRecordSize * record + 2u);
  for (int j = j0; j <= j1; ++j) {
    float lo;
    float hi;
    precise float y0 = y + float(j) * u_numbers.x;
    precise float y1 = y0 + u_numbers.x;
    if (!far_row(r, y0, y1, lo, hi)) continue;
    int last = far_index(hi, x);
    for (int i = far_index(lo, x); i <= last; ++i) {
      precise float x0 = x + float(i) * u_numbers.x;
      precise float x1 = x0 + u_numbers.x;
      float sub_near;
      float sub_far;
      if (!far_cell(r, x0, x1, sub_near, sub_far)) continue;
      sub_near = max(sub_near, near);
      sub_far = min(sub_far, far);
      if (sub_near <= sub_far) far_add_entry(p * kSubCells + uint(j) * FAR_SUBDIVISION + uint(i), lo_bits, hi_bits, record, sub_near, sub_far);
    }
  }
}
#endif
