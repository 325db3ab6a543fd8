// What the programs of FAR pairs share, after core/interval.glsl: the bindings and uniforms that several of them use, and the
// loop over work items. A program defines work(w) for each w < u_count; FAR_BATCH of them are one invocation's, so that no
// invocation comes near 65,535 iterations (llvmpipe then stops without a word) and the finished ones are counted together.
layout(local_size_x = 64) in;

// Five vec4 an item: its corners a, b, c with the three margins (far_margin) in their w, and its bounds lo, hi within the limits
// of its owner. A head: triangle, code, pixels of the bounds i0 | j0 << 16 and i1 | j1 << 16.
const uint kItemSize = 5u;
// Code of an item: number of its owner << 3 and these.
const uint kWhole = 1u;
const uint kSelf = 2u;
const uint kLarge = 4u;

layout(std430, binding = 7) buffer Counters { uint counters[]; };  // totals, then finished work items of each dispatch

layout(location = 0) uniform uint u_count;       // work items of this dispatch
layout(location = 1) uniform uint u_finished;    // index of the counter of those that finished
layout(location = 2) uniform uint u_unfinished;  // a work item that gives up, for tests of the count; none where >= u_count
layout(location = 3) uniform uint u_step;        // what the program does now
layout(location = 4) uniform vec4 u_widen;       // as in core/interval.glsl
layout(location = 5) uniform ivec4 u_tile;       // pixels i0, i1, j0, j1, inclusive
layout(location = 6) uniform ivec2 u_window;     // px
layout(location = 7) uniform vec2 u_depth;       // near end of the window (px), slices per px
layout(location = 8) uniform uvec2 u_bins;       // of a cell, by the slice of near depths: number, shift of the slice
layout(location = 9) uniform uint u_cells;       // pixels of the tile, or cells of the level
layout(location = 10) uniform uint u_masked;     // not 0: entries whose slices no other owner touches are left out
layout(location = 11) uniform uint u_capacity;   // records that the program's output holds
layout(location = 12) uniform uint u_items;      // items of the tile
layout(location = 13) uniform uvec4 u_extra;     // what one program alone needs
layout(location = 14) uniform vec4 u_numbers;    // the same

uint far_group() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

int far_depth_slice(float z) { return far_slice(z, u_depth.x, u_depth.y); }

// The bin of a near depth in a cell.
uint far_bin(uint cell, float near) { return cell * u_bins.x + (uint(far_depth_slice(near)) >> u_bins.y); }

// The owners of two items may collide.
bool far_may_meet(uint a, uint b) { return (a & kSelf) != 0u || ((a ^ b) >> 3) != 0u; }

// Adds to a total of two words.
void far_add(uint counter, uint n) {
  if (n == 0u) return;
  uint before = atomicAdd(counters[counter], n);
  if (before + n < before) atomicAdd(counters[counter + 1u], 1u);
}

// The last of the `count` ascending numbers that is <= x, as an index; the first of them is 0.
#define FAR_LAST_AT_MOST(name, numbers)                                        \
  uint name(uint x, uint count) {                                              \
    uint low = 0u;                                                             \
    uint high = count;                                                         \
    while (high - low > 1u) {                                                  \
      uint middle = low + (high - low) / 2u;                                   \
      if (numbers[middle] <= x) { low = middle; } else { high = middle; }      \
    }                                                                          \
    return low;                                                                \
  }

void work(uint w);

void main() {
  uint base = far_group() * (64u * FAR_BATCH) + gl_LocalInvocationID.x;
  uint done = 0u;
  for (uint k = 0u; k < FAR_BATCH; ++k) {
    uint w = base + k * 64u;
    if (w >= u_count || w == u_unfinished) break;
    work(w);
    ++done;
  }
  if (done > 0u) atomicAdd(counters[u_finished], done);
}
