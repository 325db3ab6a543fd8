// A solid without a shape, for probes of what the canvas does with a depth: s0 = (-, -, entry, exit), hit everywhere.
bool solid_interval(vec2 c, vec4 s0, vec4 s1, vec4 s2, vec4 s3, vec4 s4, FAR_OUT(float) entry,
                    FAR_OUT(float) exit) {
  entry = s0.z;
  exit = s0.w;
  return true;
}
