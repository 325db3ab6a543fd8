// Step 0: the sums of the words of up to five buffers, each mixed with its place (gl_sum has the same on the CPU). Step 1: copies words.
// Step 2: sets words to 0; u_extra.x: not 0 where they are bits of pairs.
#if FAR_STEP == 0
layout(std430, binding = 0) buffer From0 { uvec4 tag_0; readonly uint from_0[]; };
#define FAR_TAG_0 tag_0.x
layout(std430, binding = 1) buffer From1 { uvec4 tag_1; readonly uint from_1[]; };
#define FAR_TAG_1 tag_1.x
layout(std430, binding = 2) buffer From2 { uvec4 tag_2; readonly uint from_2[]; };
#define FAR_TAG_2 tag_2.x
layout(std430, binding = 3) buffer From3 { uvec4 tag_3; readonly uint from_3[]; };
#define FAR_TAG_3 tag_3.x
layout(std430, binding = 4) buffer From4 { uvec4 tag_4; readonly uint from_4[]; };
#define FAR_TAG_4 tag_4.x
// u_extra: the words of the first buffer, of the first two, three and four.
#else
#if FAR_STEP == 1
layout(std430, binding = 0) buffer From { uvec4 tag_0; readonly uint from[]; };
#define FAR_TAG_0 tag_0.x
#endif
layout(std430, binding = 1) buffer To { uvec4 tag_1; writeonly uint to[]; };
#define FAR_TAG_1 tag_1.x
#endif

void work(uint w) {
#if FAR_STEP == 0
  uint word = 0u;
  uint place = 0u;
  if (w < u_extra.x) {
    place = w;
    word = FAR_AT(from_0, place);
  } else if (w < u_extra.y) {
    place = w - u_extra.x;
    word = FAR_AT(from_1, place);
  } else if (w < u_extra.z) {
    place = w - u_extra.y;
    word = FAR_AT(from_2, place);
  } else if (w < u_extra.w) {
    place = w - u_extra.z;
    word = FAR_AT(from_3, place);
  } else {
    place = w - u_extra.w;
    word = FAR_AT(from_4, place);
  }
  far_sum_of_batch += far_mixed(word, place);
#elif FAR_STEP == 1
  FAR_AT(to, w) = FAR_AT(from, w);
#else
  FAR_AT(to, w) = 0u;
#endif
}
