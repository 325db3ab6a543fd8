// Counts the work items that the rows of each record are: none where it is large.
layout(std430, binding = 6) buffer RecordHeads { uvec4 tag_6; readonly uvec4 record_heads[]; };
#define FAR_TAG_6 tag_6.x
layout(std430, binding = 3) buffer Rows { uvec4 tag_3; writeonly uint rows[]; };
#define FAR_TAG_3 tag_3.x

void work(uint w) {
  uvec4 head = record_heads[w];
  int i0 = max(int(head.z & 0xffffu), u_tile.x);
  int i1 = min(int(head.w & 0xffffu), u_tile.y);
  int j0 = max(int(head.z >> 16), u_tile.z);
  int j1 = min(int(head.w >> 16), u_tile.w);
  uint n = uint(j1 - j0 + 1) * (uint(i1 - i0) / FAR_SPAN + 1u);
  rows[w] = (head.y & kLarge) != 0u ? 0u : n;
}
