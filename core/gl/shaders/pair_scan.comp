// Sums of all numbers before each: 64 at a time are summed, their sums in the same way, and the sums of what precedes handed
// down again. A sum beyond 32 bits raises FAR_OVERFLOW.
layout(std430, binding = 0) buffer Numbers { uvec4 tag_0; readonly uint numbers[]; };
#define FAR_TAG_0 tag_0.x
layout(std430, binding = 1) buffer Before { uvec4 tag_1; writeonly uint before[]; };
#define FAR_TAG_1 tag_1.x
layout(std430, binding = 2) buffer Sums { uvec4 tag_2; uint sums[]; };  // the levels one after the other
#define FAR_TAG_2 tag_2.x

// u_extra: x where the level below begins in sums, y how many numbers it has, z where this level begins, w counter of the total.

void far_sum(uint a, uint b, inout uint total) {
  total = a + b;
  if (total < a) counters[FAR_OVERFLOW] = 1u;
}

void work(uint w) {
  uint begin = 64u * w;
  uint end = min(begin + 64u, u_extra.y);
  uint total = 0u;
#if FAR_STEP == 0  // sums of the numbers
  for (uint i = begin; i < end; ++i) far_sum(total, numbers[i], total);
  sums[u_extra.z + w] = total;
#elif FAR_STEP == 1  // sums of sums
  for (uint i = begin; i < end; ++i) far_sum(total, sums[u_extra.x + i], total);
  sums[u_extra.z + w] = total;
#elif FAR_STEP == 2  // the last level, of up to 64 sums
  for (uint i = begin; i < end; ++i) {
    uint here = sums[u_extra.x + i];
    sums[u_extra.x + i] = total;
    far_sum(total, here, total);
  }
  counters[u_extra.w] = total;
#elif FAR_STEP == 3  // down to sums
  total = sums[u_extra.z + w];
  for (uint i = begin; i < end; ++i) {
    uint here = sums[u_extra.x + i];
    sums[u_extra.x + i] = total;
    total += here;
  }
#else  // down to the numbers
  total = sums[u_extra.z + w];
  for (uint i = begin; i < end; ++i) {
    uint here = numbers[i];
    before[i] = total;
    total += here;
  }
#endif
}
