// Sums of all numbers before each. Step 0: 64 at a time are summed, and each sum is added to those of 64^2 and 64^3 numbers, which are
// 0 before. Step 1: what precedes 64 numbers is summed from these, and handed down. A sum beyond 32 bits raises FAR_OVERFLOW.
layout(std430, binding = 0) buffer Numbers { uvec4 tag_0; readonly uint numbers[]; };
#define FAR_TAG_0 tag_0.x
#if FAR_STEP == 1
layout(std430, binding = 1) buffer Before { uvec4 tag_1; writeonly uint before[]; };
#define FAR_TAG_1 tag_1.x
#endif
layout(std430, binding = 2) buffer Sums { uvec4 tag_2; uint sums[]; };  // of 64^2 numbers, of 64^3, of 64
#define FAR_TAG_2 tag_2.x

// u_extra: x counter of the total, y how many numbers there are, unless u_work.x says it, z where sums of 64^3 numbers begin, w where
// those of 64.

void far_sum(uint a, uint b, inout uint total) {
  total = a + b;
  if (total < a) counters[FAR_OVERFLOW] = 1u;
}

void far_add_sum(uint at, uint n) {
  uint before_it = atomicAdd(FAR_AT(sums, at), n);
  if (before_it + n < before_it) counters[FAR_OVERFLOW] = 1u;
}

void work(uint w) {
  uint all = u_work.x == 0u ? u_extra.y : counters[u_work.x];
  uint begin = 64u * w;
  uint end = min(begin + 64u, all);
  uint total = 0u;
#if FAR_STEP == 0
  for (uint i = begin; i < end; ++i) far_sum(total, FAR_AT(numbers, i), total);
  FAR_AT(sums, u_extra.w + w) = total;
  if (total == 0u) return;
  far_add_sum(w >> 6, total);
  far_add_sum(u_extra.z + (w >> 12), total);
#else
  for (uint i = 0u; i < w >> 12; ++i) far_sum(total, FAR_AT(sums, u_extra.z + i), total);
  for (uint i = w >> 12 << 6; i < w >> 6; ++i) far_sum(total, FAR_AT(sums, i), total);
  for (uint i = w >> 6 << 6; i < w; ++i) far_sum(total, FAR_AT(sums, u_extra.w + i), total);
  for (uint i = begin; i < end; ++i) {
    uint here = FAR_AT(numbers, i);
    FAR_AT(before, i) = total;
    far_sum(total, here, total);
  }
  if (end == all) counters[u_extra.x] = total;
#endif
}
