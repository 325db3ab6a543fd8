// Probes of atomics, and of values that one shader writes and another reads. FAR_STEP selects:
// 0: every invocation uses each kind of atomic that farcull uses.
// 1: each invocation reads what another invocation of the previous dispatch wrote.
// 2: copies the counts of a draw. 3: copies the texels of a depth texture that a draw wrote.
// FAR_PLAIN (a deliberate defect): plain reads and writes instead of atomics.
layout(local_size_x = 64) in;
layout(location = 0) uniform uint u_count;  // number of invocations
layout(location = 1) uniform uint u_salt;   // in step 3: the texture's width, px
#if FAR_STEP == 3
layout(location = 2) uniform sampler2D u_depth;
#else
layout(std430, binding = 0) buffer From { uint from[]; };
#endif
layout(std430, binding = 1) buffer To { uint to[]; };

#if FAR_STEP == 0
// `from` holds kSpread counters that count up from 0, kSpread counters that count down from
// u_count / kSpread, one bit for each invocation, and one mark for every two invocations.
const uint kSpread = 16u;
uint take(uint at, uint n) {
#ifdef FAR_PLAIN
  uint before = from[at];
  from[at] = before + n;
  return before;
#else
  return atomicAdd(from[at], n);
#endif
}

void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w >= u_count) return;
  uint k = w % kSpread;
  to[3u * w] = take(k, 1u);
  to[3u * w + 1u] = take(kSpread + k, 0xffffffffu);
#ifdef FAR_PLAIN
  from[2u * kSpread + w / 32u] |= 1u << (w % 32u);
#else
  atomicOr(from[2u * kSpread + w / 32u], 1u << (w % 32u));
#endif
  uint mark = 2u * kSpread + u_count / 32u + w / 2u;
  to[3u * w + 2u] = atomicExchange(from[mark], 1u);
}
#elif FAR_STEP == 1
void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w >= u_count) return;
  // u_count is a power of two and the factor is odd, so each word is read once. Usually the group
  // that reads a word is not the group that wrote the word.
  uint other = (w * 40503u + u_salt) & (u_count - 1u);
  to[w] = from[other] * 1664525u + (w ^ u_salt);
}
#elif FAR_STEP == 2
void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w < u_count) to[w] = from[w];
}
#else
void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w < u_count) to[w] = floatBitsToUint(texelFetch(u_depth, ivec2(w % u_salt, w / u_salt), 0).r);
}
#endif
