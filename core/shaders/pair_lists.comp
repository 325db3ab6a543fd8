// The pixels that items meet, in three steps of one program, so that what is counted is what is filled in. A work item is a
// whole item or, with FAR_ROWS, one row of another, FAR_SPAN pixels of it.
layout(std430, binding = 0) readonly buffer Items { vec4 items[]; };
layout(std430, binding = 1) readonly buffer Heads { uvec4 heads[]; };
// Two words a pixel (64 slices) and region. Region 0: slices that two owners touch, or one that collides with itself; 1 + 2 k + b:
// those that an owner touches whose number has b as bit k.
layout(std430, binding = 2) buffer Masks { uint masks[]; };
layout(std430, binding = 3) buffer Counts { uint counts[]; };  // of each bin; what is filled in is taken away
layout(std430, binding = 4) readonly buffer First { uint first[]; };
layout(std430, binding = 5) writeonly buffer Entries { uvec4 entries[]; };  // item, code, bits of near, of far
layout(std430, binding = 6) writeonly buffer EntryCells { uint entry_cells[]; };
layout(std430, binding = 8) buffer Listed { uint listed[]; };  // not 0: the item has an entry
#ifdef FAR_ROWS
layout(std430, binding = 9) readonly buffer Rows { uint rows[]; };  // of the items before each
FAR_LAST_AT_MOST(far_item_of_row, rows)
#endif

const uint kMark = 0u;
const uint kCount = 1u;

// u_extra.x: bits of an owner's number.

uvec2 far_slice_bits(int first_slice, int last_slice) {
  uint low = 0u;
  uint high = 0u;
  if (first_slice < 32) low = (0xffffffffu << first_slice) & (0xffffffffu >> (31 - min(last_slice, 31)));
  if (last_slice >= 32) high = (0xffffffffu << max(first_slice - 32, 0)) & (0xffffffffu >> (63 - last_slice));
  return uvec2(low, high);
}

void far_touch(uint at, uvec2 bits) {
  if ((bits.x & ~masks[2u * at]) != 0u) atomicOr(masks[2u * at], bits.x);
  if ((bits.y & ~masks[2u * at + 1u]) != 0u) atomicOr(masks[2u * at + 1u], bits.y);
}

// One pixel of an item; true: it has an entry there.
bool far_visit(uint cell, uvec2 bits, uint bin, uint item, uint code, float near, float far) {
  if (u_step == kMark) {
    if ((code & kSelf) != 0u) {
      far_touch(cell, bits);
      return false;
    }
    for (uint k = 0u; k < u_extra.x; ++k) far_touch((1u + 2u * k + ((code >> (3u + k)) & 1u)) * u_cells + cell, bits);
    return false;
  }
  if (u_masked != 0u && (masks[2u * cell] & bits.x) == 0u && (masks[2u * cell + 1u] & bits.y) == 0u) return false;
  if (u_step == kCount) {
    atomicAdd(counts[bin], 1u);
    return true;
  }
  uint left = atomicAdd(counts[bin], 0xffffffffu);
  if (left == 0u) return true;  // more than was counted: the count is not 0 in the end
  uint at = first[bin] + left - 1u;
  if (at >= u_capacity) return true;
  entries[at] = uvec4(item, code, floatBitsToUint(near), floatBitsToUint(far));
  entry_cells[at] = cell;
  return true;
}

#ifdef FAR_ROWS
void work(uint w) {
  uint item = far_item_of_row(w, u_items);
  if (u_step > kCount && listed[item] == 0u) return;
  uvec4 head = heads[item];
  int i0 = max(int(head.z & 0xffffu), u_tile.x);
  int i1 = min(int(head.w & 0xffffu), u_tile.y);
  int j0 = max(int(head.z >> 16), u_tile.z);
  uint spans = uint(i1 - i0) / FAR_SPAN + 1u;
  uint part = w - rows[item];
  int j = j0 + int(part / spans);
  int start = i0 + int(part % spans * FAR_SPAN);
  FarRows r;
  r.a = items[kItemSize * item];
  r.b = items[kItemSize * item + 1u];
  r.c = items[kItemSize * item + 2u];
  r.lo = items[kItemSize * item + 3u];
  r.hi = items[kItemSize * item + 4u];
  float lo;
  float hi;
  float y = float(j);
  if (!far_row(r, y, y + 1.0f, lo, hi)) return;
  int from = max(start, int(clamp(lo, 0.0f, 65536.0f)));
  int to = min(min(i1, start + int(FAR_SPAN) - 1), int(clamp(hi, 0.0f, 65536.0f)));
  uint row = uint((j - u_tile.z) * (u_tile.y - u_tile.x + 1));
  bool any = false;
  for (int i = from; i <= to; ++i) {
    float x = float(i);
    float near;
    float far;
    if (!far_cell(r, x, x + 1.0f, near, far)) continue;
    int first_slice = far_depth_slice(near);
    uint cell = row + uint(i - u_tile.x);
    uint bin = cell * u_bins.x + (uint(first_slice) >> u_bins.y);
    if (far_visit(cell, far_slice_bits(first_slice, far_depth_slice(far)), bin, item, head.y, near, far)) any = true;
  }
  if (any && u_step == kCount) listed[item] = 1u;
}
#else
void work(uint item) {
  uvec4 head = heads[item];
  if ((head.y & kWhole) == 0u) return;
  if (u_step > kCount && listed[item] == 0u) return;
  float near = items[kItemSize * item + 3u].z;
  float far = items[kItemSize * item + 4u].z;
  int i0 = max(int(head.z & 0xffffu), u_tile.x);
  int i1 = min(int(head.w & 0xffffu), u_tile.y);
  int j0 = max(int(head.z >> 16), u_tile.z);
  int j1 = min(int(head.w >> 16), u_tile.w);
  int first_slice = far_depth_slice(near);
  uvec2 bits = far_slice_bits(first_slice, far_depth_slice(far));
  uint bin = uint(first_slice) >> u_bins.y;
  bool any = false;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      uint cell = uint((j - u_tile.z) * (u_tile.y - u_tile.x + 1) + i - u_tile.x);
      if (far_visit(cell, bits, cell * u_bins.x + bin, item, head.y, near, far)) any = true;
    }
  }
  if (any && u_step == kCount) listed[item] = 1u;
}
#endif
