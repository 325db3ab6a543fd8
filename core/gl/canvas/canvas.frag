// Draws one fragment: stores its depth, or tests it against the stored depth. The defines:
// FAR_PROXY: the solid's function (placed before this text) computes the depth. The program uses
// the entry depth for storing and the exit depth for testing.
// FAR_ASK: tests instead of storing. Its value is the slack (kAskedBehind) by which the tested
// depth lies behind the mapped exit.
// FAR_FLAGS: a fragment that passes the test writes this pass's serial number to the flag of its
// slot. This program compares the depths of proxies; the depth test compares those of triangles.
// No FAR_FLAGS: an occlusion query tells whether a fragment passed.
// FAR_VALUE: also writes the depth in px.
uniform ivec4 u_window;  // first pixel and size of the window inside the render target
uniform vec2 u_centre;   // pixel-space origin inside the render target, whole numbers
uniform float u_scale;   // scale of the depth map

flat in uint v_slot;
flat in uint v_fixed;
#ifdef FAR_PROXY
flat in vec4 v_solid0, v_solid1, v_solid2, v_solid3, v_solid4;
#endif
#ifdef FAR_VALUE
out float o_value;
#endif
#ifdef FAR_FLAGS
layout(std430, binding = 2) buffer Flags { uvec4 flags_tag; uint flags[]; };
uniform uint u_serial;
#ifdef FAR_PROXY
layout(binding = 0) uniform sampler2D u_depth;
uniform bool u_touching;  // Pass::touching
#else
layout(early_fragment_tests) in;
#endif
#endif

void main() {
  ivec2 pixel = ivec2(floor(gl_FragCoord.xy));
  ivec2 inside = pixel - u_window.xy;
  bool in_window = all(greaterThanEqual(inside, ivec2(0))) && all(lessThan(inside, u_window.zw));
  if (!in_window && v_fixed == 0u) discard;
#ifdef FAR_PROXY
  float depth;
  if (v_fixed != 0u) {
    depth = v_solid4.z;
#ifdef FAR_VALUE
    o_value = depth;
#endif
  } else {
    vec2 c = vec2(pixel) + vec2(0.5) - u_centre;
    float entry, exit;
    if (!solid_interval(c, v_solid0, v_solid1, v_solid2, v_solid3, v_solid4, entry, exit)) discard;
#ifdef FAR_ASK
    precise float z = exit * u_scale;
#else
    precise float z = entry * u_scale;
#endif
#ifdef FAR_VALUE
#ifdef FAR_ASK
    o_value = exit;
#else
    o_value = entry;
#endif
#endif
    precise float mapped = 0.5 + z;
    depth = clamp(mapped, 0.25, 0.75);
#ifdef FAR_ASK
    // Another program mapped the stored depth, and may have rounded the depth differently.
    precise float behind = depth + FAR_ASK;
    depth = behind;
#endif
  }
#endif
#if defined(FAR_FLAGS) && defined(FAR_PROXY)
  float stored = texelFetch(u_depth, pixel, 0).r;
  if (depth > stored || (u_touching && depth == stored)) FAR_AT(flags, v_slot) = u_serial;
#elif defined(FAR_FLAGS)
  FAR_AT(flags, v_slot) = u_serial;
#elif defined(FAR_PROXY)
  gl_FragDepth = depth;
#endif
}
