// Finds the pairs of entries of one cell that overlap in depth and whose bounds overlap in the image. Entries lie in groups by
// owner, and inside a group by the slice of their near depth, so the partners of an entry are two ranges. In the other group
// they have a near slice within the entry's slices (an entry of the second group leaves out its first slice). In its own group
// they stand after the entry, up to its far slice. Step 0 tests each entry with up to FAR_UNIT partners. Step 1 tests the
// partners left, FAR_UNIT in a work item. The c-th FAR_UNIT partners of entry e are tested in the portion (e + c) mod u_cells.
// With FAR_SETTLED every portion tests all partners, and reports the pair of the records r and s if it is the portion (r + s)
// mod u_cells, since the pair may be in many cells.
layout(std430, binding = 2) buffer Pairs { uvec4 tag_2; writeonly uvec2 pairs[]; };
#define FAR_TAG_2 tag_2.x
layout(std430, binding = 3) buffer Units { uvec4 tag_3; uvec2 units[]; };  // work items of step 1: entry, its partners / FAR_UNIT
#define FAR_TAG_3 tag_3.x
layout(std430, binding = 4) buffer First { uvec4 tag_4; readonly uint first[]; };
#define FAR_TAG_4 tag_4.x
layout(std430, binding = 9) buffer Entries { uvec4 tag_9; readonly uvec4 entries[]; };
#define FAR_TAG_9 tag_9.x
layout(std430, binding = 10) buffer Places { uvec4 tag_10; readonly uvec2 places[]; };
#define FAR_TAG_10 tag_10.x
#ifdef FAR_SOME_CROWDED
layout(std430, binding = 8) buffer State { uvec4 tag_8; readonly uint state[]; };  // not 0: the cell is cut into smaller ones
#define FAR_TAG_8 tag_8.x
#endif
#ifdef FAR_SETTLED
// Bit r u_items + s, r < s: the records r and s are a pair that was emitted, in this cell or another one of the part.
layout(std430, binding = 1) buffer Settled { uvec4 tag_1; uint settled[]; };
#define FAR_TAG_1 tag_1.x
#endif

// u_extra: x level, 0 is that of pixels, y not 0 where entries of one group may collide, z work items of step 1 that there is room
// for, w the portion. u_cells: portions.

