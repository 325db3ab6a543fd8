// Compares large triangles with each active one, over the rectangle of the active one's bounds, as compare_large of
// core/pairs/cpu.cpp does. Step 0 lists the large triangles among the records; step 1 compares FAR_LARGE_BATCH of them with a
// triangle that was sent.
layout(std430, binding = 5) buffer Records { uvec4 tag_5; readonly vec4 records[]; };
#define FAR_TAG_5 tag_5.x
layout(std430, binding = 6) buffer RecordHeads { uvec4 tag_6; readonly uvec4 record_heads[]; };
#define FAR_TAG_6 tag_6.x
layout(std430, binding = 8) buffer Large { uvec4 tag_8; uint large[]; };  // records
#define FAR_TAG_8 tag_8.x
#if FAR_STEP == 0
void work(uint w) {
  if ((FAR_AT(record_heads, w).y & kLarge) == 0u) return;
  uint at = atomicAdd(counters[FAR_LARGE_FOUND], 1u);
  if (at < u_capacity) FAR_AT(large, at) = w;
}
#else
layout(std430, binding = 9) buffer Pairs { uvec4 tag_9; writeonly uvec2 pairs[]; };
#define FAR_TAG_9 tag_9.x

// u_extra.w: large triangles at most. u_cells: triangles that were sent. u_items: the first batch of FAR_LARGE_BATCH large
// triangles; a batch has a work item for each triangle that was sent. Work item w is done in the portion w mod u_extra.z; the
// portion to do is u_extra.x.

bool far_meets_over(uint l, vec4 box_lo, vec4 box_hi) {
  vec4 a = FAR_AT(records, kRecordSize * l);
  vec4 b = FAR_AT(records, kRecordSize * l + 1u);
  vec4 c = FAR_AT(records, kRecordSize * l + 2u);
  vec4 lo;
  vec4 hi;
  far_bounds(a, b, c, u_widen, lo, hi);
  precise float from = max(box_lo.y, lo.y) - b.w;
  precise float to = min(box_hi.y, hi.y) + b.w;
  FarStrip strip;
  far_strip(a, b, c, from, to, strip);
  precise float left = max(box_lo.x, lo.x) - a.w;
  precise float right = min(box_hi.x, hi.x) + a.w;
  float near;
  float far;
  if (!far_depths(strip, left, right, near, far)) return false;
  precise float least = near - c.w;
  precise float most = far + c.w;
  return least <= box_hi.z && box_lo.z <= most;
}

void work(uint w) {
  FarTriangle t;
  if (w % u_extra.z != u_extra.x || !far_triangle(w % u_cells, t)) return;
  // Two triangles that meet do so in a pixel of some part, where both are found.
  if (far_pixel(t.hi.x, u_window.x) < u_tile.x || far_pixel(t.lo.x, u_window.x) > u_tile.y ||
      far_pixel(t.hi.y, u_window.y) < u_tile.z || far_pixel(t.lo.y, u_window.y) > u_tile.w)
    return;
  uint begin = (u_items + w / u_cells) * FAR_LARGE_BATCH;
  uint end = min(begin + FAR_LARGE_BATCH, min(counters[FAR_LARGE_FOUND], u_extra.w));
  // Skips to the next one whose box meets the triangle's, so that few iterations compute a strip.
  for (uint k = begin; k < end; ++k) {
    uint l = 0u;
    uint other = 0u;
    for (; k < end; ++k) {
      l = FAR_AT(large, k);
      uvec4 head = FAR_AT(record_heads, l);
      other = head.x;
      if (other == t.triangle || !((t.code & kSelf) != 0u || ((t.code ^ head.y) >> 3) != 0u)) continue;
      vec4 lo = max(t.lo, FAR_AT(records, kRecordSize * l + 3u));
      vec4 hi = min(t.hi, FAR_AT(records, kRecordSize * l + 4u));
      if (lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z) break;
    }
    if (k >= end) break;
    if (!far_meets_over(l, t.lo, t.hi)) continue;
    uint at = far_next_pair();
    if (at < u_capacity) FAR_AT(pairs, at) = uvec2(min(t.triangle, other), max(t.triangle, other));
  }
}
#endif
