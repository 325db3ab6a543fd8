// Step 0, after counting: counts the crowded cells. Step 1, after filling in: counts the lists whose counts are not used up.
layout(std430, binding = 3) buffer Counts { uvec4 tag_3; readonly uint counts[]; };
#define FAR_TAG_3 tag_3.x
layout(std430, binding = 4) buffer First { uvec4 tag_4; readonly uint first[]; };
#define FAR_TAG_4 tag_4.x

void work(uint w) {
#if FAR_STEP == 0
  if (first[(w + 1u) * u_bins.x] - first[w * u_bins.x] > FAR_CROWDED) atomicAdd(counters[FAR_CROWDED_CELLS], 1u);
#else
  if (counts[w] != 0u) atomicAdd(counters[FAR_MISMATCHES], 1u);
#endif
}