void work(uint w) {
#if FAR_STEP == 0
  uint e = w;
  uint skip = 0u;
#else
  uint e = FAR_AT(units, w).x;
  uint skip = FAR_AT(units, w).y * FAR_UNIT;
#endif
  uint cell = FAR_AT(places, e).x;
  uvec4 lo_bits = FAR_AT(entries, 2u * e);
  uvec4 hi_bits = FAR_AT(entries, 2u * e + 1u);
  vec3 lo = uintBitsToFloat(lo_bits.xyz);
  vec3 hi = uintBitsToFloat(hi_bits.xyz);
  uint group = (hi_bits.w >> 3) & u_bins.w;
  uint near_slice = uint(far_depth_slice(lo.z)) >> u_bins.y;
  uint far_slice_bin = uint(far_depth_slice(hi.z)) >> u_bins.y;
  uint bins = cell * u_bins.x + (u_extra.x != 0u ? cell / (FAR_SUBDIVISION * FAR_SUBDIVISION) : 0u);
  uint own = bins + group * u_bins.z;
  uint other = bins + (1u - group) * u_bins.z;
  uint other_begin = 0u;
  uint others = 0u;
  if (u_bins.w != 0u) {
    other_begin = FAR_AT(first, other + near_slice + group);
    others = FAR_AT(first, other + far_slice_bin + 1u) - other_begin;
  }
  uint all = others;
  if (u_extra.y != 0u) all += FAR_AT(first, own + far_slice_bin + 1u) - e - 1u;
  // If a dispatch was lost, places may be anything. Even then no loop is longer than the number of entries.
  all = min(all, uint(entries.length()) / 2u);
#ifdef FAR_SOME_CROWDED
  bool crowded = FAR_AT(first, bins + u_bins.x) - FAR_AT(first, bins) > FAR_CROWDED;
  if (FAR_AT(state, cell) != 0u) all = 0u;
#endif
#if FAR_STEP == 0
  uint last = all > FAR_UNIT ? (all - 1u) / FAR_UNIT : 0u;
#ifdef FAR_SETTLED
  uint portions = 1u;
  uint next = 1u;
#else
  uint portions = u_cells;
  uint next = 1u + (u_extra.w + u_cells - (e + 1u) % u_cells) % u_cells;  // the first c > 0 of this portion
#endif
  if (next <= last) {
    uint more = (last - next) / portions + 1u;
    uint to = atomicAdd(counters[FAR_MORE + u_extra.x], more);
    if (to + more < to) counters[FAR_OVERFLOW] = 1u;
    for (uint k = 0u; k < more && to + k < u_extra.z; ++k) FAR_AT(units, to + k) = uvec2(e, next + k * portions);
  }
#ifndef FAR_SETTLED
  if (e % u_cells != u_extra.w) all = 0u;
#endif
#endif
  uint begin = min(skip, all);
  uint end = min(skip + FAR_UNIT, all);
  uint owner = hi_bits.w >> 3;
  bool self = (hi_bits.w & kSelf) != 0u;
  bool dedupe = u_extra.x == 0u && (hi_bits.w & kWhole) != 0u;
#ifdef FAR_SOME_CROWDED
  if (crowded) dedupe = false;
#endif
  int stride = u_tile.y - u_tile.x + 1;
  for (uint k = begin; k < end; ++k) {
    uint p = k < others ? other_begin + k : e + 1u + (k - others);
    uvec4 lo2_bits = FAR_AT(entries, 2u * p);
    uvec4 hi2_bits = FAR_AT(entries, 2u * p + 1u);
    vec3 lo2 = uintBitsToFloat(lo2_bits.xyz);
    vec3 hi2 = uintBitsToFloat(hi2_bits.xyz);
    bool hit = lo.x <= hi2.x && lo2.x <= hi.x && lo.y <= hi2.y && lo2.y <= hi.y && lo.z <= hi2.z && lo2.z <= hi.z &&
               (self || owner != hi2_bits.w >> 3);
    // Two whole triangles overlap in all their common pixels or in none: the first of these reports them, unless it lies in
    // another part of the window or is crowded, where their intervals are finer.
    int i = far_pixel(max(lo.x, lo2.x), u_window.x) - u_tile.x;
    int j = far_pixel(max(lo.y, lo2.y), u_window.y) - u_tile.z;
    uint at = uint(j * stride + i);
    bool elsewhere = hit && dedupe && (hi2_bits.w & kWhole) != 0u && i >= 0 && j >= 0 && at != cell;
#ifdef FAR_SOME_CROWDED
    if (elsewhere) elsewhere = FAR_AT(first, (at + 1u) * u_bins.x) - FAR_AT(first, at * u_bins.x) <= FAR_CROWDED;
#endif
    bool emit = hit && !elsewhere;
#ifdef FAR_SETTLED
    // The invocation that sets the bit emits the pair. If pairs do not fit, all bits are cleared before a new try.
    if (emit) {
      uint r = FAR_AT(places, e).y;
      uint s = FAR_AT(places, p).y;
      uint number = min(r, s) * u_items + max(r, s);
      uint bit = 1u << (number & 31u);
      emit = (r + s) % u_cells == u_extra.w && (FAR_AT(settled, number >> 5) & bit) == 0u && (atomicOr(FAR_AT(settled, number >> 5), bit) & bit) == 0u;
    }
#endif
    if (emit) {
      uint to = far_next_pair();
      if (to < u_capacity) FAR_AT(pairs, to) = uvec2(min(lo_bits.w, lo2_bits.w), max(lo_bits.w, lo2_bits.w));
    }
  }
  far_sum_of_batch += end - begin;
}
