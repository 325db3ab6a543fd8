// Step 0: the sum of the words of a buffer, each mixed with its place (gl_sum has the same on the CPU). Step 1: copies words. Step 2: sets
// words to 0.
#if FAR_STEP != 2
layout(std430, binding = 0) buffer From { uvec4 tag_0; readonly uint from[]; };
#define FAR_TAG_0 tag_0.x
#endif
#if FAR_STEP != 0
layout(std430, binding = 1) buffer To { uvec4 tag_1; writeonly uint to[]; };
#define FAR_TAG_1 tag_1.x
#endif

void work(uint w) {
#if FAR_STEP == 0
  far_sum_of_batch += far_mixed(from[w], w);
#elif FAR_STEP == 1
  to[w] = from[w];
#else
  to[w] = 0u;
#endif
}
