// Step 0: the active triangles that meet the tile become items, in any order. Step 1: the whole ones that are listed become
// records.
layout(std430, binding = 5) buffer Records { uvec4 tag_5; writeonly vec4 records[]; };
#define FAR_TAG_5 tag_5.x
layout(std430, binding = 6) buffer RecordHeads { uvec4 tag_6; writeonly uvec4 record_heads[]; };
#define FAR_TAG_6 tag_6.x
layout(std430, binding = 8) buffer Heads { uvec4 tag_8; uvec4 heads[]; };  // of whole items
#define FAR_TAG_8 tag_8.x

#if FAR_STEP == 0
layout(std430, binding = 9) buffer Listed { uvec4 tag_9; writeonly uint listed[]; };  // of the records
#define FAR_TAG_9 tag_9.x
layout(std430, binding = 10) buffer Rows { uvec4 tag_10; writeonly uint rows[]; };  // how many work items the rows of each record are
#define FAR_TAG_10 tag_10.x
// u_capacity: records; u_extra.z: whole items. u_numbers.x: pixels that a large triangle meets at least.
#else
layout(std430, binding = 9) buffer Shown { uvec4 tag_9; readonly uint shown[]; };  // the whole items that are listed
#define FAR_TAG_9 tag_9.x
// u_extra.z: active triangles that were sent.
#endif

void far_record(uint at, FarTriangle t, uint code, uint from, uint to) {
  FAR_AT(records, kRecordSize * at) = vec4(t.a.xyz, t.margin.x);
  FAR_AT(records, kRecordSize * at + 1u) = vec4(t.b.xyz, t.margin.y);
  FAR_AT(records, kRecordSize * at + 2u) = vec4(t.c.xyz, t.margin.z);
  FAR_AT(records, kRecordSize * at + 3u) = t.lo;
  FAR_AT(records, kRecordSize * at + 4u) = t.hi;
  FAR_AT(record_heads, at) = uvec4(t.triangle, code, from, to);
}

// The pixels i0, j0, i1, j1 of the triangle's bounds.
ivec4 far_pixels(FarTriangle t) {
  return ivec4(far_pixel(t.lo.x, u_window.x), far_pixel(t.lo.y, u_window.y), far_pixel(t.hi.x, u_window.x), far_pixel(t.hi.y, u_window.y));
}

uint far_extent(FarTriangle t, ivec4 at) {
  return far_pack(at.z - at.x + 1, at.w - at.y + 1, far_depth_slice(t.lo.z), far_depth_slice(t.hi.z));
}

#if FAR_STEP == 0
void work(uint w) {
  FarTriangle t;
  if (!far_triangle(w, t)) return;
  ivec4 pixels = far_pixels(t);
  int i0 = pixels.x;
  int j0 = pixels.y;
  int i1 = pixels.z;
  int j1 = pixels.w;
  if (i1 < u_tile.x || i0 > u_tile.y || j1 < u_tile.z || j0 > u_tile.w) return;
  uint from = uint(i0) | uint(j0) << 16;
  if ((i1 - i0 + 1) * (j1 - j0 + 1) <= FAR_WHOLE_PIXELS) {
    uint at = atomicAdd(counters[FAR_WHOLES], 1u);
    if (at >= u_extra.z) return;
    FAR_AT(heads, at) = uvec4(u_extra.x + w, t.code | kWhole, from, far_extent(t, pixels));
    return;
  }
  uint code = t.code;
  uint row_items = 0u;
  precise float width = t.hi.x - t.lo.x;
  precise float height = t.hi.y - t.lo.y;
  if (far_footprint(t.a, t.b, t.c, width, height) > u_numbers.x) {
    code |= kLarge;
    atomicAdd(counters[FAR_LARGE], 1u);
  } else {
    uint height_here = uint(min(j1, u_tile.w) - max(j0, u_tile.z) + 1);
    uint spans = uint(min(i1, u_tile.y) - max(i0, u_tile.x)) / FAR_SPAN + 1u;
    row_items = height_here * spans;
    far_add(FAR_ROWS_TOTAL, row_items);
  }
  uint at = atomicAdd(counters[FAR_ITEMS], 1u);
  if (at >= u_capacity) return;
  far_record(at, t, code, from, uint(i1) | uint(j1) << 16);
  FAR_AT(listed, at) = 0u;
  FAR_AT(rows, at) = row_items;
}
#else
void work(uint w) {
  uvec4 head = FAR_AT(heads, FAR_AT(shown, w));
  uint at = head.x - u_extra.x;  // wraps around to beyond u_extra.z if the triangle lies before the first one sent
  if (at >= u_extra.z) return;
  FarTriangle t;
  // Lists use the pixels and slices of the head; tests use the bounds of the record, which this program computes again. If the
  // two differ, nothing is believed.
  bool same = far_triangle(at, t);
  ivec4 pixels = far_pixels(t);
  if (!same || (uint(pixels.x) | uint(pixels.y) << 16) != head.z || far_extent(t, pixels) != head.w)
    atomicAdd(counters[FAR_MISMATCHES], 1u);
  far_record(u_items + w, t, head.y, head.z, head.w);
}
#endif
