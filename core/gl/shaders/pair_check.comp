// After counting: counts the crowded cells.
layout(std430, binding = 4) buffer First { uvec4 tag_4; readonly uint first[]; };
#define FAR_TAG_4 tag_4.x

void work(uint w) {
  if (FAR_AT(first, (w + 1u) * u_bins.x) - FAR_AT(first, w * u_bins.x) > FAR_CROWDED) atomicAdd(counters[FAR_CROWDED_CELLS], 1u);
}
