// Steps over arrays of words. 0 sums the words of up to five buffers, each mixed with its place (gl_sum does the same on the
// CPU). 1 copies words. 2 sets words to 0; u_extra.x is not 0 if they are bits of pairs. 3 and 4 find for each number the sum
// of all before it. 3 sums 64 numbers at a time, and adds each sum to the sums of the 64^2 and the 64^3 numbers around, which
// are 0 at first. 4 adds up from these what precedes its 64 numbers, then goes on number by number. A sum beyond 32 bits raises
// FAR_OVERFLOW. 5 finds the slices of a pixel that two owners touch: the owners' numbers differ in some bit, so one touches the
// slice in the region for 0 in that bit and the other in the region for 1. 6, after counting, counts the crowded cells.
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

void work(uint w) {
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
}
#elif FAR_STEP == 1 || FAR_STEP == 2
#if FAR_STEP == 1
layout(std430, binding = 0) buffer From { uvec4 tag_0; readonly uint from[]; };
#define FAR_TAG_0 tag_0.x
#endif
layout(std430, binding = 1) buffer To { uvec4 tag_1; writeonly uint to[]; };
#define FAR_TAG_1 tag_1.x

void work(uint w) {
#if FAR_STEP == 1
  FAR_AT(to, w) = FAR_AT(from, w);
#else
  FAR_AT(to, w) = 0u;
#endif
}
#elif FAR_STEP == 3 || FAR_STEP == 4
layout(std430, binding = 0) buffer Numbers { uvec4 tag_0; readonly uint numbers[]; };
#define FAR_TAG_0 tag_0.x
#if FAR_STEP == 4
layout(std430, binding = 1) buffer Before { uvec4 tag_1; writeonly uint before[]; };
#define FAR_TAG_1 tag_1.x
#endif
layout(std430, binding = 2) buffer Sums { uvec4 tag_2; uint sums[]; };  // of 64^2 numbers, of 64^3, of 64
#define FAR_TAG_2 tag_2.x

// u_extra: x counter of the total, y how many numbers there are, unless u_work.x says it, z where sums of 64^3 numbers begin, w
// where sums of 64 numbers begin.

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
#if FAR_STEP == 3
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
#elif FAR_STEP == 5
layout(std430, binding = 2) buffer Masks { uvec4 tag_2; uint masks[]; };  // as in pair_lists.comp
#define FAR_TAG_2 tag_2.x

// u_extra.x: bits of an owner's number.

void work(uint w) {
  uint conflict = FAR_AT(masks, w);
  for (uint k = 0u; k < u_extra.x; ++k) {
    uint zero = (1u + 2u * k) * 2u * u_cells + w;
    conflict |= FAR_AT(masks, zero) & FAR_AT(masks, zero + 2u * u_cells);
  }
  FAR_AT(masks, w) = conflict;
}
#else
layout(std430, binding = 4) buffer First { uvec4 tag_4; readonly uint first[]; };
#define FAR_TAG_4 tag_4.x

void work(uint w) {
  if (FAR_AT(first, (w + 1u) * u_bins.x) - FAR_AT(first, w * u_bins.x) > FAR_CROWDED) atomicAdd(counters[FAR_CROWDED_CELLS], 1u);
}
#endif
