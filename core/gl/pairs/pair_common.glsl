// Shared by the programs of FAR pairs, after core/pairs/interval.glsl: uniforms, records, and the loop over work items. A program
// defines work(w) for each w < far_count(). One invocation does FAR_BATCH of them, so that it never comes near 65,535
// iterations (llvmpipe then stops without an error), and counts the finished ones together. If a file has several steps,
// each is compiled as a program with its own FAR_STEP, so that no program carries the code of the others.
layout(local_size_x = 64) in;

// Triangles that meet the part of the window are items. Whole ones (one interval in all their pixels) are heads alone until they
// are listed; the others, and those that are listed, are records.
// Record: five vec4: corners a, b, c with the three margins (far_margin) in their w; bounds lo, hi within the owner's limits.
// Head of a record: triangle, code, pixels i0 | j0 << 16, i1 | j1 << 16. A whole item has as its last word what far_pack makes,
// and as its first word, until it becomes a record, its position among the active triangles.
// Entry: two uvec4: bits of lo.x, lo.y, near; triangle; bits of hi.x, hi.y, far; code. Beside it: cell, record.
const uint kRecordSize = 5u;
// Code: number of the owner << 3, and these bits.
const uint kWhole = 1u;
const uint kSelf = 2u;
const uint kLarge = 4u;

layout(std430, binding = 7) buffer Counters { uvec4 tag_7; uint counters[]; };  // totals, then finished work items of each dispatch
#define FAR_TAG_7 tag_7.x

// All uniforms, sent by one call; u_name below says what each is.
const uint kUniforms = 9u;
layout(location = 0) uniform uvec4 u_all[kUniforms];
#define u_count u_all[0].x                     // work items of this dispatch; with u_work.x the most that its total may be
#define u_finished u_all[0].y                  // index of the counter of those that finished
#define u_cells u_all[0].z                     // pixels of the tile
#define u_masked u_all[0].w                    // not 0: entries whose slices no other owner touches are left out
#define u_widen uintBitsToFloat(u_all[1])      // as in core/pairs/interval.glsl
#define u_tile ivec4(u_all[2])                 // pixels i0, i1, j0, j1, inclusive
#define u_window ivec2(u_all[3].xy)            // px
#define u_steps_per_px uintBitsToFloat(u_all[3].z)  // as far_slice takes them
#define u_first_step int(u_all[3].w)
#define u_slices_per_step int(u_all[5].z)
#define u_bins u_all[4]                        // of a cell: number, shift of a slice, number of a group, number of groups - 1
#define u_capacity u_all[5].x                  // that the program's output holds
#define u_items u_all[5].y                     // records of triangles that are not whole
#define u_extra u_all[6]                       // what one program alone needs
#define u_numbers uintBitsToFloat(u_all[7])    // what one program alone needs, as floats
// If x is not 0, the total counters[x] says how many work items there are: one for each y of it, times z.
#define u_work u_all[8]

// The number of work items of this dispatch. It is 0 if the total is beyond the room there is, or if one before it was: then
// the buffers are not complete.
uint far_count() {
  if (u_work.x == 0u) return u_count;
  uint total = counters[u_work.x];
  if (total > u_count) counters[FAR_OVERFLOW] = 1u;
  if (total > u_count || counters[FAR_OVERFLOW] != 0u) return 0u;
  return (total + u_work.y - 1u) / u_work.y * u_work.z;
}

uint far_group() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

int far_pixel(float x, int count) { return int(clamp(x, 0.0f, float(count - 1))); }
int far_depth_slice(float z) { return far_slice(z, u_steps_per_px, u_first_step, u_slices_per_step); }

// Entries of a cell lie in bins by the last bit of their owner's number (where there are two groups), then by near slice.
uint far_bin(uint cell, uint code, uint slice) {
  return cell * u_bins.x + ((code >> 3) & u_bins.w) * u_bins.z + (slice >> u_bins.y);
}

// Pixels and slices of a whole item, beside its first pixel.
uint far_pack(int width, int height, int first_slice, int last_slice) {
  return uint(width - 1) | uint(height - 1) << 4 | uint(first_slice) << 8 | uint(last_slice) << 14;
}

// Adds to a total of two words.
void far_add(uint counter, uint n) {
  uint before = atomicAdd(counters[counter], n);
  if (before + n < before) atomicAdd(counters[counter + 1u], 1u);
}

// The place of one more pair in the output. Beyond 32 bits the places begin anew at 0, but the total stays right.
#define FAR_ONE_PAIR 1u
uint far_next_pair() {
  uint place = atomicAdd(counters[FAR_PAIRS], FAR_ONE_PAIR);
  if (place + FAR_ONE_PAIR < place) atomicAdd(counters[FAR_PAIRS + 1u], 1u);
  return place;
}

// The index of the last of the `count` ascending numbers that is <= x; the first number is 0.
#define FAR_LAST_AT_MOST(name, numbers)                                        \
  uint name(uint x, uint count) {                                              \
    uint low = 0u;                                                             \
    uint high = count;                                                         \
    while (high - low > 1u) {                                                  \
      uint middle = low + (high - low) / 2u;                                   \
      if (FAR_AT(numbers, middle) <= x) { low = middle; } else { high = middle; }      \
    }                                                                          \
    return low;                                                                \
  }

void work(uint w);

#ifdef FAR_SUM
uint far_sum_of_batch = 0u;  // added to the total FAR_SUM by main
#endif
