// Goes over the pixels that items meet. Three steps share this code, so that exactly the counted entries are filled in: 0 marks
// the slices of each owner, 1 counts the entries of each bin, 2 fills them in. A work item is a whole item or, with FAR_ROWS,
// FAR_SPAN pixels of one row of an item that is not whole.
#define FAR_MARK 0
#define FAR_COUNT 1
#define FAR_FILL 2
#if FAR_STEP != FAR_FILL || defined(FAR_ROWS)
// Two words (64 slices) for each pixel and region. Region 0: slices that two owners touch, or one that collides with itself.
// Region 1 + 2 k + b: slices that some owner touches whose number has b as bit k.
layout(std430, binding = 2) buffer Masks { uvec4 tag_2; uint masks[]; };
#define FAR_TAG_2 tag_2.x
#else
layout(std430, binding = 2) buffer Masks { uvec4 tag_2; readonly uint masks[]; };
#define FAR_TAG_2 tag_2.x
#endif
#if FAR_STEP != FAR_MARK
layout(std430, binding = 3) buffer Counts { uvec4 tag_3; uint counts[]; };  // entries of each bin that are not filled in yet
#define FAR_TAG_3 tag_3.x
#endif
#if FAR_STEP == FAR_FILL
layout(std430, binding = 4) buffer First { uvec4 tag_4; readonly uint first[]; };
#define FAR_TAG_4 tag_4.x
layout(std430, binding = 9) buffer Entries { uvec4 tag_9; writeonly uvec4 entries[]; };
#define FAR_TAG_9 tag_9.x
layout(std430, binding = 10) buffer Places { uvec4 tag_10; writeonly uvec2 places[]; };
#define FAR_TAG_10 tag_10.x
#endif
#if FAR_STEP == FAR_FILL || defined(FAR_ROWS)
layout(std430, binding = 0) buffer Records { uvec4 tag_0; readonly vec4 records[]; };
#define FAR_TAG_0 tag_0.x
#endif
layout(std430, binding = 6) buffer Heads { uvec4 tag_6; readonly uvec4 heads[]; };
#define FAR_TAG_6 tag_6.x
#if FAR_STEP == FAR_COUNT
layout(std430, binding = 8) buffer Listed { uvec4 tag_8; uint listed[]; };  // with FAR_ROWS: per record, not 0 if it has an entry; else the whole items that have one
#define FAR_TAG_8 tag_8.x
#endif
#ifdef FAR_ROWS
layout(std430, binding = 1) buffer Rows { uvec4 tag_1; readonly uint rows[]; };  // work items of the records before each
#define FAR_TAG_1 tag_1.x
FAR_LAST_AT_MOST(far_record_of_row, rows)
#endif

// u_extra.x: bits of an owner's number. u_extra.y: bins of the part. u_items: records before the whole ones, of which there may be fewer.

// The slices first .. last that lie in one of the two words.
uint far_slice_bits(int first_slice, int last_slice, int word) {
  int low = max(first_slice - 32 * word, 0);
  int high = min(last_slice - 32 * word, 31);
  return low <= high ? (0xffffffffu << low) & (0xffffffffu >> (31 - high)) : 0u;
}

// One pixel of an item, whose slices are `near_bits` in `word` and `far_bits` in the next; true: it has an entry there.
bool far_visit(uint cell, uint word, uint near_bits, uint far_bits, uint bin, uint record, uvec4 lo, uvec4 hi) {
#if FAR_STEP == FAR_MARK
  uint at = 2u * cell + word;
  bool self = (hi.w & kSelf) != 0u;
  uint regions = self ? 1u : u_extra.x;
  for (uint k = 0u; k < regions; ++k) {
    uint region = self ? 0u : 2u * u_cells * (1u + 2u * k + ((hi.w >> (3u + k)) & 1u));
    atomicOr(FAR_AT(masks, region + at), near_bits);
    if (far_bits != 0u) atomicOr(FAR_AT(masks, region + at + 1u), far_bits);
  }
  return false;
#else
  if (u_masked != 0u) {
    uint conflict = FAR_AT(masks, 2u * cell + word) & near_bits;
    if (far_bits != 0u) conflict |= FAR_AT(masks, 2u * cell + word + 1u) & far_bits;
    if (conflict == 0u) return false;
  }
#if FAR_STEP == FAR_COUNT
  atomicAdd(FAR_AT(counts, bin), 1u);
#else
  uint left = atomicAdd(FAR_AT(counts, bin), 0xffffffffu);
  if (left == 0u) return true;  // more entries than were counted: the count wraps, so it is not 0 in the end
  uint at = FAR_AT(first, bin) + left - 1u;
  if (at >= u_capacity) return true;
  FAR_AT(entries, 2u * at) = lo;
  FAR_AT(entries, 2u * at + 1u) = hi;
  FAR_AT(places, at) = uvec2(cell, record);
#endif
  return true;
#endif
}

