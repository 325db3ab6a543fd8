// The loop over work items, and the echo of what the program reads; after the text of a program. The first invocation writes
// the sum of the program's number, its uniforms and the tags of its buffers, each mixed with its place, beside the
// counter of finished work items. PairQueue::run computes the same sum from what it meant: a lost call to GL makes the two differ.

uint far_echo() {
  uint sum = 0u;
  FAR_ADD(0u, FAR_PROGRAM)
  FAR_ADD(1u, u_count)
  FAR_ADD(2u, u_finished)
  uvec4 widen = floatBitsToUint(u_widen);
  uvec4 tile = uvec4(u_tile);
  uvec2 window = uvec2(u_window);
  uvec2 depth = floatBitsToUint(u_depth);
  uvec4 numbers = floatBitsToUint(u_numbers);
  FAR_ADD(3u, widen.x) FAR_ADD(4u, widen.y) FAR_ADD(5u, widen.z) FAR_ADD(6u, widen.w)
  FAR_ADD(7u, tile.x) FAR_ADD(8u, tile.y) FAR_ADD(9u, tile.z) FAR_ADD(10u, tile.w)
  FAR_ADD(11u, window.x) FAR_ADD(12u, window.y)
  FAR_ADD(13u, depth.x) FAR_ADD(14u, depth.y)
  FAR_ADD(15u, u_bins.x) FAR_ADD(16u, u_bins.y) FAR_ADD(17u, u_bins.z) FAR_ADD(18u, u_bins.w)
  FAR_ADD(19u, u_cells)
  FAR_ADD(20u, u_masked)
  FAR_ADD(21u, u_capacity)
  FAR_ADD(22u, u_items)
  FAR_ADD(23u, u_extra.x) FAR_ADD(24u, u_extra.y) FAR_ADD(25u, u_extra.z) FAR_ADD(26u, u_extra.w)
  FAR_ADD(27u, numbers.x) FAR_ADD(28u, numbers.y) FAR_ADD(29u, numbers.z) FAR_ADD(30u, numbers.w)
#ifdef FAR_TAG_0
  FAR_ADD(31u, FAR_TAG_0)
#endif
#ifdef FAR_TAG_1
  FAR_ADD(32u, FAR_TAG_1)
#endif
#ifdef FAR_TAG_2
  FAR_ADD(33u, FAR_TAG_2)
#endif
#ifdef FAR_TAG_3
  FAR_ADD(34u, FAR_TAG_3)
#endif
#ifdef FAR_TAG_4
  FAR_ADD(35u, FAR_TAG_4)
#endif
#ifdef FAR_TAG_5
  FAR_ADD(36u, FAR_TAG_5)
#endif
#ifdef FAR_TAG_6
  FAR_ADD(37u, FAR_TAG_6)
#endif
  FAR_ADD(38u, FAR_TAG_7)
#ifdef FAR_TAG_8
  FAR_ADD(39u, FAR_TAG_8)
#endif
#ifdef FAR_TAG_9
  FAR_ADD(40u, FAR_TAG_9)
#endif
#ifdef FAR_TAG_10
  FAR_ADD(41u, FAR_TAG_10)
#endif
  FAR_ADD(42u, u_work.x) FAR_ADD(43u, u_work.y) FAR_ADD(44u, u_work.z) FAR_ADD(45u, u_work.w)
  return sum;
}

void main() {
  uint base = far_group() * (64u * FAR_BATCH) + gl_LocalInvocationID.x;
  if (base == 0u) counters[u_finished + 1u] = far_echo();
  uint items = far_count();
  uint done = 0u;
  for (uint k = 0u; k < FAR_BATCH; ++k) {
    uint w = base + k * 64u;
    if (w >= items) break;
    work(w);
    ++done;
  }
#ifdef FAR_SUM
  if (far_sum_of_batch > 0u) far_add(FAR_SUM, far_sum_of_batch);
#endif
  if (done > 0u) atomicAdd(counters[u_finished], done);
}
