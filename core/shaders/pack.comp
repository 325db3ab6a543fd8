// Packs flags, one uint each, into bits, and counts the invocations that finished: the caller compares that count with the
// number it asked for (assumption A7).
layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer Flags { uint flags[]; };
layout(std430, binding = 3) writeonly buffer Bits { uint bits[]; };
layout(std430, binding = 4) buffer Finished { uint finished; };

uniform uint u_first;       // word of the first invocation of this dispatch
uniform uint u_words;       // words in all
uniform uint u_flags;       // flags in all
uniform uint u_unfinished;  // a word whose invocation gives up, for tests of the count; none where >= u_words

void main() {
  uint word = u_first + gl_GlobalInvocationID.x;
  if (word >= u_words || word == u_unfinished) return;
  uint word_bits = 0u;
  for (uint i = 0u; i < 32u; ++i) {
    uint flag = word * 32u + i;
    if (flag < u_flags && flags[flag] != 0u) word_bits |= 1u << i;
  }
  bits[word] = word_bits;
  atomicAdd(finished, 1u);
}
