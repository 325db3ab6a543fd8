// A corner of a picture's triangle: x, y and depth in normalized device coordinates, and its colour, RGBA8 in 32 bits.
layout(std430, binding = 0) readonly buffer Corners { uvec4 corners[]; };

flat out vec4 v_colour;

void main() {
  uvec4 corner = corners[gl_VertexID];
  v_colour = unpackUnorm4x8(corner.w);
  gl_Position = vec4(uintBitsToFloat(corner.xyz), 1.0);
}
