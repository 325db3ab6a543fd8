// Writes a given depth, and marks the pixel where the depth test let it pass: a colour, since buffer writes also happen
// for fragments that fail a late depth test.
flat in uint v_slot;
flat in vec4 v_solid4;
layout(location = 0) out uint mark;

void main() {
  gl_FragDepth = v_solid4.z;
  mark = v_slot + 1u;
}
