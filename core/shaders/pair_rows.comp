// How many work items the rows of each item are: none where it is whole or large.
layout(std430, binding = 1) readonly buffer Heads { uvec4 heads[]; };
layout(std430, binding = 3) writeonly buffer Rows { uint rows[]; };  // one more than items, the last 0

void work(uint w) {
  uint n = 0u;
  if (w < u_items) {
    uvec4 head = heads[w];
    if ((head.y & (kWhole | kLarge)) == 0u) {
      int i0 = max(int(head.z & 0xffffu), u_tile.x);
      int i1 = min(int(head.w & 0xffffu), u_tile.y);
      int j0 = max(int(head.z >> 16), u_tile.z);
      int j1 = min(int(head.w >> 16), u_tile.w);
      n = uint(j1 - j0 + 1) * (uint(i1 - i0) / FAR_SPAN + 1u);
    }
  }
  rows[w] = n;
}
