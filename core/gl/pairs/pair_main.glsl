// The loop over work items, and the echo of what the program reads; this file stands after that of a program. The first
// invocation writes the echo beside the counter of finished work items: the sum of the program's number, its uniforms and the
// tags of its buffers, each mixed with its place. PairQueue::run computes the same sum from the intended values: a lost call to
// GL makes the two differ.

uint far_echo() {
  uint sum = 0u;
  FAR_ADD(0u, FAR_PROGRAM)
  for (uint k = 0u; k < kUniforms; ++k) {
    uvec4 words = u_all[k];
    for (uint i = 0u; i < 4u; ++i) FAR_ADD(1u + 4u * k + i, words[i])
  }
#ifdef FAR_TAG_0
  FAR_ADD(37u, FAR_TAG_0)
#endif
#ifdef FAR_TAG_1
  FAR_ADD(38u, FAR_TAG_1)
#endif
#ifdef FAR_TAG_2
  FAR_ADD(39u, FAR_TAG_2)
#endif
#ifdef FAR_TAG_3
  FAR_ADD(40u, FAR_TAG_3)
#endif
#ifdef FAR_TAG_4
  FAR_ADD(41u, FAR_TAG_4)
#endif
#ifdef FAR_TAG_5
  FAR_ADD(42u, FAR_TAG_5)
#endif
#ifdef FAR_TAG_6
  FAR_ADD(43u, FAR_TAG_6)
#endif
  FAR_ADD(44u, FAR_TAG_7)
#ifdef FAR_TAG_8
  FAR_ADD(45u, FAR_TAG_8)
#endif
#ifdef FAR_TAG_9
  FAR_ADD(46u, FAR_TAG_9)
#endif
#ifdef FAR_TAG_10
  FAR_ADD(47u, FAR_TAG_10)
#endif
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