#ifdef FAR_ROWS
void work(uint w) {
  uint record = far_record_of_row(w, min(counters[FAR_ITEMS], u_items));
  uvec4 head = FAR_AT(heads, record);
  int i0 = max(int(head.z & 0xffffu), u_tile.x);
  int i1 = min(int(head.w & 0xffffu), u_tile.y);
  int j0 = max(int(head.z >> 16), u_tile.z);
  uint spans = uint(i1 - i0) / FAR_SPAN + 1u;
  uint part = w - FAR_AT(rows, record);
  int j = j0 + int(part / spans);
  int start = i0 + int(part % spans * FAR_SPAN);
  FarRows r;
  r.a = FAR_AT(records, kRecordSize * record);
  r.b = FAR_AT(records, kRecordSize * record + 1u);
  r.c = FAR_AT(records, kRecordSize * record + 2u);
  r.lo = FAR_AT(records, kRecordSize * record + 3u);
  r.hi = FAR_AT(records, kRecordSize * record + 4u);
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
    int last_slice = far_depth_slice(far);
    int word = first_slice >> 5;
    uint cell = row + uint(i - u_tile.x);
    if (far_visit(cell, uint(word), far_slice_bits(first_slice, last_slice, word), far_slice_bits(first_slice, last_slice, word + 1),
                  far_bin(cell, head.y, uint(first_slice)), record,
                  uvec4(floatBitsToUint(r.lo.x), floatBitsToUint(r.lo.y), floatBitsToUint(near), head.x),
                  uvec4(floatBitsToUint(r.hi.x), floatBitsToUint(r.hi.y), floatBitsToUint(far), head.y)))
      any = true;
  }
#if FAR_STEP == FAR_COUNT
  if (any && atomicExchange(FAR_AT(listed, record), 1u) == 0u) atomicAdd(counters[FAR_LISTED_ROWS], 1u);
#endif
}
#else
void work(uint w) {
#if FAR_STEP == FAR_FILL
  uint record = u_items + w;
  vec4 least = FAR_AT(records, kRecordSize * record + 3u);
  vec4 most = FAR_AT(records, kRecordSize * record + 4u);
#else
  uint record = w;
  vec4 least = vec4(0.0f);
  vec4 most = vec4(0.0f);
#endif
  uvec4 head = FAR_AT(heads, record);
  uvec4 lo = uvec4(floatBitsToUint(least.xyz), head.x);
  uvec4 hi = uvec4(floatBitsToUint(most.xyz), head.y);
  int i0 = max(int(head.z & 0xffffu), u_tile.x);
  int i1 = min(int(head.z & 0xffffu) + int(head.w & 15u), u_tile.y);
  int j0 = max(int(head.z >> 16), u_tile.z);
  int j1 = min(int(head.z >> 16) + int((head.w >> 4) & 15u), u_tile.w);
  int first_slice = int((head.w >> 8) & 63u);
  int last_slice = int((head.w >> 14) & 63u);
  int word = first_slice >> 5;
  uint near_bits = far_slice_bits(first_slice, last_slice, word);
  uint far_bits = far_slice_bits(first_slice, last_slice, word + 1);
  uint bin = far_bin(0u, head.y, uint(first_slice));
  int i = i0;
  uint stride = uint(u_tile.y - u_tile.x + 1);
  uint cell = uint(j0 - u_tile.z) * stride + uint(i0 - u_tile.x);
  uint next_row = stride - uint(i1 - i0);
  int left = i0 <= i1 && j0 <= j1 ? (i1 - i0 + 1) * (j1 - j0 + 1) : 0;
  bool any = false;
  for (; left > 0; --left) {
    if (far_visit(cell, uint(word), near_bits, far_bits, cell * u_bins.x + bin, record, lo, hi)) any = true;
    cell += i == i1 ? next_row : 1u;
    i = i == i1 ? i0 : i + 1;
  }
#if FAR_STEP == FAR_COUNT
  if (any) FAR_AT(listed, atomicAdd(counters[FAR_LISTED], 1u)) = w;
#endif
}
#endif
