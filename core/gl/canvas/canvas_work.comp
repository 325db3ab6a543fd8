// Step 0 hashes each word of a buffer with its position, and sums the hashes. Step 1 packs flags,
// one word each, into bits. A bit is 1 if its flag equals this pass's serial number. The report
// begins with the number of finished work items and the sum of step 0. The host sets both to 0;
// each dispatch adds to them. Each dispatch also writes an echo to its own word of the report.
layout(local_size_x = 64) in;
#if FAR_STEP == 0
layout(std430, binding = 0) readonly buffer From { uvec4 from_tag; uvec4 from[]; };
#else
layout(std430, binding = 0) readonly buffer From { uvec4 from_tag; uint from[]; };
#endif
layout(std430, binding = 3) buffer Report { uvec4 report_tag; uint report[]; };

layout(location = 0) uniform uint u_count;       // number of work items
layout(location = 1) uniform uint u_echo;        // word of the report for this dispatch's echo
layout(location = 2) uniform uint u_serial;
layout(location = 3) uniform uint u_flags;       // number of flags
layout(location = 4) uniform uint u_bits;        // word of the report where the bits begin

uint far_echo() {
  uint sum = 0u;
  FAR_ADD(0u, FAR_PROGRAM)
  FAR_ADD(1u, u_count)
  FAR_ADD(2u, u_echo)
  FAR_ADD(3u, u_serial)
  FAR_ADD(4u, u_flags)
  FAR_ADD(5u, u_bits)
  FAR_ADD(6u, from_tag.x)
  FAR_ADD(7u, report_tag.x)
  return sum;
}

uint sum_of_batch = 0u;

void work(uint w) {
#if FAR_STEP == 0
  uvec4 words = FAR_AT(from, w);
  for (uint k = 0u; k < 4u; ++k) sum_of_batch += far_mixed(words[k], 4u * w + k);
#else
  uint bits = 0u;
  for (uint i = 0u; i < 32u; ++i) {
    uint flag = w * 32u + i;
    if (flag < u_flags && FAR_AT(from, flag) == u_serial) bits |= 1u << i;
  }
  FAR_AT(report, u_bits + w) = bits;
#endif
}

void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint base = group * (64u * FAR_BATCH) + gl_LocalInvocationID.x;
  if (base == 0u) FAR_AT(report, u_echo) = far_echo();
  uint done = 0u;
  for (uint k = 0u; k < FAR_BATCH; ++k) {
    uint w = base + k * 64u;
    if (w >= u_count) break;
    work(w);
    ++done;
  }
  if (sum_of_batch != 0u) atomicAdd(FAR_AT(report, 1), sum_of_batch);
  if (done > 0u) atomicAdd(FAR_AT(report, 0), done);
}
