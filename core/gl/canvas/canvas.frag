// Stores or asks one fragment, by these defines:
// FAR_PROXY: the solid's function (in front of this text) computes the depth: the entry when
// storing, the exit when asking.
// FAR_ASK: asks instead of storing. Its value is a slack (kAskedBehind): how far the asked depth is
// behind the mapped exit.
// FAR_FLAGS: an asked fragment that is seen writes this pass's serial number to its slot's flag.
// For proxies this program compares depths, for triangles the depth test does. Without FAR_FLAGS
// an occlusion query decides.
// FAR_VALUE: also writes out the fragment's depth in px.
uniform ivec4 u_window;  // first pixel and size of the window inside the render target
uniform vec2 u_centre;   // pixel-space origin inside the render target, an integer
uniform float u_scale;   // of the depth map

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
    // Another program mapped the stored depth, and may have rounded differently.
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
