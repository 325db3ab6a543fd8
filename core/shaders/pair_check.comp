// After counting: how many cells are crowded. After filling in: counts that are not used up, and how many items have an entry.
layout(std430, binding = 3) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 4) readonly buffer First { uint first[]; };
layout(std430, binding = 8) readonly buffer Listed { uint listed[]; };

// u_extra.x: bins in all.

void work(uint w) {
  if (u_step == 0u) {
    if (first[(w + 1u) * u_bins.x] - first[w * u_bins.x] > FAR_CROWDED) atomicAdd(counters[FAR_CROWDED_CELLS], 1u);
    return;
  }
  if (w < u_extra.x && counts[w] != 0u) atomicAdd(counters[FAR_MISMATCHES], 1u);
  if (w < u_items && listed[w] != 0u) atomicAdd(counters[FAR_LISTED], 1u);
}
