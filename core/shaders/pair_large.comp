// Large triangles with each item of the tile, in the rectangle of that one's bounds: compare_large of core/pairs_cpu.cpp.
layout(std430, binding = 0) readonly buffer Items { vec4 items[]; };
layout(std430, binding = 1) readonly buffer Heads { uvec4 heads[]; };
layout(std430, binding = 2) writeonly buffer Pairs { uvec2 pairs[]; };
layout(std430, binding = 3) buffer Large { uint large[]; };  // items

// u_step 0: lists the large ones. 1: FAR_LARGE_BATCH of them with one item; u_extra: x the first of them, y how many there are in all,
// z the first item.

bool far_meets_over(uint l, vec4 box_lo, vec4 box_hi) {
  vec4 a = items[kItemSize * l];
  vec4 b = items[kItemSize * l + 1u];
  vec4 c = items[kItemSize * l + 2u];
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
  if (u_step == 0u) {
    if ((heads[w].y & kLarge) == 0u) return;
    uint at = atomicAdd(counters[FAR_PARENTS], 1u);
    if (at < u_capacity) large[at] = w;
    return;
  }
  uint item = u_extra.z + w;
  uvec4 head = heads[item];
  vec4 lo = items[kItemSize * item + 3u];
  vec4 hi = items[kItemSize * item + 4u];
  uint end = min(u_extra.x + FAR_LARGE_BATCH, u_extra.y);
  for (uint k = u_extra.x; k < end; ++k) {
    uint l = large[k];
    if (l == item) continue;
    uvec4 other = heads[l];
    if (!far_may_meet(head.y, other.y)) continue;
    vec4 lo2 = max(lo, items[kItemSize * l + 3u]);
    vec4 hi2 = min(hi, items[kItemSize * l + 4u]);
    if (!(lo2.x <= hi2.x && lo2.y <= hi2.y && lo2.z <= hi2.z) || !far_meets_over(l, lo, hi)) continue;
    uint at = atomicAdd(counters[FAR_PAIRS], 1u);
    if (at < u_capacity) pairs[at] = uvec2(min(head.x, other.x), max(head.x, other.x));
  }
}
